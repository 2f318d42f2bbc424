"""USD smoke: OpenVDB volumes, one file for each frame and layer, and a README of their grids."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pxr import Gf, Sdf, UsdGeom, UsdVol, Vt

from ..errors import writing
from ..shot.shot import Shot
from .scene_content import SceneContent, SmokeLayer
from .usd_library import new_stage, set_kind

FOLDER = "smoke"
FIELDS = ("density", "temperature")
"""Fields of a volume, as far as its files have them."""
_EXTINCTION, _PER_DILUTION = "1/m", 0.04
"""Unit of extinction, and extinction (1/m) of a dilution of 1e-5 kg/m3 (`scene.smoke.material`)."""
ALBEDO, ANISOTROPY = (0.84, 0.81, 0.77), 0.1
"""Single-scattering albedo and anisotropy that suit the smoke in a path tracer (by eye)."""
_README = """\
OpenVDB files of the smoke, NAME_FRAME.vdb, by frame of the film.

Axes: x east, y north, z up, metres, origin as in ../georeference.json.
{layers}
Grids:
{grids}
A path tracer needs {field} alone: {scale:g} times its value is the extinction in 1/m. Suitable
values are an albedo of {albedo} and an anisotropy of {anisotropy}. If a program expects scattering and
absorption, scattering is extinction times albedo.
"""
_GRIDS = {
    "density": "extinction of visible light, or with other units the depth inside the smoke",
    "dilution": "concentration of the smoke",
    "flame": "power of flames in the smoke, 1: 1 GW",
    "fresh": "1 for fresh smoke, 0 for aged smoke",
    "glow": "light of the flames on the smoke, 1 among flames of 1 GW",
    "hidden": "1 for smoke that other smoke hides from all cameras",
    "shade": "concentration of the smoke without detail, for rays of light",
    "size": "length below which only noise adds detail",
    "sky": "skylight that reaches the smoke, 0..1",
    "sun": "fourth root of the sunlight that reaches the smoke, 0..1",
    "temperature": "temperature; for a solved flow in the files temperature_*.vdb, 0 outside of warm air",
}


@dataclass(frozen=True)
class Grid:
    """A grid of a volume file: its unit, and its lowest and highest corner, m."""

    unit: str
    low: tuple[float, ...]
    high: tuple[float, ...]


def write(content: SceneContent, out: Path, shot: Shot) -> Path:
    """Copy the volumes to `smoke/` and write `smoke.usdc`; return the layer."""
    folder = out / FOLDER
    folder.mkdir(exist_ok=True)
    path = out / "smoke.usdc"
    stage = new_stage(path, content.rate, (int(content.frames[0]), int(content.frames[-1])))
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Smoke").GetPrim(), "component")
    grids: dict[str, Grid] = {}
    for layer in content.smoke:
        for file in layer.files.values():
            with writing(out):
                shutil.copyfile(file, folder / file.name)
        grids |= _define(stage, layer)
    stage.GetRootLayer().Save()
    field, scale = thickness(grids)
    text = _README.format(
        layers="".join(f"{layer.name}_*.vdb: {len(layer.files)} frames\n" for layer in content.smoke),
        grids="\n".join(f"  {name:<12} {_GRIDS.get(name, '')}, {each.unit}" for name, each in grids.items()),
        field=field,
        scale=scale,
        albedo=ALBEDO,
        anisotropy=ANISOTROPY,
    )
    (folder / "README.txt").write_text(text, encoding="utf-8", newline="\n")
    return path


def thickness(found: dict[str, Grid]) -> tuple[str, float]:
    """Return the grid that sets how thick smoke is, and the extinction (1/m) of its unit."""
    if "dilution" in found and found["density"].unit != _EXTINCTION:
        return "dilution", _PER_DILUTION
    return "density", 1.0


def _define(stage: Any, layer: SmokeLayer) -> dict[str, Grid]:
    """Define the volume of a layer, and return its grids."""
    boxes = {frame: read_grids(file) for frame, file in layer.files.items()}
    grid_of = {name: grid for each in boxes.values() for name, grid in each.items()}
    files = {name: layer.files for name in grid_of}
    for file in layer.temperature.values():
        grid_of |= read_grids(file)
        files["temperature"] = layer.temperature
    density, scale = thickness(grid_of) if grid_of else ("density", 1.0)
    volume = UsdVol.Volume.Define(stage, f"/World/Smoke/{layer.name.title()}")
    prim = volume.GetPrim()
    prim.SetCustomDataByKey("firetwin:scatterColor", Gf.Vec3f(*ALBEDO))
    prim.SetCustomDataByKey("firetwin:anisotropy", ANISOTROPY)
    prim.SetCustomDataByKey("firetwin:extinctionOfDensity", scale)
    for name in FIELDS:
        grid = density if name == "density" else name
        if grid in grid_of:
            volume.CreateFieldRelationship(
                name, _define_field(stage, f"{prim.GetPath()}/{name}", grid, files[grid])
            )
    attribute = volume.CreateExtentAttr()
    for frame, grids in boxes.items():
        if grids:
            low = [min(grid.low[axis] for grid in grids.values()) for axis in range(3)]
            high = [max(grid.high[axis] for grid in grids.values()) for axis in range(3)]
            attribute.Set(Vt.Vec3fArray([Gf.Vec3f(*low), Gf.Vec3f(*high)]), frame)
    return grid_of


def _define_field(stage: Any, path: str, grid: str, files: dict[int, Path]) -> Any:
    """Define a field with a file for each frame, and return its path."""
    asset = UsdVol.OpenVDBAsset.Define(stage, path)
    asset.CreateFieldNameAttr(grid)
    asset.CreateFieldDataTypeAttr("float")
    attribute = asset.CreateFilePathAttr()
    assets = {frame: Sdf.AssetPath(f"./{FOLDER}/{file.name}") for frame, file in files.items()}
    attribute.Set(next(iter(assets.values())))
    for frame, asset_path in assets.items():
        attribute.Set(asset_path, frame)
    return asset.GetPath()


def read_grids(file: Path) -> dict[str, Grid]:
    """Read the grids of an OpenVDB file that have voxels."""
    import openvdb

    grids = {}
    for grid in openvdb.readAllGridMetadata(str(file)):
        low, high = grid.metadata.get("file_bbox_min"), grid.metadata.get("file_bbox_max")
        if low is not None and all(a <= b for a, b in zip(low, high, strict=True)):
            ends = [
                grid.transform.indexToWorld(tuple(at + shift for at in corner))
                for corner, shift in ((low, -0.5), (high, 0.5))
            ]
            grids[grid.name] = Grid(grid.metadata.get("units", ""), *ends)
    return grids
