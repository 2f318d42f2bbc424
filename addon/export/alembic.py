"""Alembic: the perspective cameras alone, by Blender's exporter, for Houdini, Nuke and Maya.

Axes are x east, y up, z south of the scene's origin, in metres, as Alembic has them; a frame is at its number
divided by the frames per second. Positions are in single precision: 1 mm at 16 km.
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

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
    filmed = [track for track in found if track.projection == "perspective"]
    work = partial(in_blender, path, rate, (min(request.frames), max(request.frames)), filmed)
    worker.run(work, request.progress, stop=request.stop)
    return [path]


def in_blender(
    path: Path,
    rate: Fraction,
    span: tuple[int, int],
    cameras: list[Track],
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Make the cameras in an empty scene, and export them; worker side."""
    import bpy

    from ..blender import compat

    compat.require_alembic()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    compat.set_frame_rate(scene.render, rate)
    scene.frame_start, scene.frame_end = span
    for done, camera in enumerate(cameras, 1):
        _add(scene, camera)
        progress(done, len(cameras))
    bpy.ops.wm.alembic_export(filepath=str(path), start=span[0], end=span[1], as_background_job=False)


def _add(scene: Any, camera: Track) -> None:
    """Add a camera with a key in each frame."""
    import bpy
    from mathutils import Matrix

    data = bpy.data.cameras.new(camera.name)
    camera_object = bpy.data.objects.new(camera.name, data)
    scene.collection.objects.link(camera_object)
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = camera.sensor
    data.sensor_height = camera.sensor * camera.aspect
    camera_object.rotation_mode = "QUATERNION"
    before = None
    for number, focal, place, axes in zip(
        camera.frames, camera.focal, camera.position, camera.rotation, strict=True
    ):
        frame, rotation = int(number), Matrix(axes.tolist()).to_quaternion()
        camera_object.location = place.tolist()
        if before is not None:
            rotation.make_compatible(before)
        camera_object.rotation_quaternion = before = rotation
        data.lens = float(focal)
        for path in ("location", "rotation_quaternion"):
            camera_object.keyframe_insert(path, frame=frame)
        data.keyframe_insert("lens", frame=frame)
