"""Cameras of USD stages, by the USD library of Blender."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error, input_error
from ..limits import CAMERA_FRAMES
from ..progress import MessageCallback, Progress
from . import foreign
from .foreign import ForeignScene

_Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])  # from y up
_ORIGIN = tuple(f"cesium:georeferenceOrigin:{name}" for name in ("latitude", "longitude", "height"))
_LEAST_UNIT = 1.0e-9  # m


def read(path: Path, progress: Progress) -> ForeignScene:
    """Read the cameras of a stage.

    Raises
    ------
    InputError, Error
        The stage cannot be read.
    """
    return foreign.read(path, partial(in_blender, path.absolute()), progress)


def in_blender(path: Path, progress: Progress, tell: MessageCallback) -> ForeignScene:
    """Read a stage without its payloads (see `ForeignScene`)."""
    import bpy

    if hasattr(bpy.utils, "expose_bundled_modules"):
        bpy.utils.expose_bundled_modules()
    try:
        from pxr import Tf, Usd, UsdGeom
    except ImportError:
        raise Error(
            "this Blender has no USD library; use Blender from blender.org, or export Alembic"
        ) from None

    try:
        stage = Usd.Stage.Open(str(path), Usd.Stage.LoadNone)
    except Tf.ErrorException as error:
        reason = str(error.args[0].commentary).replace(f"{path}:", "line ").partition("\n")[0][:300]
        raise input_error(path, f"cannot be opened as a USD stage: {reason}") from None
    unit, rate = UsdGeom.GetStageMetersPerUnit(stage), stage.GetTimeCodesPerSecond()
    if not (_LEAST_UNIT < unit < 1.0 / _LEAST_UNIT and 0.0 < rate < 1.0e6):
        raise input_error(path, "has no valid metersPerUnit or timeCodesPerSecond")
    upright = _Z_UP if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y else np.eye(4)
    origin, cameras, omitted = None, [], []
    for prim in stage.Traverse():
        if prim.GetTypeName() == "CesiumGeoreferencePrim":
            values = [prim.GetAttribute(name).Get() for name in _ORIGIN]
            origin = None if None in values else (float(values[0]), float(values[1]), float(values[2]))
        elif prim.IsA(UsdGeom.Camera):
            camera = UsdGeom.Camera(prim)
            orthographic = camera.GetProjectionAttr().Get() == UsdGeom.Tokens.orthographic
            if orthographic or prim.GetCustomDataByKey("firetwin:projection") == "panorama":
                omitted.append(_name(prim))
            else:
                cameras.append(_sample(path, prim, camera, unit, upright))
    return ForeignScene(rate, origin, cameras, omitted)


def _name(prim: Any) -> str:
    return prim.GetDisplayName() or prim.GetName()


def _sample(path: Path, prim: Any, camera: Any, unit: float, upright: np.ndarray) -> dict[str, Any]:
    """Sample a camera in the frames between its first and last sample, and in its samples."""
    from pxr import Usd, UsdGeom

    aperture, focal = camera.GetHorizontalApertureAttr(), camera.GetFocalLengthAttr()
    times = {*aperture.GetTimeSamples(), *focal.GetTimeSamples()}
    above = prim
    while above and not above.IsPseudoRoot():
        if above.IsA(UsdGeom.Xformable):
            times |= {*UsdGeom.Xformable(above).GetTimeSamples()}
        above = above.GetParent()
    if (times and max(times) - min(times) > CAMERA_FRAMES) or len(times) > CAMERA_FRAMES:
        raise input_error(path, f'camera "{_name(prim)}" has more than {CAMERA_FRAMES:,} frames')
    if times:
        times |= {*np.arange(np.ceil(min(times)), np.floor(max(times)) + 1.0).tolist()}
    frames = sorted(times) or [1.0]
    codes = [Usd.TimeCode(frame) for frame in frames] if times else [Usd.TimeCode.Default()]
    cache, matrices = UsdGeom.XformCache(), []
    for code in codes:
        cache.SetTime(code)
        matrix = np.array(cache.GetLocalToWorldTransform(prim)).T  # USD's matrices are for rows
        matrix[:3, 3] *= unit
        matrices.append((upright @ matrix).tolist())
    widths = np.array([aperture.Get(code) or 0.0 for code in codes])
    lenses = np.array([focal.Get(code) or 0.0 for code in codes])
    if not (lenses > 0.0).all():
        raise input_error(path, f'camera "{_name(prim)}" has no focal length')
    return {
        "name": _name(prim),
        "frames": frames,
        "matrix": matrices,
        "half": (0.5 * widths / lenses).tolist(),
        "sensor": float(widths[0] * 100.0 * unit),  # apertures are in tenths of a unit
    }
