"""USD cameras: poses and lenses, frame by frame.

USD counts focal lengths and apertures in tenths of a scene unit. A unit is a metre, so 50 mm are 0.5.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, UsdGeom

from ..geometry.camera_track import CameraTrack
from .scene_content import SceneContent
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
    for track in content.cameras:
        _define(stage, f"/World/Cameras/{names.make(track.name)}", track)
    stage.GetRootLayer().Save()
    return path


def _define(stage: Any, path: str, track: CameraTrack) -> None:
    camera = UsdGeom.Camera.Define(stage, path)
    prim = camera.GetPrim()
    prim.SetDisplayName(track.name)
    prim.SetCustomDataByKey("firetwin:projection", track.projection)
    pose = camera.AddTransformOp()
    samples = [Gf.Matrix4d(*matrix.ravel().tolist()) for matrix in pose_matrices(track)]
    still = all(sample == samples[0] for sample in samples)
    pose.Set(samples[0])
    if not still:
        for frame, sample in zip(track.frames, samples, strict=True):
            pose.Set(sample, int(frame))
    width, height, focal = _lens(track)
    if track.projection == "orthographic":
        camera.CreateProjectionAttr(UsdGeom.Tokens.orthographic)
    camera.CreateHorizontalApertureAttr(width)
    camera.CreateVerticalApertureAttr(height)
    _set(camera.CreateFocalLengthAttr(), track, focal.tolist())
    planes = [Gf.Vec2f(float(near), float(far)) for near, far in track.clip]
    _set(camera.CreateClippingRangeAttr(), track, planes)


def pose_matrices(track: CameraTrack) -> np.ndarray:
    """Return the matrices (f, 4, 4) of a camera for row vectors, as USD has them."""
    matrix = np.zeros((len(track.frames), 4, 4))
    matrix[:, :3, :3] = np.swapaxes(track.rotation, 1, 2)
    matrix[:, 3, :3] = track.position
    matrix[:, 3, 3] = 1.0
    return matrix


def _lens(track: CameraTrack) -> tuple[float, float, np.ndarray]:
    """Return width and height of the aperture and the focal lengths (f,), in tenths of a metre."""
    if track.projection == "orthographic":
        width, height = (2.0 * _TENTHS_PER_M * half for half in track.half[0].tolist())
        return width, height, np.full(len(track.frames), 0.5)
    if track.projection == "panorama":
        width, focal = _PANORAMA
        return (
            width * _TENTHS_PER_MM,
            width * _TENTHS_PER_MM,
            np.full(len(track.frames), focal * _TENTHS_PER_MM),
        )
    width = _TENTHS_PER_MM * track.sensor
    return width, width * track.aspect, _TENTHS_PER_MM * track.focal


def _set(attribute: Any, track: CameraTrack, values: list[Any]) -> None:
    """Set an attribute, with time samples only if it changes."""
    attribute.Set(values[0])
    if any(value != values[0] for value in values):
        for frame, value in zip(track.frames, values, strict=True):
            attribute.Set(value, int(frame))
