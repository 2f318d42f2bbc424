"""Material of the ground: vegetation and fire effects as a function of time.

age = model time - arrival time, so a single static mesh shows every time: flaming front, embers, char and
ash. Reflectances are display colours, chosen by eye against photographs, not measured.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import bpy

from ...blender import nodes
from ...blender.owned import Stage
from ...passes import masks
from ...shot.shot import Shot
from ...shot.surface import orthophoto
from .. import cell_distances, haze
from ..forest import biomes
from ..forest.biomes import ShotBiome
from . import (
    burn_scar,
    fields,
    globe_material,
    infrared_radiance,
    open_land,
    rock_outcrops,
    shading_inputs,
    vegetation_cover,
)
from .shading_inputs import GroundInputs

_FAR, _ON_ROCK = 1.5, 2.0  # pixels, minimum wavelength of noise where trees are part of the ground

_WAVES = (500.0, 4000.0)  # m from the camera between which waves fall below the pixel size (by eye)
TILE_COLOUR = "Tile Colour"
GLOBE = "globe"
"""Point attribute of the ground: 0 within the run, 1 at the border, where the ground looks like the globe."""

_PHOTO, _SHOULDER = 0.5, 0.8  # reflectance / linear value of a photograph is p / (1 + s p grey)
_BLUR = 0.12  # roughness that represents unresolved waves (by eye)


def build(
    shot: Shot,
    stage: Stage,
    images: dict[str, bpy.types.Image],
    photos: Sequence[tuple[orthophoto.OrthophotoImage, bpy.types.Image]] = (),
    maps: Mapping[str, Sequence[tuple[orthophoto.OrthophotoImage, bpy.types.Image]]] | None = None,
    skin: str = "",
    globe: bpy.types.Image | None = None,
) -> bpy.types.Material:
    """Build "Firetwin Ground" from the images of fields, coloured by these orthophotos.

    `globe` is the picture of the Earth, which the ground shows at its border for cameras in space.
    `maps` are images of the user's land use, by `shot.surface.land_kinds.LAYERS`. With a `skin`, its name, it
    becomes the material of 3D Tiles: the same ground, but with the input `TILE_COLOUR` as the colour of
    unburned ground.
    """
    material, tree = nodes.material(skin or "Firetwin Ground", (0.30, 0.26, 0.17))
    biome = biomes.choose(shot)
    with tree.frame("Fields"):
        known = fields.Fields(tree, images)
        lake = known["water"] > 0.5
    visible = _visible_shader(tree, shot, stage, known, lake, photos, biome, maps or {}, skin, globe)
    warmth, kind = _data_outputs(tree, shot, stage, known, lake)
    visible = cell_distances.write(tree, stage, visible)
    tree.surface(nodes.mask_switch(tree, nodes.thermal_switch(tree, visible, warmth), kind))
    material.cycles.emission_sampling = "NONE"  # sampled as a lamp, its small emitters would be noisy
    return material


def _visible_shader(
    tree: nodes.Tree,
    shot: Shot,
    stage: Stage,
    ground_fields: fields.Fields,
    lake: nodes.Value,
    photos: Sequence[tuple[orthophoto.OrthophotoImage, bpy.types.Image]],
    biome: ShotBiome,
    maps: Mapping[str, Sequence[tuple[orthophoto.OrthophotoImage, bpy.types.Image]]],
    skin: str,
    globe: bpy.types.Image | None,
) -> nodes.Value:
    """Return the visible shader; shaders are mixed, not colours: Cycles skips shaders of weight 0."""
    outcrops = biome.biome.outcrops
    with tree.frame("Place and time"):
        here = shading_inputs.gather(tree, ground_fields, shot, whole=False)
        bare = shading_inputs.bare_rock(tree, here, outcrops)
    with tree.frame("Rock"):
        rock = _rock_shader(tree, here, biome)
    with tree.frame("Soil"):
        ground = tree.mix_shader(bare, _soil_shader(tree, here, biome), rock)
    for picture, image in photos:
        with tree.frame("Photo"):
            ground = _apply_orthophoto(tree, here, picture, image, ground)
    for layer, drawn in maps.items():
        for picture, image in drawn:
            with tree.frame(f"Land use: {layer}"):
                if layer == "water":  # one shader of water serves lakes and the map
                    lake = tree.math("MAXIMUM", lake, _picture_alpha(tree, here, picture, image))
                else:
                    ground = _apply_land_use(tree, here, layer, picture, image, ground)
    with tree.frame("Water"):
        ground = tree.mix_shader(lake, ground, _water_shader(tree, here))
    if skin:
        with tree.frame("Tiles"):
            colour = tree.input(TILE_COLOUR, (1.0, 1.0, 1.0), "Colour of the tile", "Tiles")
            shown = _matte_shader(tree, photo_reflectance(tree, colour), None)
            ground = tree.mix_shader(1.0 - here.burned, ground, shown)
    with tree.frame("Flames and embers"):
        burning, glow = burn_scar.fire_emission(tree, shot, stage, here, here.burned * (1.0 - bare))
        ground = tree.add_shader(ground, burning)
    if globe is not None:
        with tree.frame("Globe"):
            ground = globe_material.blend_with_globe(tree, shot, stage, globe, GLOBE, ground, here.burned)
    with tree.frame("Air"):
        ground = haze.apply(tree, ground, stage, glow)
    with tree.frame("Light of other ground"):
        camera = tree.output("ShaderNodeLightPath", name="Is Camera Ray")
        return tree.mix_shader(camera, _simple_ground(tree, ground_fields, biome), ground)


def _data_outputs(
    tree: nodes.Tree, shot: Shot, stage: Stage, known: fields.Fields, lake: nodes.Value
) -> tuple[nodes.Value, nodes.Value]:
    """Return infrared radiance, and the class of the masks: all octaves of noise, at any pixel size."""
    outcrops = biomes.choose(shot).biome.outcrops
    with tree.frame("Place and time of data"):
        here = shading_inputs.gather(tree, known, shot, whole=True)
        bare = shading_inputs.bare_rock(tree, here, outcrops)
        fuel = here.burned * (1.0 - bare)
        flaming, embers = (fuel * part for part in burn_scar.front_coverage(tree, stage, here))
    with tree.frame("Infrared"):
        facing = tree.output("ShaderNodeNewGeometry", name="Normal")
        warmth = infrared_radiance.radiance(tree, shot, stage, here, bare, lake, facing, (flaming, embers))
    with tree.frame("Masks"):
        alight = (flaming > masks.ALIGHT) * (masks.FIRE - masks.BURNED)
        kind = here.burned * (alight + (masks.BURNED - masks.GROUND)) + masks.GROUND
    return warmth, kind


def _matte_shader(tree: nodes.Tree, colour: nodes.Value, normal: nodes.Value | None) -> nodes.Value:
    inputs = {"Color": colour, "Roughness": 0.6}
    return tree.output("ShaderNodeBsdfDiffuse", inputs if normal is None else {**inputs, "Normal": normal})


def _bump_normal(tree: nodes.Tree, height: nodes.Value, strength: float = 0.9) -> nodes.Value:
    """Return the normal of a bump map of this height (m), which Cycles evaluates three times."""
    return tree.output("ShaderNodeBump", {"Strength": strength, "Distance": 1.0, "Height": height})


def _soil_shader(tree: nodes.Tree, here: GroundInputs, biome: ShotBiome) -> nodes.Value:
    """Shade ground without rock: a vegetation texture afar, and the floor below nearby instanced trees."""
    shaders = []
    for grown, there in (
        (vegetation_cover.distant_canopy, here.coarser(_FAR)),
        (vegetation_cover.near_ground, here),
    ):
        colour, height = grown(tree, there, biome)
        normal = _bump_normal(tree, height)
        afar = grown is vegetation_cover.distant_canopy
        char = _grain_floor(tree, there, burn_scar.scar_colour(tree, there, logs=not afar))
        green = _matte_shader(tree, _grain_floor(tree, there, colour), normal)
        burned = here.burned * (1.0 - burn_scar.surviving_crowns(there)) if afar else here.burned
        shaders.append(tree.mix_shader(burned, green, _matte_shader(tree, char, normal)))
    return tree.mix_shader(here.near, *shaders)


def _grain_floor(tree: nodes.Tree, here: GroundInputs, colour: nodes.Value) -> nodes.Value:
    """Return the colour of the floor with needles, soil and shadows, with the same mean."""
    grain = tree.mix_colour(here.duff.ramp(-0.5, 0.5), (0.22, 0.20, 0.18), (1.78, 1.80, 1.82))
    return tree.mix_colour(1.0, colour, grain, "MULTIPLY")


def _rock_shader(tree: nodes.Tree, here: GroundInputs, biome: ShotBiome) -> nodes.Value:
    colour, height = rock_outcrops.look(tree, here)
    if biome.biome.open_land is not None:
        colour, height = _weather_rock(tree, here, biome, colour, height)
    normal = _bump_normal(tree, height)
    bare = _matte_shader(tree, colour, normal)
    crowns, where = vegetation_cover.trees_on_rock(tree, here.coarser(_ON_ROCK), biome)
    wooded = tree.mix_shader(where, bare, _matte_shader(tree, crowns, normal))
    return tree.mix_shader(here.near, wooded, bare)


def _weather_rock(
    tree: nodes.Tree, here: GroundInputs, biome: ShotBiome, colour: nodes.Value, height: nodes.Value
) -> tuple[nodes.Value, nodes.Value]:
    """Shade rock of biomes outside of the Sierra, replaced by soil on gentle slopes."""
    colour = tree.mix_colour(1.0, colour, biome.biome.rock, "MULTIPLY")
    flat = here.slope.smoothstep(0.14, 0.05)
    soil = tree.mix_colour(here.burned * 0.6, open_land.bare_colour(tree, here, biome), (0.045, 0.042, 0.040))
    return tree.mix_colour(flat, colour, soil), tree.mix(flat, height, here.grain.noise(3.0, 3.0) * 0.4)


def _simple_ground(tree: nodes.Tree, ground_fields: fields.Fields, biome: ShotBiome) -> nodes.Value:
    """Simplify the ground for indirect light, where detail is not visible."""
    canopy = ground_fields["canopy_fuel"].smoothstep(0.0, 0.7)
    land = biome.biome.open_land
    grass = (
        (0.080, 0.070, 0.045)
        if land is None
        else vegetation_cover.mix_colours(biome.green, land.straw, land.green)
    )
    green = tree.mix_colour(canopy, grass, (0.030, 0.040, 0.018))
    green = tree.mix_colour(ground_fields["bare"], green, (0.120, 0.110, 0.100))
    burned = (nodes.model_time(tree) > ground_fields["burn_time"]) * (ground_fields["burned"] > 0.5)
    colour = tree.mix_colour(burned, green, (0.036, 0.035, 0.034))
    return tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})


def _apply_orthophoto(
    tree: nodes.Tree,
    here: GroundInputs,
    picture: orthophoto.OrthophotoImage,
    image: bpy.types.Image,
    ground: nodes.Value,
) -> nodes.Value:
    """Apply the orthophoto's colour in unburned areas with data. It needs no bump map."""
    counts = _picture_alpha(tree, here, picture, image) * (1.0 - here.burned)
    colour = photo_reflectance(tree, _picture_colour(tree, here, picture, image))
    return tree.mix_shader(counts, ground, _matte_shader(tree, colour, None))


