"""Passes: render outputs of a camera, and what scene files declare of them.

A pass is a module of ``passes``, or of the folder ``passes`` of a feature. It defines `ORDER`, the rank by
which passes are made and listed; `HELP`, one line; `PASS`, a `RenderedPass`, `MarchedPass`, `DerivedPass` or
`ComparisonPass`; and `finish`, if it makes files or completes rendered ones (see
`Finish`). It imports matplotlib within functions, because Blender does not have it.

A pixel without a value, such as the sky's, is 1e10 m in depth, and 0 in normals. Temperatures (K) without a
value are NaN: the imager passes draw them grey, `sensor.colour` as the coldest.
"""

from __future__ import annotations

import functools
import importlib
import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal

from .. import plugins

if TYPE_CHECKING:
    from .sections.camera import CameraSettings

Files = Mapping[str, Path]
"""Files of a picture, by suffix."""

Finish = Callable[[Files, Mapping[str, Files], Any, str, int], None]
"""Finishes a picture without Blender. Arguments: the pass's files; the files of the passes that it needs, by
need (``need@run`` for another run); the `Shot`; the camera's name; and the frame."""

SURFACES = frozenset({"time", "camera", "picture", "terrain", "forest", "stations"})
"""Aspects of passes that show the surfaces of a scene."""

_ROOT = __name__.rsplit(".", 2)[0]
_PACKAGE = Path(__file__).parents[1]


@dataclass(frozen=True, kw_only=True)
class Pass:
    """Pass: one output of a camera, with its files and their dependencies.

    Attributes
    ----------
    name
        Name of its module, from `known`.
    files
        Suffixes of its files.
    aspects
        Aspects of the settings on which its own work depends: names of sections, or "camera", "picture",
        "colour", "grain", "thermal", "film" or "sidecar"; see `sections`. A name also means its folders
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
        Files and folders of the package that decide its files, in addition to its own module, the helpers
        next to it and what all passes depend on.
    linked
        Suffixes of files whose name its EXR contains, which therefore keep their names in deliveries.
    requires
        Key of the scene file that must be set, such as "tiles.root", and words for it with a remedy.
    """

    name: str = ""
    files: tuple[str, ...]
    aspects: frozenset[str] = frozenset()
    film: bool = False
    captions: bool = True
    single_view: bool = False
    min_rows: int = 0
    code: tuple[str, ...] = ()
    linked: tuple[str, ...] = ()
    requires: tuple[str, str] = ("", "")

    @property
    def finished(self) -> bool:
        """Return True if its module makes its files, or completes the files that Blender renders."""
        return hasattr(modules()[self.name], "finish")

    @property
    def made_from(self) -> tuple[str, ...]:
        """Passes whose files it needs, of its run or of all runs."""
        return ()

    @property
    def all_aspects(self) -> frozenset[str]:
        """Aspects on which its files depend, with the aspects of the passes that they are made from."""
        return self.aspects.union(*(known()[name].all_aspects for name in self.made_from))

    @property
    def is_exposed(self) -> bool:
        """Return True if its pictures, or views of its files, have the exposure of visible light."""
        return "colour" in self.all_aspects

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
    shares_rays
        The integrated renderer makes it from one render for all such passes. If its module defines ``march``,
        it gets an eye of the camera (`render.eye.Eye`) and the frame, and returns the pixels.
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
    shares_rays: bool = False


@dataclass(frozen=True, kw_only=True)
class MarchedPass(Pass):
    """Pass that the integrated renderer makes from the rays of the visible picture.

    Its module defines ``march``, which gets an eye of the camera (`render.eye.Eye`) after its picture, and
    the frame, and returns arrays (h, w, 1 or 3) by channel: ``x`` is a channel, and ``fire.`` the colour
    ``fire.R``, ``fire.G``, ``fire.B``. Other names do not end with R.

    Attributes
    ----------
    light_groups, aovs
        Light groups, and AOVs of colours, of `blender.nodes` that the surfaces need in addition.
    bloom
        Add the light of the lens bloom as the colour ``bloom.``.
    bits
        Bits per value in its EXR.
    comments
        Meaning of the channels, in its EXR.
    """

    light_groups: tuple[str, ...] = ()
    aovs: tuple[str, ...] = ()
    bloom: bool = False
    bits: Literal[16, 32] = 32
    comments: str = ""


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


def _folders() -> list[Path]:
    """List the folders of passes: of the package, and of its features."""
    return [_PACKAGE / "passes", *sorted(path.parent for path in _PACKAGE.glob("*/passes/__init__.py"))]


@functools.cache
def modules() -> dict[str, ModuleType]:
    """Import the modules of all passes; by name, in order."""
    listed: dict[str, ModuleType] = {}
    for folder in _folders():
        package = ".".join((_ROOT, *folder.relative_to(_PACKAGE).parts))
        importlib.import_module(package)
        listed |= plugins.modules(package)
    return dict(sorted(listed.items(), key=lambda item: item[1].ORDER))


@functools.cache
def known() -> dict[str, Pass]:
    """Return all passes by name, in order."""
    return {name: replace(module.PASS, name=name) for name, module in modules().items()}


@functools.cache
def helps() -> dict[str, str]:
    """Return the help of all passes by name, in order; no module is imported."""
    return plugins.declared(_folders(), "HELP")


def finish(name: str, files: Files, needed: Mapping[str, Files], shot: Any, camera: str, frame: int) -> None:
    """Finish a picture of a pass (see `Finish`).

    Raises
    ------
    Error
        A Python package that the pass needs is not installed.
    """
    try:
        modules()[name].finish(files, needed, shot, camera, frame)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith(_ROOT):
            raise
        from ..errors import Error  # it loads the core, which help does not need

        raise Error(f"the {name} pass needs {error.name}, which is not in Blender: pip install it") from None


def code_files(name: str) -> list[str]:
    """List the files and folders of the package that decide the files of a pass."""
    file = Path(inspect.getfile(modules()[name]))
    each, helpers = known()[name], sorted(file.parent.glob("_[a-z]*.py"))
    own = [path.relative_to(_PACKAGE).as_posix() for path in (file, *(helpers if each.finished else ()))]
    return [*own, *each.code, *(["imaging"] if each.finished else [])]


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
    key, what = each.requires
    if key and attrgetter(key)(settings) is None:
        return f"{cannot} without {what}"
    if is_marched(each):
        if eevee:
            return f"{cannot} with EEVEE, which renders smoke and surfaces together; render it with Cycles"
        if settings.smoke.enabled and settings.smoke.draw != "integrated":
            changed = f'smoke.draw = "{settings.smoke.draw}"'
            return f"{cannot} with {changed}, because Cycles then renders smoke too; remove the key"
    if each.single_view and camera.rig.around:
        return f'camera "{camera.name}" is a panorama and cannot record {each.name}'
    return ""


def of_camera(settings: Any, camera: CameraSettings) -> tuple[Pass, ...]:
    """Return the passes of a camera in order: `camera.passes`, or else `settings.render.passes`."""
    names = camera.passes or settings.render.passes
    return tuple(entry for entry in known().values() if entry.name in names)
