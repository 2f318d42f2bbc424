"""USD fire: a point instancer of flames, which are lit frame by frame.

A flame is two crossed cards, one metre wide and high, with a picture of a flame. The instancer has the
velocity of the flame's gas, and primvars with its temperature (K) and fireline intensity (kW/m). Its scales
are width, width and length (m). `ids` are the same for a flame in all frames.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from pxr import Sdf, UsdGeom, UsdShade, Vt

from . import flame_picture, usd_materials
from .scene_content import FlamePoints, SceneContent
from .usd_geometry import define_mesh, extent, half_quaternions, vectors
from .usd_library import new_stage, set_kind

RISE = 9.0
"""Speed (m/s) of a flame's gas, as in the flames' material."""
RADIANCE = 6.0
"""Radiance of the hottest part of a flame, in the scene's units (by eye)."""
_LIFE = (0.0, 0.2, 0.6, 1.0), (0.25, 1.0, 1.0, 0.2)  # size by age, as in `scene.fire.flames`
_CARD = "/World/Fire/Flames/Prototypes/Card"
_PRIMVARS = ("temperature", "intensity")


def write(content: SceneContent, out: Path) -> Path:
    """Write `fire.usdc` and the picture of a flame; return the layer."""
    assert content.flames is not None
    (out / "textures").mkdir(exist_ok=True)
    Image.fromarray(flame_picture.draw()).save(out / "textures" / "flame.png")
    path = out / "fire.usdc"
    stage = new_stage(path, content.rate, (int(content.frames[0]), int(content.frames[-1])))
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Fire").GetPrim(), "group")
    instancer = UsdGeom.PointInstancer.Define(stage, "/World/Fire/Flames")
    set_kind(instancer.GetPrim(), "component")
    UsdGeom.Scope.Define(stage, "/World/Fire/Flames/Prototypes")
    _define_card(stage)
    instancer.CreatePrototypesRel().SetTargets([_CARD])
    primvars = UsdGeom.PrimvarsAPI(instancer)
    arrays = {
        name: primvars.CreatePrimvar(name, Sdf.ValueTypeNames.FloatArray, "vertex") for name in _PRIMVARS
    }
    for frame, time in zip(content.frames.tolist(), content.times.tolist(), strict=True):
        _set_frame(instancer, arrays, content.flames, frame, time)
    stage.GetRootLayer().Save()
    return path


def _set_frame(
    instancer: Any, primvars: dict[str, Any], flames: FlamePoints, frame: int, time: float
) -> None:
    lit = flames.lit(time)
    size = np.interp((time - flames.arrival[lit]) / flames.residence[lit], *_LIFE)
    width, length = flames.width[lit] * size, flames.length[lit] * size
    place, along = flames.position[lit], directions(flames, lit)
    instancer.CreateProtoIndicesAttr().Set(Vt.IntArray(len(lit), 0), frame)
    instancer.CreateIdsAttr().Set(Vt.Int64Array.FromNumpy(lit.astype(np.int64)), frame)
    instancer.CreatePositionsAttr().Set(vectors(place), frame)
    instancer.CreateOrientationsAttr().Set(half_quaternions(orientations(flames, lit)), frame)
    instancer.CreateScalesAttr().Set(vectors(np.stack([width, width, length], axis=-1)), frame)
    instancer.CreateVelocitiesAttr().Set(vectors(RISE * along), frame)
    reach = np.maximum(width, length)[:, None]
    instancer.CreateExtentAttr().Set(extent(place, reach), frame)
    values = {
        "temperature": flames.kelvin[lit],
        "intensity": flames.intensity[lit],
    }
    for name, array in values.items():
        primvars[name].Set(Vt.FloatArray.FromNumpy(np.ascontiguousarray(array, np.float32)), frame)


def directions(flames: FlamePoints, lit: np.ndarray) -> np.ndarray:
    """Return unit vectors (n, 3) along flames, which tilt downwind."""
    east, north = np.array(flames.wind) / max(float(np.hypot(*flames.wind)), 1.0e-9)
    side, up = np.sin(flames.tilt[lit]), np.cos(flames.tilt[lit])
    return np.stack([east * side, north * side, up], axis=-1)


def orientations(flames: FlamePoints, lit: np.ndarray) -> np.ndarray:
    """Return unit quaternions (n, 4), w, x, y, z: a turn about the vertical, then a tilt downwind."""
    turn, tilt = np.pi * flames.seed[lit], 0.5 * flames.tilt[lit]
    east, north = np.array(flames.wind) / max(float(np.hypot(*flames.wind)), 1.0e-9)
    w, x, y = np.cos(tilt), -north * np.sin(tilt), east * np.sin(tilt)
    c, s = np.cos(turn), np.sin(turn)
    return np.stack([w * c, x * c + y * s, y * c - x * s, w * s], axis=-1)


def _define_card(stage: Any) -> None:
    UsdGeom.Xform.Define(stage, _CARD)
    set_kind(stage.GetPrimAtPath(_CARD), "subcomponent")
    corners = np.array([(-0.5, 0.0, 0.0), (0.5, 0.0, 0.0), (0.5, 0.0, 1.0), (-0.5, 0.0, 1.0)])
    points = np.concatenate([corners, corners[::-1, [1, 0, 2]]])
    triangles = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    normals = np.repeat([(0.0, -1.0, 0.0), (-1.0, 0.0, 0.0)], 4, axis=0)
    mesh = define_mesh(stage, f"{_CARD}/Cards", points, triangles, normals)
    mesh.CreateDoubleSidedAttr(True)
    uv = np.tile(np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32), (2, 1))
    primvars = UsdGeom.PrimvarsAPI(mesh)
    st = primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    st.Set(Vt.Vec2fArray.FromNumpy(uv))
    UsdGeom.Scope.Define(stage, f"{_CARD}/Looks")
    material = usd_materials.glowing(stage, f"{_CARD}/Looks/Flame", "./textures/flame.png", RADIANCE)
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
