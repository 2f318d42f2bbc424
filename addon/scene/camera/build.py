"""Camera objects with one keyframe per frame, from the paths of the scene's cameras."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender import compat, owned
from ...blender.owned import Stage
from ...shot.path import Path, clip
from ...shot.shot import Shot


def build(shot: Shot, stage: Stage) -> list[bpy.types.Object]:
    """Build "Firetwin Camera <name>" for every path; the scene's camera stays, or is the first.

    Blender may cut the name short: `stage.camera(name)` finds the object.
    """
    before = stage.scene.camera
    chosen = before[owned.MARK] if before is not None and owned.ours(before) else ""
    collection = stage.part("Cameras")
    built = [_camera(view, collection, clip(view, shot.ground)) for view in shot.paths]
    if stage.scene.camera is None and built:
        stage.scene.camera = next((thing for thing in built if owned.ours(thing, chosen)), built[0])
    return built


def _camera(view: Path, collection: bpy.types.Collection, ends: tuple[float, float]) -> bpy.types.Object:
    name = f"Camera {view.camera.name}"
    data = bpy.data.cameras.new(f"Firetwin {name}")
    data.clip_start, data.clip_end = ends
    data.sensor_fit, data.sensor_width = "HORIZONTAL", view.sensor
    lens = 0.5 * view.sensor * (view.meet or 1.0) / view.halves[:, 0]
    if view.perspective or view.meet:
        data.lens = lens[0]
        if np.ptp(lens) > 0.0:
            compat.animate(data, "lens", 0, range(1, len(lens) + 1), lens)
    else:
        data.type, data.ortho_scale = "ORTHO", 2.0 * view.half[0]
    thing = owned.add(collection, name, data, what=f"camera {view.camera.name}")
    thing.rotation_mode = "QUATERNION"
    quaternions = _quaternions(view.rotation)
    thing.location, thing.rotation_quaternion = view.position[0], quaternions[0]
    if len(np.unique(view.position, axis=0)) > 1 or np.ptp(quaternions, axis=0).max() > 0.0:
        frames = range(1, len(quaternions) + 1)
        for axis in range(3):
            compat.animate(thing, "location", axis, frames, view.position[:, axis])
        for axis in range(4):
            compat.animate(thing, "rotation_quaternion", axis, frames, quaternions[:, axis])
    return thing


def _quaternions(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 4) quaternions of rotation matrices (n, 3, 3), without jumps in sign."""
    turned = [Matrix(matrix.tolist()).to_quaternion() for matrix in rotation]
    for before, after in itertools.pairwise(turned):
        after.make_compatible(before)
    return np.array([tuple(q) for q in turned])