def photo_reflectance(tree: nodes.Tree, colour: nodes.Value) -> nodes.Value:
    """Return reflectances of a photograph's linear colours.

    A photograph is exposed for sunlit ground: pale rock has values of 0.3 to 0.5. Taken as reflectances and
    lit again, it would look like snow. The factors are chosen so that pale rock and forest of photographs
    meet the colours of this material (by eye).
    """
    red, green, blue = tree.separate(colour)
    grey = (red + green + blue) * (_PHOTO / 3.0)
    factor = tree.math("DIVIDE", _PHOTO, grey * _SHOULDER + 1.0)
    return tree.vector("SCALE", colour, factor)


def _apply_land_use(
    tree: nodes.Tree,
    here: GroundInputs,
    layer: str,
    picture: orthophoto.OrthophotoImage,
    image: bpy.types.Image,
    ground: nodes.Value,
) -> nodes.Value:
    """Apply a layer of the user's land use: its colour, with texture; layers with fuel burn."""
    counts = _picture_alpha(tree, here, picture, image)
    if layer == "soft":
        grain = here.grain.noise(11.0, 5.0, 0.7).ramp(0.25, 0.75, 0.72, 1.28)
        tone = grain * here.grain.noise(140.0, 3.0, 0.6).ramp(0.3, 0.7, 0.86, 1.14)
    else:
        tone = here.grain.noise(90.0, 3.0, 0.6).ramp(0.3, 0.7, 0.86, 1.14)
    colour = _picture_colour(tree, here, picture, image)
    colour = tree.mix_colour(1.0, colour, tree.combine(tone, tone, tone), "MULTIPLY")
    if layer == "soft":
        counts = counts * (1.0 - here.burned)
    return tree.mix_shader(counts, ground, _matte_shader(tree, colour, None))


