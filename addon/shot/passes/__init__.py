"""Passes: render outputs of a camera; each module here defines one, unless its name begins with "_".

A module defines `PASS`, a `RenderedPass`, `DerivedPass` or `ComparisonPass` with the module's name.

A pixel without a value, such as the sky's, is 1e10 m in depth, and 0 in normals. Temperatures (K) without a
value are NaN: the imager passes draw them grey, `sensor.colour` as the coldest.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from ... import plugins

if TYPE_CHECKING:
    from ..sections.camera import CameraSettings


@dataclass(frozen=True, kw_only=True)
class Pass:
    """Pass: one output of a camera, with its files and their dependencies.

    Attributes
    ----------
    name, order
        Name, and rank by which passes are made and listed.
    help
        Help in one line.
    files
        Suffixes of its files.
    aspects
        Aspects of the settings on which its own work depends: names of sections, or "camera", "picture",
        "colour", "grain", "thermal", "film" or "passes"; see `sections`. A name also means its folders
        ``NAME`` and ``scene/NAME`` in `code_fingerprint`.
    film
        Make a film of its PNG files.
    captions
        Draw the time into its films as a caption.
    single_view
        Refuse panorama cameras.
    min_rows
        Minimum number of rows; a smaller picture of a camera is enlarged, see `size`.
    code
        Files and folders of the package that decide its files, in addition to its own module, the module that
        finishes it (`render.finish`) and what all passes depend on.
    linked
        Suffixes of files whose name its EXR contains, which therefore keep their names in deliveries.
    finished
        A module of `render.finish` makes its files, or completes the files that Blender renders.
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
    linked: tuple[str, ...] = ()
    finished: bool = False

    @property
    def made_from(self) -> tuple[str, ...]:
        """Passes whose files it needs, of its run or of all runs."""
        return ()

    @property
    def all_aspects(self) -> frozenset[str]:
        """Aspects on which its files depend, with the aspects of the passes that they are made from."""
        return self.aspects.union(*(known()[name].all_aspects for name in self.made_from))

    def size(self, resolution: tuple[int, int]) -> tuple[int, int]:
        """Return columns and rows, both even, of its picture for a camera's resolution."""
        width, height = resolution
        rows = self.min_rows
        return resolution if height >= rows else (2 * round(width * rows / height / 2), rows)


@dataclass(frozen=True, kw_only=True)
class RenderedPass(Pass):
    """Pass that Blender renders in a separate view layer.

    Attributes
    ----------
    socket
        Socket of Blender's Render Layers node.
    layer_property
        View layer property that enables the socket; empty: always enabled.
    shading
        Shader output: "light"; infrared "radiance", never denoised; or "masks", per-pixel classes (see
        `masks`), never denoised.
    excludes
        Parts of the scene excluded from its view layer.
    samples
        Samples per pixel; None: the samples of [render].
    channels
        Channels of its EXR: "colour" or "grey".
    bits
        Bits per value in its EXR.
    pixel_centres
        Send rays through pixel centres.
    through_smoke
        Render smoke almost transparent, with longer ray steps.
    geometry_only
        It shows geometry alone, independent of materials.
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
class MarchedPass(Pass):
    """Pass that the integrated renderer makes from the render of the visible picture."""


@dataclass(frozen=True, kw_only=True)
class DerivedPass(Pass):
    """Pass made from files of other passes, without rendering.

    Attributes
    ----------
    needs
        Passes whose files it is made from.
    mount
        Sensors on its camera's mount may supply these (see `settings.mount`).
    """

    needs: tuple[str, ...] = ()
    mount: bool = False
    finished: bool = True

    @property
    def made_from(self) -> tuple[str, ...]:
        """Passes whose files it needs."""
        return self.needs


@dataclass(frozen=True, kw_only=True)
class ComparisonPass(DerivedPass):
    """Pass that compares all runs of a scene, made once its inputs are finished.

    Attributes
    ----------
    needs_of_all
        Passes whose files of every run it needs.
    """

    needs_of_all: tuple[str, ...] = ()

    @property
    def made_from(self) -> tuple[str, ...]:
        """Passes whose files it needs, of its run or of all runs."""
        return tuple(dict.fromkeys((*self.needs, *self.needs_of_all)))


@functools.cache
def known() -> dict[str, Pass]:
    """Return all passes by name, in order."""
    found = plugins.values(__name__, "PASS").values()
    return {entry.name: entry for entry in sorted(found, key=lambda entry: entry.order)}


def helps() -> dict[str, str]:
    """Return the help of all passes by name, in order."""
    return {name: entry.help for name, entry in known().items()}


def file_of(camera: str, name: str, frame: int, suffix: str) -> str:
    """Return the file of a camera's frame in a pass, relative to the output folder."""
    stem = file_stem(camera)
    return f"{stem}/{name}/{stem}_{name}_{frame:06d}.{suffix}"


