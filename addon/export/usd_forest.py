"""USD forest: point instancers of trees, understorey and grass, and a layer for each prototype.

The prototypes are in `prototypes/`, one layer for each model and level of detail, so that a user replaces a
plant by replacing a file. Their materials are in `prototypes/looks.usda`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, UsdGeom, UsdShade, Vt

from . import usd_materials
from .scene_content import LOOKS, Plants, Prototype, SceneContent
from .usd_geometry import define_mesh, extent, half_quaternions, set_indexed, vectors
from .usd_library import new_stage, set_kind

FOLDER = "prototypes"
_BURNING = "/World/Forest/Looks/Burning"
MOMENTS = 9
"""Number of frames, at most, at which plants catch fire or become bare."""
FLAME, RADIANCE = (1.0, 0.16, 0.012), 0.9
"""Colour (linear) and radiance of crowns in flames, in the scene's units (by eye)."""


def write(content: SceneContent, out: Path) -> Path:
    """Write `forest.usdc` and its prototypes; return the layer."""
    (out / FOLDER).mkdir()
    _write_looks(out / FOLDER / "looks.usda", content.rate)
    for prototype in content.prototypes:
        _write_prototype(prototype, out / FOLDER / f"{prototype.name}.usdc", content.rate)
    path = out / "forest.usdc"
    span = int(content.frames[0]), int(content.frames[-1])
    stage = new_stage(path, content.rate, span)
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Forest").GetPrim(), "group")
    frames = burning_frames(content)
    UsdGeom.Scope.Define(stage, "/World/Forest/Looks")
    usd_materials.of_colour(stage, _BURNING, FLAME, RADIANCE)
    for plants in content.plants:
        _define_plants(stage, plants, content, frames)
    stage.GetRootLayer().Save()
    return path


def burning_frames(content: SceneContent, most: int = MOMENTS) -> list[int]:
    """Choose the frames at which burned land changes: evenly spread, the first and the last included."""
    count = len(content.frames)
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    return [int(frame) for frame in content.frames[chosen]]


def _define_plants(stage: Any, plants: Plants, content: SceneContent, frames: list[int]) -> None:
    path = f"/World/Forest/{plants.name}"
    instancer = UsdGeom.PointInstancer.Define(stage, path)
    set_kind(instancer.GetPrim(), "component")
    used, first = np.unique(np.concatenate([plants.prototype, plants.burned_prototype]), return_inverse=True)
    living, burned = np.split(first, 2)
    targets = [_refer_to(stage, path, content.prototypes[k]) for k in used]
    times = dict(zip(content.frames.tolist(), content.times.tolist(), strict=True))
    alight = {frame: plants.in_flames(times[frame]) for frame in frames}
    flaming = np.unique(living[np.any(list(alight.values()), axis=0)])
    targets += [_refer_to(stage, path, content.prototypes[used[k]], burning=True) for k in flaming]
    number = np.zeros(len(used), np.int64)
    number[flaming] = len(used) + np.arange(len(flaming))
    instancer.CreatePrototypesRel().SetTargets(targets)
    instancer.CreatePositionsAttr(vectors(plants.position))
    instancer.CreateOrientationsAttr(half_quaternions(plants.rotation))
    instancer.CreateScalesAttr(vectors(plants.scale))
    if plants.ids is not None:
        instancer.CreateIdsAttr(Vt.Int64Array.FromNumpy(np.ascontiguousarray(plants.ids, np.int64)))
    states = {
        frame: np.where(
            plants.burned_from <= times[frame], burned, np.where(alight[frame], number[living], living)
        )
        for frame in frames
    }
    _set_prototypes(instancer, states)
    classes, kind = np.unique([content.prototypes[k].kind for k in used], return_inverse=True)
    primvars = UsdGeom.PrimvarsAPI(instancer)
    kinds = primvars.CreatePrimvar("class", Sdf.ValueTypeNames.StringArray, "vertex")
    set_indexed(kinds, Vt.StringArray(classes.tolist()), kind[living])
    for name, values in (
        ("height", plants.height),
        ("arrival", plants.arrival),
        ("scorch", plants.scorch),
        ("torched", plants.torched),
    ):
        array = Vt.FloatArray.FromNumpy(np.ascontiguousarray(values, np.float32))
        primvars.CreatePrimvar(name, Sdf.ValueTypeNames.FloatArray, "vertex").Set(array)
    reach = max(float(np.abs(content.prototypes[k].points).max()) for k in used)
    instancer.CreateExtentAttr(extent(plants.position, reach * plants.scale.max(axis=1, keepdims=True)))


