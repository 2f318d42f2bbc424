"""Camera objects with few keyframes: F-curves fitted to camera paths, with handles that artists can move.

An existing object is updated in place: it retains its name, its children, and other properties that an
artist set, such as depth of field.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import compat, owned
from ...blender.owned import Stage
from ...geometry.quaternion import quaternions
from ...shot.cameras import sparse_keys
from ...shot.cameras.path import Path, clip
from ...shot.shot import Shot
from . import edit_detection, read_edits

# Tolerance of the fit between keyframes, in pixels: rotation, zoom, and parallax of the nearest ground.
_PIXELS = 0.05
_LEAST = 0.005  # m, minimum tolerance of a camera's position
_CLIPS, _CLIPPED = ("clip_start", "clip_end"), 0.01  # properties, and tolerance as a part of the least value


def build(shot: Shot, stage: Stage) -> list[bpy.types.Object]:
    """Build "Firetwin Camera <name>" for every path; the first becomes the scene's camera if there is none.

    Blender may truncate the name: `stage.camera(name)` finds the object.
    """
    names = [view.camera.name for view in shot.paths]
    there = {name: obj for name in names if (obj := stage.camera(name)) is not None}
    collection = stage.part("Cameras", keep=there.values())
    read_edits.store_origin(stage, shot.local_frame)
    built = [_build_camera(view, collection, shot, there.get(view.camera.name)) for view in shot.paths]
    if stage.scene.camera is None and built:
        stage.scene.camera = built[0]
    return built


def _tolerance(view: Path, shot: Shot) -> tuple[float, float, float]:
    """Return the tolerances of a camera's keyframes: m, radians, and fractions of its focal length."""
    pixel = view.pixel
    near = 1.0
    if view.perspective:
        near = 0.5 * float(np.min(view.position[:, 2] - shot.ground.up(*view.position[:, :2].T)))
    turn = pixel / (view.meet or 1.0) if view.perspective or view.meet else 1.0
    zoom = _PIXELS * pixel / view.halves.max()
    return max(_PIXELS * pixel * near, _LEAST), _PIXELS * turn, zoom


def _build_camera(
    view: Path, collection: bpy.types.Collection, shot: Shot, obj: bpy.types.Object | None
) -> bpy.types.Object:
    name = f"Camera {view.camera.name}"
    data = bpy.data.cameras.new(f"{owned.ROOT} {name}") if obj is None else obj.data
    if obj is None:
        obj = owned.add(collection, name, data, what=f"camera {view.camera.name}")
    _set_clip_planes(data, view, shot)
    if not read_edits.has_rig(obj):
        _set_pose_and_lens(view, shot, obj)
    edit_detection.store_state(obj)
    return obj


def _set_clip_planes(data: bpy.types.Camera, view: Path, shot: Shot) -> None:
    """Set the clip planes, and animate them if they change."""
    compat.remove_fcurves(data, _CLIPS)
    if view.clips is None:
        data.clip_start, data.clip_end = clip(view, shot.ground)
        return
    for what, values in zip(_CLIPS, view.clips.T, strict=True):
        _animate(data, what, values[:, None], _CLIPPED * float(values.min()))


def _set_panorama(data: bpy.types.Camera, apart: float) -> None:
    """Set up an equirectangular camera with spherical stereo, with less eye distance towards the poles."""
    data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
    stereo = data.stereo
    stereo.use_spherical_stereo = stereo.use_pole_merge = True
    stereo.interocular_distance, stereo.convergence_mode, stereo.pivot = apart, "PARALLEL", "CENTER"


def _set_pose_and_lens(view: Path, shot: Shot, obj: bpy.types.Object) -> None:
    """Set the animation and the lens of a camera object from a path."""
    data = obj.data
    moved, turned, zoomed = _tolerance(view, shot)
    compat.remove_fcurves(data, edit_detection.LENS)
    compat.remove_fcurves(obj, edit_detection.POSE)
    data.sensor_fit, data.sensor_width = "HORIZONTAL", view.sensor
    if view.around:
        _set_panorama(data, view.apart)
    elif view.perspective or view.meet:
        data.type = "PERSP"
        lens = 0.5 * view.sensor * (view.meet or 1.0) / view.halves[:, :1]
        _animate(data, "lens", lens, zoomed * lens.min())
    else:
        data.type, data.ortho_scale = "ORTHO", 2.0 * view.half[0]
    obj.rotation_mode, obj.scale = "QUATERNION", (1.0, 1.0, 1.0)
    _animate(obj, "location", view.position, moved)
    # Unit quaternions hold half the angle.
    _animate(obj, "rotation_quaternion", quaternions(view.rotation), 0.5 * turned)


def _animate(block: bpy.types.ID, what: str, values: NDArray[np.float64], tolerance: float) -> None:
    """Animate a property by values (frames, channels) with as few keyframes as possible; none if constant."""
    setattr(block, what, values[0] if values.shape[1] > 1 else values[0, 0])
    if np.linalg.norm(values - values[0], axis=1).max() > 0.1 * tolerance:
        kept, slopes = sparse_keys.keys(values, tolerance)
        for axis in range(values.shape[1]):
            compat.animate_smoothly(block, what, axis, kept + 1, values[kept, axis], slopes[:, axis])
