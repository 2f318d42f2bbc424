"""USD smoke: OpenVDB volumes, one file for each frame and layer, and a README of their grids."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from pxr import Gf, Sdf, UsdGeom, UsdVol, Vt

from ..errors import writing
from ..shot.shot import Shot
from .scene_content import SceneContent, SmokeLayer
from .usd_library import new_stage, set_kind

FOLDER = "smoke"
FIELDS = ("density", "temperature")
"""Grids that volumes refer to, if the files have them."""
ALBEDO, ANISOTROPY = (0.84, 0.81, 0.77), 0.1
"""Single-scattering albedo and anisotropy that suit the smoke in a path tracer (by eye)."""
_README = """\
OpenVDB files of the smoke, NAME_FRAME.vdb, one for each frame of the film.

Axes: x east, y north, z up, metres, origin as in ../georeference.json.
{layers}
Grids:
{grids}
A path tracer needs density alone: extinction in 1/m, with the albedo {albedo} and the
anisotropy {anisotropy}. If a program expects scattering and absorption, scattering is density times albedo.
"""
_GRIDS = {
    "density": "extinction of visible light, 1/m",
    "temperature": "temperature of the air, K",
    "flames": "extinction of the flames' soot, 1/m",
    "fresh": "1 for fresh smoke, 0 for aged smoke",
    "sun": "fourth root of the sunlight that reaches the smoke, 0..1",
    "sky": "skylight that reaches the smoke, 0..1",
    "hidden": "1 for smoke that other smoke hides from all cameras",
    "glow": "light of the flames on the smoke, 1 among flames of 1 GW",
    "shade": "thickness of the smoke for rays of light",
    "dilution": "concentration of the smoke, relative to 10 mg/m3",
    "size": "radius of the puffs, relative to 600 m",
}


def write(content: SceneContent, out: Path, shot: Shot) -> Path:
    """Copy the volumes to `smoke/` and write `smoke.usda`; return the layer."""
    folder = out / FOLDER
    folder.mkdir()
    path = out / "smoke.usda"
    stage = new_stage(path, content.rate, (int(content.frames[0]), int(content.frames[-1])))
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Smoke").GetPrim(), "component")
    found: dict[str, str] = {}
    for layer in content.smoke:
        for file in layer.files.values():
            with writing(out):
                shutil.copyfile(file, folder / file.name)
        found |= _define(stage, layer)
    stage.GetRootLayer().Save()
    text = _README.format(
        layers="".join(f"{layer.name}_*.vdb: {len(layer.files)} frames\n" for layer in content.smoke),
        grids="\n".join(f"  {name:<12} {_GRIDS.get(name, '')}" for name in found),
        albedo=ALBEDO,
        anisotropy=ANISOTROPY,
    )
    (folder / "README.txt").write_text(text, encoding="utf-8")
    return path


def _define(stage: Any, layer: SmokeLayer) -> dict[str, str]:
    """Define the volume of a layer, and return its grids."""
    boxes = {frame: grids(file) for frame, file in layer.files.items()}
    names = {name: "" for grid in boxes.values() for name in grid}
    volume = UsdVol.Volume.Define(stage, f"/World/Smoke/{layer.name.title()}")
    prim = volume.GetPrim()
    prim.SetCustomDataByKey("firetwin:scatterColor", Gf.Vec3f(*ALBEDO))
    prim.SetCustomDataByKey("firetwin:anisotropy", ANISOTROPY)
    prim.SetCustomDataByKey("firetwin:densityUnit", "extinction, 1/m")
    for name in (each for each in FIELDS if each in names):
        asset = UsdVol.OpenVDBAsset.Define(stage, f"{prim.GetPath()}/{name}")
        asset.CreateFieldNameAttr(name)
        asset.CreateFieldDataTypeAttr("float")
        attribute = asset.CreateFilePathAttr()
        for frame, file in layer.files.items():
            attribute.Set(Sdf.AssetPath(f"./{FOLDER}/{file.name}"), frame)
        attribute.Set(Sdf.AssetPath(f"./{FOLDER}/{next(iter(layer.files.values())).name}"))
        volume.CreateFieldRelationship(name, asset.GetPath())
    attribute = volume.CreateExtentAttr()
    for frame, grid in boxes.items():
        if grid:
            low = [min(box[0][axis] for box in grid.values()) for axis in range(3)]
            high = [max(box[1][axis] for box in grid.values()) for axis in range(3)]
            attribute.Set(Vt.Vec3fArray([Gf.Vec3f(*low), Gf.Vec3f(*high)]), frame)
    return names


def grids(file: Path) -> dict[str, tuple[tuple[float, ...], tuple[float, ...]]]:
    """Read the grids of an OpenVDB file: name, and the lowest and the highest corner (m)."""
    import openvdb

    found = {}
    for grid in openvdb.readAllGridMetadata(str(file)):
        low, high = grid.metadata.get("file_bbox_min"), grid.metadata.get("file_bbox_max")
        if low is None or any(a > b for a, b in zip(low, high, strict=True)):
            continue  # without voxels
        ends = [
            grid.transform.indexToWorld(tuple(at + shift for at in corner))
            for corner, shift in ((low, -0.5), (high, 0.5))
        ]
        found[grid.name] = (ends[0], ends[1])
    return found
