"""Read edits: writes an artist's changes to camera objects back into the settings: pose, lens, name."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from firetwin_core import geo
from mathutils import Euler, Matrix, Quaternion
from numpy.typing import NDArray

from ...blender import compat, owned
from ...blender.owned import Stage
from ...errors import Error
from ...geometry.quaternion import matrices, quaternions
from ...shot.cameras import sparse_keys
from ...shot.cameras.rigs import _lens, poses
from ...shot.settings import Camera
from . import edit_detection, ground_raycast

_PLACE = "firetwin_place"  # property of the root: latitude and longitude of the scene's origin
_PIXEL = 0.25  # pixels, tolerance of the fit between poses; also applies at an artist's keyframes
_LEAST = 0.02  # m, minimum tolerance of a camera's position
_PREFIX = f"{owned.ROOT} Camera "


def store_origin(stage: Stage, frame: geo.LocalFrame) -> None:
    """Store the geographic position of the scene's origin."""
    stage.root[_PLACE] = [frame.latitude, frame.longitude]


def local_frame(stage: Stage) -> geo.LocalFrame | None:
    """Return the scene's local frame (east, north, up); None before cameras are built."""
    where = stage.root.get(_PLACE)
    return None if where is None else geo.LocalFrame(where[0], where[1], 0.0)


def built_frame(stage: Stage) -> geo.LocalFrame:
    """Return the scene's local frame, which must exist.

    Raises
    ------
    Error
        Cameras are not built.
    """
    frame = local_frame(stage)
    if frame is None:
        raise Error("the scene has no cameras built from a run; build the scene first")
    return frame


def has_rig(obj: bpy.types.Object) -> bool:
    """Return whether an artist's rig (parent, constraint, driver) moves an object; the rig is not changed."""
    data = obj.animation_data
    return bool(
        obj.parent
        or any(not constraint.mute for constraint in obj.constraints)
        or any((*obj.delta_location, *obj.delta_rotation_euler))
        or (data is not None and (data.drivers or data.nla_tracks))
    )


@dataclass(frozen=True)
class EvaluatedPath:
    """Evaluated path of a camera object over all frames of the shot.

    Attributes
    ----------
    place, rotation
        (frames, 3) m and (frames, 3, 3), columns right, up and back, in the scene.
    lens
        (frames,) focal length, mm.
    sensor
        Width of the sensor that corresponds to the picture's width, mm.
    keyed
        Frames, from 0, at which the artist set keyframes.
    """

    place: NDArray[np.float64]
    rotation: NDArray[np.float64]
    lens: NDArray[np.float64]
    sensor: float
    keyed: tuple[int, ...]


def evaluate_path(
    scene: bpy.types.Scene, obj: bpy.types.Object, frames: int, size: tuple[int, int]
) -> EvaluatedPath:
    """Evaluate an object's path in each frame, however it is animated.

    Parameters
    ----------
    size
        Width and height of the camera's images, pixels.
    """
    place, quaternion = _step_frames(scene, obj, frames) if has_rig(obj) else _evaluate_curves(obj, frames)
    (lens,) = _evaluate_property(obj.data, "lens", frames).T
    return EvaluatedPath(
        place, matrices(quaternion), lens, _sensor_width(obj.data, size), _keyframes(obj, frames)
    )


