"""Passes, what a camera records: each module of this folder is one, unless its name begins with "_".

It defines `PASS`, whose name is the module's: a `RenderedPass`, `DerivedPass` or `ComparisonPass`.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from ..settings.protocols import CameraSettings

Files = Mapping[str, Path]
Finish = Callable[[Files, Mapping[str, Files], Any, str, int], None]


@dataclass(frozen=True, kw_only=True)
class Pass:
    """One thing that a camera records: its files, and what they depend on.

    Attributes
    ----------
    name, order
        Passes are made and listed in the order of their numbers.
    help
        One line.
    files
        Suffixes of its files.
    aspects
        Aspects of the settings that its own work depends on (see `schema.select`).
    film
        Its PNG files make a film.
    captions
        Films write the time into its pictures.
    single_view
        Cameras that see all round do not have it.
    min_rows
        Rows of its picture at the least; a camera's picture of fewer is enlarged, see `size`.
    code
        Files and folders of the package that decide its files, beside its own module, the helpers of passes
        (`_NAME.py`) and what all depend on.
    finish
        Makes the files that Blender does not, or goes on with those that it made. Called with the pass's
        files by suffix; those of the passes that it needs, by need (of another run ``need@run``) and suffix;
        the shot; the camera's name; and the frame.
    """

    name: str
    order: int
    help: str
    files: tuple[str, ...]
    aspects: frozenset[str] = frozenset()
    film: bool = False
    captions: bool = True
    single_view: bool = False
    min_rows: int = 0
    code: tuple[str, ...] = ()
    finish: Finish | None = None

    @property
    def made_from(self) -> tuple[str, ...]:
        """The passes whose files it needs, of its own run or of all."""
        return ()

    @property
    def all_aspects(self) -> frozenset[str]:
        """Aspects that its files depend on: its own and those of the passes that they are made from."""
        return self.aspects.union(*(known()[name].all_aspects for name in self.made_from))

    def size(self, resolution: tuple[int, int]) -> tuple[int, int]:
        """Columns and rows, both even, of its picture for a camera of so many."""
        width, height = resolution
        rows = self.min_rows
        return resolution if height >= rows else (2 * round(width * rows / height / 2), rows)


@dataclass(frozen=True, kw_only=True)
class RenderedPass(Pass):
    """A pass that Blender renders in a view layer of its own.

    Attributes
    ----------
    socket
        Of Blender's Render Layers node.
    layer_property
        Property of a view layer that switches the socket on; empty: it is always there.
    shading
        What the shaders show: "light"; infrared "radiance", which is never denoised; or "masks", what each
        pixel is (see `masks`), which is not denoised either.
    excludes
        Parts of the scene that its view layer excludes.
    samples
        Rays per pixel; None: those of [render].
    channels
        Of its EXR: "colour" or "grey".
    bits
        Of each number in its EXR.
    pixel_centres
        Its rays go through the middle of each pixel.
    through_smoke
        Smoke is nearly clear in it, and steps through smoke are longer.
    geometry_only
        It shows where surfaces are; their materials do not matter.
    """

    socket: str = "Image"
    layer_property: str = ""
    shading: Literal["light", "radiance", "masks"] = "radiance"
    excludes: tuple[str, ...] = ()
    samples: int | None = None
    channels: Literal["colour", "grey"] = "grey"
    bits: int = 32
    pixel_centres: bool = False
    through_smoke: bool = False
    geometry_only: bool = False


@dataclass(frozen=True, kw_only=True)
class DerivedPass(Pass):
    """A pass made from files of other passes; nothing is rendered for it.

    Attributes
    ----------
    needs
        Passes whose files its own are made from.
    mount
        It takes these also from the sensors of its camera's mount (see `cameras.mount`).
    """

    needs: tuple[str, ...] = ()
    mount: bool = False

    @property
    def made_from(self) -> tuple[str, ...]:
        """The passes whose files it needs."""
        return self.needs


@dataclass(frozen=True, kw_only=True)
class ComparisonPass(DerivedPass):
    """A pass that compares all of a scene's runs, made when what it is made from is finished.

    Attributes
    ----------
    needs_of_all
        Passes whose files of every run its own are made from.
    """

    needs_of_all: tuple[str, ...] = ()

    @property
    def made_from(self) -> tuple[str, ...]:
        """The passes whose files it needs, of its own run or of all."""
        return tuple(dict.fromkeys((*self.needs, *self.needs_of_all)))


@functools.cache
def known() -> dict[str, Pass]:
    """Every pass by its name, in order."""
    names = [module.name for module in pkgutil.iter_modules(__path__) if module.name[0] != "_"]
    found = [importlib.import_module(f"{__name__}.{name}").PASS for name in names]
    return {each.name: each for each in sorted(found, key=lambda each: each.order)}


def helps() -> dict[str, str]:
    """Every pass's line of help by its name, in order."""
    return {name: each.help for name, each in known().items()}


def file_of(camera: str, name: str, frame: int, suffix: str) -> str:
    """A file of a camera's frame in a pass, relative to the output folder."""
    return f"{camera}/{name}/{camera}_{name}_{frame:06d}.{suffix}"


def view_of(camera: str, run: str) -> str:
    """What a camera is called in another run."""
    return f"{camera}@{run}"


def in_other_runs(names: Iterable[str]) -> tuple[str, ...]:
    """What a camera with these passes records in another run than the first, in order."""
    asked = [known()[name] for name in names]
    wanted = {
        name
        for each in asked
        for name in (each.needs_of_all if isinstance(each, ComparisonPass) else (each.name,))
    }
    return tuple(name for name in known() if name in wanted)


def records_masks(each: Pass) -> bool:
    """Whether its shaders show what each pixel is."""
    return isinstance(each, RenderedPass) and each.shading == "masks"


def compares(name: str) -> bool:
    """Whether a pass compares runs."""
    return isinstance(known()[name], ComparisonPass)


def refused(each: Pass, camera: CameraSettings, engine: str) -> str:
    """Why a camera cannot record a pass with an engine; empty: it can."""
    if records_masks(each) and engine == "eevee":
        return (
            f'camera "{camera.name}" cannot record {each.name} with EEVEE, which keeps 11 bits of a number, '
            "and numbers of trees have more; render it with Cycles"
        )
    if each.single_view and camera.rig.around:
        return f'camera "{camera.name}" sees all round, which has no {each.name}'
    return ""


def of_camera(settings: Any, camera: CameraSettings) -> tuple[Pass, ...]:
    """Passes of a camera in order: its own, or those of `settings.render` where it names none."""
    names = camera.passes or settings.render.passes
    return tuple(each for each in known().values() if each.name in names)
