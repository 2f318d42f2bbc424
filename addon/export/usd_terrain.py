"""USD terrain: the ground's mesh with a picture of its colours, which changes as the fire burns it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from pxr import Sdf, UsdGeom, UsdShade, Vt

from . import usd_materials
from .scene_content import SceneContent
from .usd_geometry import define_mesh
from .usd_library import new_stage, set_kind

FOLDER = "textures"


def write(content: SceneContent, out: Path, pictures: dict[int, NDArray[np.uint8]]) -> Path:
    """Write `terrain.usdc` and its textures; return the layer.

    Parameters
    ----------
    pictures
        Pictures of the ground (rows, columns, 3), by the frame from which they are shown.
    """
    assert content.terrain is not None
    (out / FOLDER).mkdir(exist_ok=True)
    files = {}
    for frame, picture in pictures.items():
        name = f"{FOLDER}/ground_{frame:06d}.png"
        Image.fromarray(picture).save(out / name, optimize=True)
        files[frame] = f"./{name}"
    path = out / "terrain.usdc"
    span = int(content.frames[0]), int(content.frames[-1])
    stage = new_stage(path, content.rate, span)
    set_kind(stage.GetDefaultPrim(), "assembly")
    set_kind(UsdGeom.Xform.Define(stage, "/World/Terrain").GetPrim(), "component")
    ground = content.terrain
    mesh = define_mesh(stage, "/World/Terrain/Ground", ground.points, ground.triangles, ground.normals)
    uv = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(content.terrain.uv, np.float32))
    primvars = UsdGeom.PrimvarsAPI(mesh)
    primvars.CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex).Set(uv)
    UsdGeom.Scope.Define(stage, "/World/Terrain/Looks")
    material = usd_materials.from_picture(stage, "/World/Terrain/Looks/Ground", files)
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    stage.GetRootLayer().Save()
    return path
