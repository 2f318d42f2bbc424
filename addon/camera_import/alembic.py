"""Cameras of Alembic files, by Blender's importer. A zoom is not read: Blender reads one focal length."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import input_error
from ..limits import CAMERA_FRAMES
from ..progress import MessageCallback, Progress
from . import foreign
from .foreign import ForeignScene


def read(path: Path, progress: Progress, rate: tuple[int, int]) -> ForeignScene:
    """Read the cameras of a file; `rate`, frames per second as a fraction, converts its seconds to frames.

    Raises
    ------
    InputError, Error
        The file cannot be read.
    """
    return foreign.read(path, partial(in_blender, path.absolute(), rate), progress)


def in_blender(path: Path, rate: tuple[int, int], progress: Progress, tell: MessageCallback) -> ForeignScene:
    """Import a file into an empty scene, and sample its cameras (see `ForeignScene`)."""
    from fractions import Fraction

    import bpy

    from ..blender import compat

    compat.require_alembic()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    compat.set_frame_rate(scene.render, Fraction(*rate))
    try:
        bpy.ops.wm.alembic_import(filepath=str(path), set_frame_range=True, as_background_job=False)
    except RuntimeError as error:
        raise input_error(path, f"cannot be read as Alembic: {str(error).strip()[:200]}") from None
    if not scene.objects:  # the importer finishes without an error
        raise input_error(path, "is empty or not an Alembic file; export it again")
    first, last = scene.frame_start, scene.frame_end
    if last - first > CAMERA_FRAMES:
        raise input_error(path, f"has more than {CAMERA_FRAMES:,} frames")
    cameras = [each for each in scene.objects if each.type == "CAMERA"]
    matrices: dict[str, list[Any]] = {each.name: [] for each in cameras}
    for frame in range(first, last + 1):
        scene.frame_set(frame)
        for camera in cameras:
            matrices[camera.name].append(np.array(camera.matrix_world).tolist())
        progress(frame - first + 1, last - first + 1)
    frames = list(map(float, range(first, last + 1)))
    filmed = [
        {
            "name": each.name,
            "frames": frames,
            "matrix": matrices[each.name],
            "half": [0.5 * each.data.sensor_width / each.data.lens] * len(frames),
            "sensor": each.data.sensor_width,
        }
        for each in cameras
        if each.data.type == "PERSP"
    ]
    omitted = [each.name for each in cameras if each.data.type != "PERSP"]
    return ForeignScene(rate[0] / rate[1], None, filmed, omitted)
