"""Place of a USD scene on the Earth, in the three forms that programs read today.

- Cesium for Omniverse and Unreal: a prim of the type CesiumGeoreferencePrim.
- Omniverse: attributes of OmniWGS84ReferencePositionAPI on the default prim.
- The proposal of the AOUSD for coordinate reference systems: a prim with the WKT of the scene's axes.
"""

from __future__ import annotations

from typing import Any

from pxr import Gf, Sdf

from ..shot.georeference import Georeference


def define(stage: Any, place: Georeference) -> None:
    """Define the place of the stage's default prim on the Earth."""
    world = stage.GetDefaultPrim()
    _define_cesium(stage, place)
    _set_omniverse(world, place)
    _define_crs(stage, world, place)


def _attribute(prim: Any, name: str, kind: Any, value: Any, uniform: bool = False) -> None:
    variability = Sdf.VariabilityUniform if uniform else Sdf.VariabilityVarying
    prim.CreateAttribute(name, kind, False, variability).Set(value)


def _define_cesium(stage: Any, place: Georeference) -> None:
    prim = stage.DefinePrim("/CesiumGeoreference", "CesiumGeoreferencePrim")
    for name, value in (
        ("latitude", place.latitude),
        ("longitude", place.longitude),
        ("height", place.height),
    ):
        _attribute(prim, f"cesium:georeferenceOrigin:{name}", Sdf.ValueTypeNames.Double, value)


def _set_omniverse(world: Any, place: Georeference) -> None:
    world.AddAppliedSchema("OmniWGS84ReferencePositionAPI")
    stem = "omni:geospatial:wgs84:reference"
    position = Gf.Vec3d(place.latitude, place.longitude, place.height)
    _attribute(world, f"{stem}:referencePosition", Sdf.ValueTypeNames.Double3, position)
    _attribute(world, f"{stem}:tangentPlane", Sdf.ValueTypeNames.Token, "ENU")
    _attribute(world, f"{stem}:orientation", Sdf.ValueTypeNames.Double3, Gf.Vec3d(0.0))


def _define_crs(stage: Any, world: Any, place: Georeference) -> None:
    prim = stage.DefinePrim("/CoordinateReferenceSystem", "CoordinateReferenceSystem")
    _attribute(prim, "crs:wkt", Sdf.ValueTypeNames.Token, place.wkt, uniform=True)
    world.AddAppliedSchema("CRSBindingAPI")
    world.CreateRelationship("crs:binding", False).SetTargets([prim.GetPath()])
    world.SetCustomDataByKey("firetwin:crs:wkt", place.wkt)
