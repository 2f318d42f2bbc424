"""USD cameras: poses and lenses, frame by frame.

USD counts focal lengths and apertures in tenths of a scene unit. A unit is a metre, so 50 mm are 0.5.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, UsdGeom

from .scene_content import CameraMove, SceneContent
from .usd_library import Identifiers, new_stage, set_kind

_TENTHS_PER_MM, _TENTHS_PER_M = 0.01, 10.0
_PANORAMA = 36.0, 18.0  # mm, sensor and lens of 90 degrees for a panorama, which USD does not have


def write(content: SceneContent, out: Path) -> Path:
    """Write `cameras.usdc`; return the layer."""
    path = out / "cameras.usdc"
    span = int(content.frames[0]), int(content.frames[-1])
    stage = new_stage(path, content.rate, span)
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Cameras").GetPrim(), "component")
    names = Identifiers()
    for move in content.cameras:
        _define(stage, f"/World/Cameras/{names.make(move.name)}", move)
    stage.GetRootLayer().Save()
    return path


def _define(stage: Any, path: str, move: CameraMove) -> None:
    camera = UsdGeom.Camera.Define(stage, path)
    prim = camera.GetPrim()
    prim.SetDisplayName(move.name)
    prim.SetCustomDataByKey("firetwin:projection", move.projection)
    pose = camera.AddTransformOp()
    samples = [Gf.Matrix4d(*matrix.ravel().tolist()) for matrix in pose_matrices(move)]
    still = all(sample == samples[0] for sample in samples)
    pose.Set(samples[0])
    if not still:
        for frame, sample in zip(move.frames, samples, strict=True):
            pose.Set(sample, int(frame))
    width, height, focal = _lens(move)
    if move.projection == "orthographic":
        camera.CreateProjectionAttr(UsdGeom.Tokens.orthographic)
    camera.CreateHorizontalApertureAttr(width)
    camera.CreateVerticalApertureAttr(height)
    _set(camera.CreateFocalLengthAttr(), move, focal.tolist())
    planes = [Gf.Vec2f(float(near), float(far)) for near, far in move.clip]
    _set(camera.CreateClippingRangeAttr(), move, planes)


def pose_matrices(move: CameraMove) -> np.ndarray:
    """Return the matrices (f, 4, 4) of a camera for row vectors, as USD has them."""
    matrix = np.zeros((len(move.frames), 4, 4))
    matrix[:, :3, :3] = np.swapaxes(move.rotation, 1, 2)
    matrix[:, 3, :3] = move.position
    matrix[:, 3, 3] = 1.0
    return matrix


def _lens(move: CameraMove) -> tuple[float, float, np.ndarray]:
    """Return width and height of the aperture and the focal lengths (f,), in tenths of a metre."""
    if move.projection == "orthographic":
        width, height = (_TENTHS_PER_M * size for size in move.swath)
        return width, height, np.full(len(move.frames), 0.5)
    if move.projection == "panorama":
        width, focal = _PANORAMA
        return (
            width * _TENTHS_PER_MM,
            width * _TENTHS_PER_MM,
            np.full(len(move.frames), focal * _TENTHS_PER_MM),
        )
    width, height = (_TENTHS_PER_MM * size for size in move.sensor)
    return width, height, _TENTHS_PER_MM * move.focal_length


def _set(attribute: Any, move: CameraMove, values: list[Any]) -> None:
    """Set an attribute, with time samples only if it changes."""
    attribute.Set(values[0])
    if any(value != values[0] for value in values):
        for frame, value in zip(move.frames, values, strict=True):
            attribute.Set(value, int(frame))