def _evaluate_curves(obj: bpy.types.Object, frames: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return positions (frames, 3) and quaternions (frames, 4) of an object that only its F-curves move."""
    place = _evaluate_property(obj, "location", frames)
    if obj.rotation_mode == "QUATERNION":
        return place, _evaluate_property(obj, "rotation_quaternion", frames)
    if obj.rotation_mode == "AXIS_ANGLE":
        turns = (
            Quaternion(row[1:], row[0]) for row in _evaluate_property(obj, "rotation_axis_angle", frames)
        )
    else:
        rows = _evaluate_property(obj, "rotation_euler", frames)
        turns = (Euler(row, obj.rotation_mode).to_quaternion() for row in rows)
    return place, np.array([tuple(turn) for turn in turns], np.float64)


def _evaluate_property(block: bpy.types.ID, name: str, frames: int) -> NDArray[np.float64]:
    """Evaluate a property of a data-block in every frame (frames, channels)."""
    still = np.atleast_1d(np.array(getattr(block, name), np.float64))
    values = np.repeat(still[None], frames, axis=0)
    for curve in compat.fcurves(block):
        if curve.data_path == name and not curve.mute:
            values[:, curve.array_index] = [curve.evaluate(frame) for frame in range(1, frames + 1)]
    return values


def _step_frames(
    scene: bpy.types.Scene, obj: bpy.types.Object, frames: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Step through frames to get positions (frames, 3) and quaternions (frames, 4) of a rigged object."""
    before, layer = (scene.frame_current, scene.frame_subframe), scene.view_layers[0]
    poses = []
    try:
        for frame in range(1, frames + 1):
            scene.frame_set(frame)
            poses.append(matrix_pose(obj.evaluated_get(layer.depsgraph).matrix_world))
    finally:
        scene.frame_set(before[0], subframe=before[1])
    place, turn = (np.array(column) for column in zip(*poses, strict=True))
    return place, quaternions(turn)


def _keyframes(obj: bpy.types.Object, frames: int) -> tuple[int, ...]:
    curves = (*compat.fcurves(obj), *compat.fcurves(obj.data))
    keyed = {round(point.co[0]) - 1 for curve in curves for point in curve.keyframe_points}
    return tuple(sorted(frame for frame in keyed if 0 <= frame < frames))


def _sensor_width(data: bpy.types.Camera, size: tuple[int, int]) -> float:
    """Return the sensor width (mm) that, at this focal length, gives the same horizontal field of view."""
    width, height = size
    if data.sensor_fit == "VERTICAL":
        return data.sensor_height * width / height
    if data.sensor_fit == "AUTO" and height > width:
        return data.sensor_width * width / height
    return data.sensor_width


def fit_poses(path: EvaluatedPath, frame: geo.LocalFrame, width: int, near: float = 0.0) -> poses.Poses:
    """Fit a rig of few poses to the path of a camera object, within the tolerance.

    Parameters
    ----------
    width
        Width of the camera's images, pixels.
    near
        Distance of the nearest terrain, m, which determines the tolerance.
    """
    pixel = path.sensor / path.lens.max() / width
    values = np.hstack(
        [
            path.place / max(_PIXEL * pixel * near, _LEAST),
            # half-angles: unit quaternions
            quaternions(path.rotation) / (0.5 * _PIXEL * pixel),
            np.log(path.lens)[:, None] / (_PIXEL * 2.0 / width),
        ]
    )
    still = np.ptp(values, axis=0).max() < 0.1
    kept = np.zeros(1, np.int64) if still else sparse_keys.fit(values, 1.0, path.keyed)
    at = kept / max(len(path.lens) - 1, 1)
    lens = np.array([_shorten(each) for each in path.lens[kept]])
    keys = poses.keyed(frame, at, path.place[kept], path.rotation[kept], lens)
    return poses.Poses(_shorten(path.lens[0]), _shorten(path.sensor), keys)


def _shorten(value: float) -> float:
    """Return the shortest decimal number with the same float32 value: 17.3, not 17.299999237."""
    return float(str(np.float32(value)))


def update_cameras(
    scene: bpy.types.Scene,
    cameras: Sequence[Camera],
    size: tuple[int, int],
    frames: int,
    tell: Callable[[str], None] = lambda text: None,
) -> tuple[Camera, ...]:
    """Return the cameras of the settings, updated with an artist's edits of their objects in a scene.

    Parameters
    ----------
    size
        Width and height of images of cameras without a `resolution`.
    frames
        Number of frames of the shot.
    tell
        Receives a message for each edit that settings cannot express.
    """
    edited = list(cameras)
    if not owned.has_data(scene):
        return tuple(edited)
    stage = owned.stage(scene)
    frame, taken = local_frame(stage), {camera.name for camera in cameras}
    for i, before in enumerate(cameras):
        obj = stage.camera(before.name)
        if (
            frame is None
            or obj is None
            or obj.type != "CAMERA"
            or not (changed := edit_detection.changed_parts(obj))
        ):
            continue
        name = (
            _camera_name(obj.name, before.name, taken - {before.name}) if "name" in changed else before.name
        )
        taken.add(name)
        edited[i], message = _update_camera(stage, obj, replace(edited[i], name=name), changed, frames, size)
        owned.mark(obj, f"camera {name}")
        edited = [_rename_followed(each, before.name, name) for each in edited]
        if message:
            tell(f'camera "{name}": {message}')
        else:
            edit_detection.store_state(obj)
    return tuple(edited)


def _update_camera(
    stage: Stage,
    obj: bpy.types.Object,
    before: Camera,
    changed: set[str],
    frames: int,
    size: tuple[int, int],
) -> tuple[Camera, str]:
    """Return the camera with its edits, and a message on edits that settings cannot express."""
    data, size = obj.data, before.resolution or size
    if not changed & {"pose", "lens"}:
        return before, ""
    if data.type == "ORTHO" and "pose" not in changed and hasattr(before.rig, "swath"):
        return replace(before, rig=replace(before.rig, swath=_shorten(data.ortho_scale))), ""
    if data.type != "PERSP":
        return before, f"edits of a camera of type {data.type.lower()} cannot be saved in a scene file"
    message = "lens shift cannot be saved in a scene file" if data.shift_x or data.shift_y else ""
    still = data.animation_data is None and not isinstance(before.rig, poses.Poses)
    if changed & {"pose", "lens"} == {"lens"} and still and isinstance(before.rig, _lens.LensRig):
        lens = {"focal_length": _shorten(data.lens), "sensor_width": _shorten(_sensor_width(data, size))}
        return replace(before, rig=replace(before.rig, **lens)), message
    path = evaluate_path(stage.scene, obj, frames, size)
    near = 0.5 * ground_raycast.height_above_terrain(stage, path.place[:: max(len(path.place) // 50, 1)])
    rig = fit_poses(path, built_frame(stage), size[0], near)
    return replace(before, rig=rig), message


def _rename_followed(camera: Camera, old: str, new: str) -> Camera:
    """Update the name of a renamed camera that this camera follows."""
    if old == new or getattr(camera.rig, "follows", None) != old:
        return camera
    return replace(camera, rig=replace(camera.rig, follows=new))


def _camera_name(text: str, before: str, taken: set[str]) -> str:
    """Make a valid, unique camera name from an object's name: letters, digits, - and _."""
    given = re.sub(r"[^A-Za-z0-9_-]+", "-", text.removeprefix(_PREFIX)).strip("-_") or before
    found, number = given, 2
    while found in taken:
        found, number = f"{given}-{number}", number + 1
    return found


def matrix_pose(matrix: Matrix) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return position (3,) and rotation matrix (3, 3) of a Blender matrix, without its scale."""
    pose = np.array(matrix, np.float64)
    return pose[:3, 3], pose[:3, :3] / np.linalg.norm(pose[:3, :3], axis=0)
