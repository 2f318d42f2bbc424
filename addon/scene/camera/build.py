"""Camera objects with one keyframe per frame, from the paths of the project's cameras."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
from firetwin_core.run import Run
from mathutils import Matrix

from .. import compat
from ..project import Project
from . import collections
from .paths import SENSOR, Path, paths

__all__ = ["build", "paths"]

NEAR, FAR = 0.5, 300_000.0  # m


def build(project: Project, run: Run, views: list[Path], scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Build "Firetwin Camera <name>" for every path; the first becomes the scene's camera."""
    collection = collections.fresh("Cameras", scene=scene)
    built = [_camera(view, collection) for view in views]
    scene.camera = built[0] if built else None
    return built


def _camera(view: Path, collection: bpy.types.Collection) -> bpy.types.Object:
    name = f"Camera {view.camera.name}"
    data = bpy.data.cameras.new(f"Firetwin {name}")
    data.clip_start, data.clip_end = NEAR, FAR
    data.sensor_fit, data.sensor_width = "HORIZONTAL", SENSOR
    if view.perspective:
        data.lens = view.camera.focal_length
    else:
        data.type, data.ortho_scale = "ORTHO", view.camera.swath
    thing = collections.add(collection, name, data)
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


def _quaternions(rotation: np.ndarray) -> np.ndarray:
    """(n, 4) quaternions of rotation matrices (n, 3, 3), without jumps in sign."""
    turned = [Matrix(matrix.tolist()).to_quaternion() for matrix in rotation]
    for before, after in itertools.pairwise(turned):
        after.make_compatible(before)
    return np.array([tuple(q) for q in turned])
