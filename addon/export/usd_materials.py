"""USD materials: each as UsdPreviewSurface and as MaterialX's standard surface, with the same look."""

from __future__ import annotations

from typing import Any

from pxr import Gf, Sdf, UsdShade

ROUGHNESS = 0.9
"""Roughness of all surfaces: Firetwin's are diffuse."""


def from_primvar(stage: Any, path: str, name: str = "displayColor") -> Any:
    """Define a diffuse material whose colour is a primvar of the mesh."""
    material = UsdShade.Material.Define(stage, path)
    reader = _shader(stage, f"{path}/Colour", "UsdPrimvarReader_float3")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set(name)
    colour = reader.CreateOutput("result", Sdf.ValueTypeNames.Float3)
    _preview(stage, material, path).CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        colour
    )
    named = _shader(stage, f"{path}/MtlxColour", "ND_geompropvalue_color3")
    named.CreateInput("geomprop", Sdf.ValueTypeNames.String).Set(name)
    _standard(stage, material, path).CreateInput("base_color", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        named.CreateOutput("out", Sdf.ValueTypeNames.Color3f)
    )
    return material


def of_colour(stage: Any, path: str, colour: tuple[float, float, float], radiance: float) -> Any:
    """Define a material that emits a linear colour with a radiance, and reflects nothing."""
    material = UsdShade.Material.Define(stage, path)
    preview, standard = _preview(stage, material, path), _standard(stage, material, path)
    light = Gf.Vec3f(*(radiance * part for part in colour))
    preview.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(0.0))
    preview.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).Set(light)
    standard.CreateInput("base", Sdf.ValueTypeNames.Float).Set(0.0)
    standard.CreateInput("emission", Sdf.ValueTypeNames.Float).Set(radiance)
    standard.CreateInput("emission_color", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*colour))
    return material


def from_picture(stage: Any, path: str, files: dict[int, str]) -> Any:
    """Define a diffuse material whose colour is a picture in sRGB, which can change at some frames.

    Parameters
    ----------
    files
        Path of the picture, relative to the layer, by the frame from which it is shown.
    """
    material = UsdShade.Material.Define(stage, path)
    picture, image = _pictures(stage, path, files)
    _preview(stage, material, path).CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    )
    _standard(stage, material, path).CreateInput("base_color", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        image.CreateOutput("out", Sdf.ValueTypeNames.Color3f)
    )
    return material


def glowing(stage: Any, path: str, file: str, radiance: float) -> Any:
    """Define a material that emits the colours of a picture and is transparent where the picture is black.

    Parameters
    ----------
    radiance
        Factor on the colours.
    """
    material = UsdShade.Material.Define(stage, path)
    picture, image = _pictures(stage, path, {0: file})
    picture.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set((radiance, radiance, radiance, 1.0))
    preview = _preview(stage, material, path)
    preview.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set((0.0, 0.0, 0.0))
    preview.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
        picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    )
    preview.CreateInput("opacity", Sdf.ValueTypeNames.Float).ConnectToSource(
        picture.CreateOutput("a", Sdf.ValueTypeNames.Float)
    )
    standard = _standard(stage, material, path)
    standard.CreateInput("base", Sdf.ValueTypeNames.Float).Set(0.0)
    standard.CreateInput("emission", Sdf.ValueTypeNames.Float).Set(radiance)
    colour = image.CreateOutput("out", Sdf.ValueTypeNames.Color3f)
    standard.CreateInput("emission_color", Sdf.ValueTypeNames.Color3f).ConnectToSource(colour)
    standard.CreateInput("opacity", Sdf.ValueTypeNames.Color3f).ConnectToSource(colour)
    return material


def _shader(stage: Any, path: str, identifier: str) -> Any:
    shader = UsdShade.Shader.Define(stage, path)
    shader.CreateIdAttr(identifier)
    return shader


def _preview(stage: Any, material: Any, path: str) -> Any:
    shader = _shader(stage, f"{path}/Surface", "UsdPreviewSurface")
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(ROUGHNESS)
    shader.CreateInput("specularColor", Sdf.ValueTypeNames.Color3f).Set((0.0, 0.0, 0.0))
    shader.CreateInput("useSpecularWorkflow", Sdf.ValueTypeNames.Int).Set(1)
    material.CreateSurfaceOutput().ConnectToSource(shader.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    return shader


def _standard(stage: Any, material: Any, path: str) -> Any:
    shader = _shader(stage, f"{path}/MtlxSurface", "ND_standard_surface_surfaceshader")
    shader.CreateInput("specular", Sdf.ValueTypeNames.Float).Set(0.0)
    shader.CreateInput("diffuse_roughness", Sdf.ValueTypeNames.Float).Set(0.5)
    material.CreateSurfaceOutput("mtlx").ConnectToSource(shader.CreateOutput("out", Sdf.ValueTypeNames.Token))
    return shader


def _pictures(stage: Any, path: str, files: dict[int, str]) -> tuple[Any, Any]:
    """Return a picture's shaders for the preview surface and for MaterialX."""
    reader = _shader(stage, f"{path}/Place", "UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    picture = _shader(stage, f"{path}/Picture", "UsdUVTexture")
    picture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(
        reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    )
    picture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
    for wrap in ("wrapS", "wrapT"):
        picture.CreateInput(wrap, Sdf.ValueTypeNames.Token).Set("clamp")
    place = _shader(stage, f"{path}/MtlxPlace", "ND_geompropvalue_vector2")
    place.CreateInput("geomprop", Sdf.ValueTypeNames.String).Set("st")
    image = _shader(stage, f"{path}/MtlxPicture", "ND_image_color3")
    image.CreateInput("texcoord", Sdf.ValueTypeNames.Float2).ConnectToSource(
        place.CreateOutput("out", Sdf.ValueTypeNames.Float2)
    )
    for shader in (picture, image):
        file = shader.CreateInput("file", Sdf.ValueTypeNames.Asset)
        _set_files(file, files)
        if shader is image:
            file.GetAttr().SetColorSpace("srgb_texture")
    return picture, image


def _set_files(file: Any, files: dict[int, str]) -> None:
    """Set the file of a picture, with time samples if there are several."""
    file.Set(Sdf.AssetPath(next(iter(files.values()))))
    if len(files) > 1:
        for frame, name in files.items():
            file.Set(Sdf.AssetPath(name), frame)
