"""Output presets: settings of EXR files and films for a kind of post-production."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from .. import passes
from . import Camera, Settings


@dataclass(frozen=True)
class OutputPreset:
    """Settings of a preset.

    Attributes
    ----------
    help
        Purpose in one line.
    values
        Values of `[render]`.
    passes
        Passes for cameras that record `rgb`; panoramas omit passes of a single view.
    slate
        Put a slate with the name of the scene before review films that have none.
    """

    help: str
    values: dict[str, Any] = field(default_factory=dict)
    passes: tuple[str, ...] = ()
    slate: bool = False


PRESETS = {
    "compositing": OutputPreset(
        "For Nuke, Fusion and other compositors: comp and data, EXR in ACEScg, films without captions",
        {"exr_space": "acescg", "video": True, "film": "clean"},
        passes=("comp", "data"),
    ),
    "editorial": OutputPreset(
        "For Resolve, Premiere and other editors: clean films in ProRes 422 HQ, review films with a slate",
        {"video": True, "film": "both", "film_codec": "prores"},
        slate=True,
    ),
}


def apply(settings: Settings, name: str) -> Settings:
    """Apply a preset; values that it does not name, such as resolution and frame rate, do not change."""
    preset = PRESETS[name]
    listed = _add_passes(settings.render.passes, preset)
    slate = settings.render.slate or (settings.path.stem if preset.slate else "")
    render = replace(settings.render, **preset.values, slate=slate, passes=listed)
    cameras = tuple(_with_passes(camera, listed, preset) for camera in settings.cameras)
    return replace(settings, render=render, cameras=cameras)


def _add_passes(listed: tuple[str, ...], preset: OutputPreset) -> tuple[str, ...]:
    """Add the passes of a preset to passes with `rgb`."""
    return (*listed, *(each for each in preset.passes if "rgb" in listed and each not in listed))


def _with_passes(camera: Camera, listed: tuple[str, ...], preset: OutputPreset) -> Camera:
    """Set the passes of a camera that has its own list, or cannot record all that are `listed`."""
    wanted = _add_passes(camera.passes or listed, preset)
    single = {name for name, each in passes.known().items() if each.single_view and camera.rig.around}
    able = tuple(each for each in wanted if each not in preset.passes or each not in single)
    return camera if able == listed and not camera.passes else replace(camera, passes=able)