def file_stem(view: str) -> str:
    """Return the name of a view in paths: ``drone@slower`` is ``drone_at_slower``.

    Readers of file sequences take ``@`` for a digit of the frame number.
    """
    return view.replace("@", "_at_")


def view_of(camera: str, run: str) -> str:
    """Return the name of a camera's view of another run."""
    return f"{camera}@{run}"


def in_other_runs(names: Iterable[str]) -> tuple[str, ...]:
    """Return the passes that a camera records in comparison runs, in order."""
    asked = [known()[name] for name in names]
    wanted = {
        name
        for each in asked
        for name in (each.needs_of_all if isinstance(each, ComparisonPass) else (each.name,))
    }
    return tuple(name for name in known() if name in wanted)


def records_masks(each: Pass) -> bool:
    """Return True if the shaders of a pass output per-pixel classes."""
    return isinstance(each, RenderedPass) and each.shading == "masks"


def is_rendered(each: Pass) -> bool:
    """Return True if Blender renders a pass: it is not made from files of other passes."""
    return isinstance(each, RenderedPass | MarchedPass)


def is_marched(each: Pass) -> bool:
    """Return True if the integrated renderer makes a pass, or a pass that it is made from."""
    return any(isinstance(part, MarchedPass) for part in (each, *(known()[name] for name in each.made_from)))


def compares(name: str) -> bool:
    """Return True if a pass compares runs."""
    return isinstance(known()[name], ComparisonPass)


def refused(each: Pass, camera: CameraSettings, settings: Any) -> str:
    """Return the reason why a camera cannot record a pass with these settings; empty if it can."""
    drawn = (each, *(known()[name] for name in each.made_from))
    cannot = f'camera "{camera.name}" cannot record {each.name}'
    eevee = settings.render.engine == "eevee"
    if eevee and any(map(records_masks, drawn)):
        return (
            f"{cannot} with EEVEE, whose pixels have 11 bits, too few for tree numbers; render it with Cycles"
        )
    if "forecast" in each.aspects and settings.forecast.ensemble is None:
        return f"{cannot} without an ensemble; name its folder as forecast.ensemble"
    if is_marched(each):
        if eevee:
            return f"{cannot} with EEVEE, which renders smoke and surfaces together; render it with Cycles"
        if changed := _unmarched(settings.smoke):
            return f"{cannot} with {changed}, because Cycles then renders smoke too; remove the key"
    if each.single_view and camera.rig.around:
        return f'camera "{camera.name}" is a panorama and cannot record {each.name}'
    return ""


def _unmarched(smoke: Any) -> str:
    """Return the first key of [smoke], with its value, by which smoke is not ray-marched; empty if it is."""
    if not smoke.enabled:
        return ""
    wanted = {"draw": "integrated", "method": "flow", "lighting": "solved"}
    values = ((name, getattr(smoke, name)) for name in wanted)
    return next((f'smoke.{name} = "{value}"' for name, value in values if value != wanted[name]), "")


def of_camera(settings: Any, camera: CameraSettings) -> tuple[Pass, ...]:
    """Return the passes of a camera in order: `camera.passes`, or else `settings.render.passes`."""
    names = camera.passes or settings.render.passes
    return tuple(entry for entry in known().values() if entry.name in names)