def _set_prototypes(instancer: Any, states: dict[int, np.ndarray]) -> None:
    """Set the prototype of each plant (n,) by frame, and only where one changes."""
    attribute = instancer.CreateProtoIndicesAttr()
    first, *later = states.values()
    attribute.Set(Vt.IntArray.FromNumpy(first.astype(np.int32)))
    if all(np.array_equal(first, state) for state in later):
        return
    last = None
    for frame, state in states.items():
        if last is None or not np.array_equal(last, state):
            attribute.Set(Vt.IntArray.FromNumpy(state.astype(np.int32)), frame)
        last = state


def _refer_to(stage: Any, path: str, prototype: Prototype, burning: bool = False) -> Any:
    """Refer to the layer of a prototype below the instancer, and return its path; `burning`: in flames."""
    parent = f"{path}/Prototypes"
    if not stage.GetPrimAtPath(parent):
        UsdGeom.Scope.Define(stage, parent)
    prim = stage.DefinePrim(f"{parent}/{prototype.name}{'_burning' if burning else ''}")
    prim.GetReferences().AddReference(f"./{FOLDER}/{prototype.name}.usdc")
    set_kind(prim, "subcomponent")
    if burning:
        UsdShade.MaterialBindingAPI.Apply(prim).Bind(
            UsdShade.Material.Get(stage, _BURNING), UsdShade.Tokens.strongerThanDescendants
        )
    return prim.GetPath()


def _write_looks(path: Path, rate: float) -> None:
    stage = new_stage(path, rate, root="Looks", scope=True)
    for look in LOOKS:
        usd_materials.from_primvar(stage, f"/Looks/{look.title()}")
    stage.GetRootLayer().Save()


def _write_prototype(prototype: Prototype, path: Path, rate: float) -> None:
    """Write a layer with one mesh, a metre tall, and a subset of faces for each look."""
    root = f"/{prototype.name}"
    stage = new_stage(path, rate, root=prototype.name)
    prim = stage.GetDefaultPrim()
    set_kind(prim, "component")
    prim.SetCustomDataByKey("firetwin:class", prototype.kind)
    prim.SetCustomDataByKey("firetwin:state", prototype.state)
    prim.SetCustomDataByKey("firetwin:level", prototype.level)
    looks = UsdGeom.Scope.Define(stage, f"{root}/Looks").GetPrim()
    looks.GetReferences().AddReference("./looks.usda")
    mesh = define_mesh(
        stage, f"{root}/Plant", prototype.points, prototype.triangles, prototype.shading_normals()
    )
    mesh.CreateDoubleSidedAttr(True)
    colours, number = np.unique(prototype.colours, axis=0, return_inverse=True)
    set_indexed(mesh.CreateDisplayColorPrimvar("uniform"), vectors(colours), number.ravel())
    present = np.unique(prototype.looks)
    for k in present:
        material = UsdShade.Material.Get(stage, f"{root}/Looks/{LOOKS[k].title()}")
        if len(present) == 1:
            UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
            break
        faces = Vt.IntArray.FromNumpy(np.flatnonzero(prototype.looks == k).astype(np.int32))
        binding = UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim())
        subset = binding.CreateMaterialBindSubset(LOOKS[k].title(), faces)
        UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(material)
    if len(present) > 1:
        UsdShade.MaterialBindingAPI(mesh.GetPrim()).SetMaterialBindSubsetsFamilyType("partition")
    stage.GetRootLayer().Save()