def _picture_alpha(
    tree: nodes.Tree, here: GroundInputs, picture: orthophoto.OrthophotoImage, image: bpy.types.Image
) -> nodes.Value:
    """Return the opacity of a picture draped on the ground, 0 outside of it."""
    scale = 1.0 / (picture.high - picture.low)
    across = tree.vector("SUBTRACT", here.position, (*picture.low, 0.0))
    at = tree.vector("MULTIPLY", across, (*scale, 0.0))
    return tree.output("ShaderNodeTexImage", {"Vector": at}, "Alpha", image=image, extension="CLIP")


def _picture_colour(
    tree: nodes.Tree, here: GroundInputs, picture: orthophoto.OrthophotoImage, image: bpy.types.Image
) -> nodes.Value:
    """Return the colour of a picture draped on the ground.

    It shares no node with its opacity: Cycles keeps the outputs of a shared node through all branches of the
    shader, whose stack has 255 numbers. A shader that needs more is black.
    """
    scale = 1.0 / (picture.high - picture.low)
    at = tree.vector("MULTIPLY_ADD", here.position, (*scale, 0.0), (*(-picture.low * scale), 0.0))
    return tree.output("ShaderNodeTexImage", {"Vector": at}, "Color", image=image, extension="EXTEND")


def _water_shader(tree: nodes.Tree, here: GroundInputs) -> nodes.Value:
    """Shade dark water that reflects the sky by Fresnel's law, with waves from the wind.

    Roughness represents waves below the pixel size (Cox and Munk 1954: distribution of slopes).
    """
    shown = here.distance.ramp(*_WAVES, 1.0, 0.0)
    normal = _bump_normal(tree, here.grain.noise(7.0, 2.0) * shown * 0.05, 0.5)
    colour = tree.input(
        "Water Colour", (0.010, 0.022, 0.024), "Colour of deep lakes, seen from above", "Water"
    )
    rough = tree.input(
        "Water Roughness", 0.22, "Roughness of a lake's reflection of the sky", "Water", most=1.0
    )
    deep = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour})
    blur = rough + (1.0 - shown) * _BLUR
    mirror = tree.output("ShaderNodeBsdfGlossy", {"Roughness": blur, "Normal": normal})
    return tree.mix_shader(tree.output("ShaderNodeFresnel", {"IOR": 1.33}), deep, mirror)
