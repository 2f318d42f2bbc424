"""Rendered view layers as arrays: Cycles' passes without the compositor, and without a picture file."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import bpy
import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .. import memory
from ..blender import compat
from . import engine, layers
from .light_only import light_only

Channels = dict[str, NDArray[np.float32]]
"""Channels of a view layer: (h, w, c) by the name of Cycles' pass, without alpha."""

_ORDER = "RGBXYZVA"


def render(
    scene: bpy.types.Scene,
    names: Collection[str],
    folder: Path,
    *,
    centres: bool = False,
    infrared: bool = True,
) -> list[tuple[int, dict[str, Channels]]]:
    """Render the view layers of passes with one call.

    Parameters
    ----------
    folder
        For a temporary file of about 100 bytes per pixel.
    centres
        All rays go through pixel centres.
    infrared
        Write infrared radiance to the AOV of surfaces; otherwise that channel is 0.

    Returns
    -------
    For each eye: its number (-1 left, 1 right, or 0 for mono), and its channels by pass.
    """
    layers.select(scene, names)
    with (
        engine.pixel_centres(scene, centres),
        layers.black_materials(scene, names),
        light_only(names, infrared),
    ):
        return render_selected(scene, names, folder)


def render_selected(
    scene: bpy.types.Scene, names: Collection[str], folder: Path
) -> list[tuple[int, dict[str, Channels]]]:
    """Render the view layers in use, which have these names; see `render`."""
    file, cycles = folder / "surfaces.exr", scene.cycles
    chance = cycles.min_transparent_bounces
    cycles.min_transparent_bounces = engine.TRANSPARENT  # AOVs are not corrected for Russian roulette
    try:
        with compat.raw_file(scene, file):
            bpy.ops.render.render(write_still=True, scene=scene.name)
        memory.release_freed()
    finally:
        cycles.min_transparent_bounces = chance
    ends = {-1: "_L", 1: "_R"} if scene.render.use_multiview else {0: ""}
    return [(eye, _read(file.with_stem(file.stem + end), names)) for eye, end in ends.items()]


def _read(path: Path, names: Collection[str]) -> dict[str, Channels]:
    """Read the channels of a multilayer EXR, and delete the file."""
    channels: dict[str, dict[str, list[tuple[str, NDArray[np.float32]]]]] = {name: {} for name in names}
    for channel, values in sensor.read_channels(path).items():
        layer, name, *_, part = channel.split(".")
        channels[layer].setdefault(name, []).append((part, values))
    path.unlink()
    return {layer: {name: _stack(each) for name, each in all_.items()} for layer, all_ in channels.items()}


def _stack(parts: list[tuple[str, NDArray[np.float32]]]) -> NDArray[np.float32]:
    ordered = sorted(parts, key=lambda pair: _ORDER.index(pair[0]))
    return np.stack([values for _, values in ordered[:3]], axis=-1)
