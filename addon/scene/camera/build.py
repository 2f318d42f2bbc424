"""Camera objects with as few keyframes as their paths allow, each with handles that people can move."""

from __future__ import annotations

import itertools

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender import compat, owned
from ...blender.owned import Stage
from ...shot import sparse
from ...shot.path import Path, clip
from ...shot.shot import Shot

# How far a picture may be off between keys: turned, zoomed, or moved as the nearest ground sees it, pixels.
_PIXELS = 0.05
_LEAST = 0.005  # m that a camera may be off its path in any case


def build(shot: Shot, stage: Stage) -> list[bpy.types.Object]:
    """Build "Firetwin Camera <name>" for every path; the scene's camera stays, or is the first.

    Blender may cut the name short: `stage.camera(name)` finds the object.
    """
    before = stage.scene.camera
    chosen = before[owned.MARK] if before is not None and owned.ours(before) else ""
    collection = stage.part("Cameras")
    built = [_camera(view, collection, shot) for view in shot.paths]
    if stage.scene.camera is None and built:
        stage.scene.camera = next((thing for thing in built if owned.ours(thing, chosen)), built[0])
    return built


def _camera(view: Path, collection: bpy.types.Collection, shot: Shot) -> bpy.types.Object:
    name = f"Camera {view.camera.name}"
    data = bpy.data.cameras.new(f"Firetwin {name}")
    data.clip_start, data.clip_end = clip(view, shot.ground)
    data.sensor_fit, data.sensor_width = "HORIZONTAL", view.sensor
    pixel = view.pixel
    if view.around:
        _see_around(data, view.apart)
    elif view.perspective or view.meet:
        lens = 0.5 * view.sensor * (view.meet or 1.0) / view.halves[:, :1]
        _animate(data, "lens", lens, _PIXELS * pixel / view.halves.max() * lens.min())
    else:
        data.type, data.ortho_scale = "ORTHO", 2.0 * view.half[0]
    thing = owned.add(collection, name, data, what=f"camera {view.camera.name}")
    thing.rotation_mode = "QUATERNION"
    quaternions = _quaternions(view.rotation)
    near = 1.0
    if view.perspective:
        near = 0.5 * float(np.min(view.position[:, 2] - shot.ground.up(*view.position[:, :2].T)))
    turn = pixel / (view.meet or 1.0) if view.perspective or view.meet else 1.0
    _animate(thing, "location", view.position, max(_PIXELS * pixel * near, _LEAST))
    _animate(thing, "rotation_quaternion", quaternions, 0.5 * _PIXELS * turn)  # half the angle is in them
    return thing


def _see_around(data: bpy.types.Camera, apart: float) -> None:
    """Equirectangular, with eyes on a circle (spherical stereo) that come together towards the poles."""
    data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
    stereo = data.stereo
    stereo.use_spherical_stereo = stereo.use_pole_merge = True
    stereo.interocular_distance, stereo.convergence_mode, stereo.pivot = apart, "PARALLEL", "CENTER"


def _animate(block: bpy.types.ID, what: str, values: NDArray[np.float64], tolerance: float) -> None:
    """Set a property to values (frames, channels) in keys as few as that allows; one that stays has none."""
    setattr(block, what, values[0] if values.shape[1] > 1 else values[0, 0])
    if np.linalg.norm(values - values[0], axis=1).max() > 0.1 * tolerance:
        kept, slopes = sparse.keys(values, tolerance)
        for axis in range(values.shape[1]):
            compat.animate_smoothly(block, what, axis, kept + 1, values[kept, axis], slopes[:, axis])


def _quaternions(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 4) quaternions of rotation matrices (n, 3, 3), without jumps in sign."""
    turned = [Matrix(matrix.tolist()).to_quaternion() for matrix in rotation]
    for before, after in itertools.pairwise(turned):
        after.make_compatible(before)
    return np.array([tuple(q) for q in turned])
