"""USD places: a transform at each station, named place and ignition, on the ground."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Sdf, UsdGeom

from ..shot.shot import Shot
from .places import Place
from .scene_content import SceneContent
from .usd_library import Identifiers, new_stage, set_kind


def write(content: SceneContent, out: Path, shot: Shot, places: list[Place]) -> Path:
    """Write `stations.usda`; return the layer."""
    path = out / "stations.usda"
    stage = new_stage(path, content.rate)
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Stations").GetPrim(), "group")
    names = Identifiers()
    for place in places:
        at = shot.ground.point(place.latitude, place.longitude)[0]
        _define(stage, f"/World/Stations/{names.make(place.name)}", place, at)
    stage.GetRootLayer().Save()
    return path


def _define(stage: Any, path: str, place: Place, at: np.ndarray) -> None:
    point = UsdGeom.Xform.Define(stage, path)
    point.AddTranslateOp().Set(Gf.Vec3d(*map(float, at)))
    prim = point.GetPrim()
    prim.SetDisplayName(place.name)
    set_kind(prim, "component")
    for name, kind, value in (
        ("name", Sdf.ValueTypeNames.String, place.name),
        ("symbol", Sdf.ValueTypeNames.String, place.symbol),
        ("text", Sdf.ValueTypeNames.StringArray, list(place.lines)),
        ("latitude", Sdf.ValueTypeNames.Double, place.latitude),
        ("longitude", Sdf.ValueTypeNames.Double, place.longitude),
        ("exercise", Sdf.ValueTypeNames.Bool, place.exercise),
    ):
        prim.CreateAttribute(f"userProperties:{name}", kind, True).Set(value)
