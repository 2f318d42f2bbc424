"""Passes, what a camera records: each module of this folder is one, unless its name begins with "_".

It defines `PASS`, a `Pass` whose name is the module's.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..settings.settings import Camera, Settings
    from ..shot import Shot

Files = Mapping[str, Path]
Finish = Callable[[Files, Mapping[str, Files], "Shot", str, int], None]


@dataclass(frozen=True)
class Pass:
    """One thing that a camera records, in a view layer of its own.

    Attributes
    ----------
    name, order
        Passes are made and listed in the order of their numbers.
    help
        One line.
    files
        Suffixes of its files.
    output
        Socket of Blender's Render Layers node; empty: nothing is rendered, `finish` makes all files.
    enable
        Property of a view layer that switches the socket on; empty: it is always there.
    leaves_out
        Parts of the scene that it does not see.
    samples
        Rays per pixel; None: those of [render].
    data
        Never denoised, and the shaders show infrared radiance instead of light.
    masks
        The shaders show what each pixel is (see `masks`).
    channels
        Of its EXR: "colour" or "grey".
    bits
        Of each number in its EXR.
    pixel_centres
        Its rays go through the middle of each pixel.
    through_smoke
        Smoke is nearly clear in it, and steps through smoke are longer.
    shapes
        It shows where surfaces are and nothing of what they are like.
    filmed
        Its PNG files make a film.
    captions
        Films write the time into its pictures.
    shows
        Aspects that its own rendering shows (see `schema.chosen`).
    needs
        Other passes whose files its own are made from.
    compares
        It is about all of a scene's runs, and made when what it is made from is finished.
    across
        Other passes whose files of every run its own are made from, in a pass that compares.
    mount
        It takes these also from the sensors of its camera's mount (see `shot.mount`).
    flat
        Cameras that see all round have it not.
    rows
        Of its picture at the least; a camera's of fewer pixels becomes so large, see `size`.
    sources
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
    output: str
    shows: frozenset[str]
    enable: str = ""
    leaves_out: tuple[str, ...] = ()
    samples: int | None = None
    data: bool = True
    masks: bool = False
    channels: str = "grey"
    bits: int = 32
    pixel_centres: bool = False
    through_smoke: bool = False
    shapes: bool = False
    filmed: bool = False
    captions: bool = True
    needs: tuple[str, ...] = ()
    compares: bool = False
    across: tuple[str, ...] = ()
    mount: bool = False
    flat: bool = False
    rows: int = 0
    sources: tuple[str, ...] = ()
    finish: Finish | None = None

    @property
    def aspects(self) -> frozenset[str]:
        """Aspects that its files depend on: its own and those of the passes that they are made from."""
        return self.shows.union(*(known()[name].aspects for name in self.made_from))

    @property
    def made_from(self) -> tuple[str, ...]:
        """The passes that it needs, of its own run or of all."""
        return tuple(dict.fromkeys((*self.needs, *self.across)))

    def size(self, resolution: tuple[int, int]) -> tuple[int, int]:
        """Columns and rows, both even, of its picture for a camera of so many."""
        width, height = resolution
        return resolution if height >= self.rows else (2 * round(width * self.rows / height / 2), self.rows)


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
    wanted = {name for each in asked for name in (each.across if each.compares else (each.name,))}
    return tuple(name for name in known() if name in wanted)


def refused(each: Pass, camera: Camera, engine: str) -> str:
    """Why a camera cannot record a pass with an engine; empty: it can."""
    if each.masks and engine == "eevee":
        return (
            f'camera "{camera.name}" cannot record {each.name} with EEVEE, which keeps 11 bits of a number, '
            "and numbers of trees have more; render it with Cycles"
        )
    if each.flat and camera.rig.around:
        return f'camera "{camera.name}" sees all round, which has no {each.name}'
    return ""


def of_camera(settings: Settings, camera: Camera) -> tuple[Pass, ...]:
    """Passes of a camera in order: its own, or those of [render] where it names none."""
    names = camera.passes or settings.render.passes
    return tuple(each for each in known().values() if each.name in names)
