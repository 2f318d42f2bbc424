"""Alembic: the perspective cameras alone, by Blender's exporter, for Houdini, Nuke and Maya.

Axes are x east, y up, z south of the scene's origin, in metres, as Alembic has them; a frame is at its number
divided by the frames per second. Positions are in single precision: 1 mm at 16 km.
"""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ..jobs import worker
from ..progress import MessageCallback, Progress
from . import tracks
from .request import ExportRequest
from .tracks import Track

FORMAT = {"title": "Alembic", "help": "Alembic: perspective cameras"}
ORDER = 30
NAME = "cameras.abc"


def write(request: ExportRequest) -> list[Path]:
    """Write cameras.abc, in a worker process with Blender."""
    found = tracks.find(request)
    if omitted := [track.name for track in found if track.projection != "perspective"]:
        request.tell(f"omitted cameras that are not perspective: {', '.join(omitted)}")
    path, rate = request.folder / NAME, request.shot.settings.time.rate
    task = {
        "path": str(path),
        "rate": [rate.numerator, rate.denominator],
        "span": [min(request.frames), max(request.frames)],
        "cameras": [_plain(track) for track in found if track.projection == "perspective"],
    }
    worker.run(f"{__name__}:in_blender", task, request.progress, stop=request.stop)
    return [path]


def _plain(track: Track) -> dict[str, Any]:
    matrix = np.tile(np.eye(4), (len(track.frames), 1, 1))
    matrix[:, :3, :3], matrix[:, :3, 3] = track.rotation, track.position
    return {
        "name": track.name,
        "frames": track.frames.tolist(),
        "matrix": matrix.tolist(),
        "focal": track.focal.tolist(),
        "sensor": [track.sensor, track.sensor * track.aspect],
    }


def in_blender(
    path: str,
    rate: list[int],
    span: list[int],
    cameras: list[dict[str, Any]],
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Make the cameras in an empty scene, and export them; worker side."""
    import bpy

    from ..blender import compat

    compat.require_alembic()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    compat.set_frame_rate(scene.render, Fraction(*rate))
    scene.frame_start, scene.frame_end = span
    for done, camera in enumerate(cameras, 1):
        _add(scene, camera)
        progress(done, len(cameras))
    bpy.ops.wm.alembic_export(filepath=path, start=span[0], end=span[1], as_background_job=False)


def _add(scene: Any, camera: dict[str, Any]) -> None:
    """Add a camera with a key in each frame."""
    import bpy
    from mathutils import Matrix

    data = bpy.data.cameras.new(camera["name"])
    made = bpy.data.objects.new(camera["name"], data)
    scene.collection.objects.link(made)
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width, data.sensor_height = camera["sensor"]
    made.rotation_mode = "QUATERNION"
    before = None
    for frame, matrix, focal in zip(camera["frames"], camera["matrix"], camera["focal"], strict=True):
        made.location, rotation, _ = Matrix(matrix).decompose()
        if before is not None:
            rotation.make_compatible(before)
        made.rotation_quaternion = before = rotation
        data.lens = focal
        for path in ("location", "rotation_quaternion"):
            made.keyframe_insert(path, frame=frame)
        data.keyframe_insert("lens", frame=frame)
