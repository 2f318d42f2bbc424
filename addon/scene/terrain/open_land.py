"""Open land of biomes outside of the Sierra: grass patches of all sizes, tussocks, bushes, fields and tracks.

Colours come from the biome. Detail below a pixel is filtered to its mean.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy

from ...blender import nodes, owned
from ..band_limited_noise import Grain
from ..forest import field_lines, patterns
from ..forest.biomes import OpenLand, ShotBiome
from .shading_inputs import GroundInputs

_MARK = "firetwin_biome"
_RUT, _TRACK = 0.45, 2.6  # m: width of a wheel's rut, and of a track with grass between (by eye)
_STREAK = (1.0, 0.45, 1.0)  # grass forms streaks along the wind
_SEEN = (400.0, 9000.0)  # m from the camera at which bushes are sharp, and at which they are a mean tone


@dataclass
class Spot:
    """A point within the node group, as in `Place`."""

    grain: Grain
    position: nodes.Value
    distance: nodes.Value
    pixel: nodes.Value
    shrub: nodes.Value
    hollow: nodes.Value
    free: nodes.Value


def look(tree: nodes.Tree, place: GroundInputs, here: ShotBiome) -> tuple[nodes.Value, nodes.Value]:
    """Return colour and height (m), from a shared node group: Blender is slow with many nodes in a tree."""
    inputs = {
        "Pixel": place.pixel,
        "Least": place.grain.least,
        "Shrub": place.shrub,
        "Hollow": place.hollow,
        "Free": place.free,
    }
    node = tree.node("ShaderNodeGroup", inputs, node_tree=_node_group(tree, here))
    return tree.pick(node, "Colour"), tree.pick(node, "Height")


def _node_group(tree: nodes.Tree, here: ShotBiome) -> bpy.types.NodeTree:
    """Return the node group of this biome; an existing one is reused."""
    for node in tree.node_tree.nodes:
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree and node.node_tree.get(_MARK) == here.name:
            return node.node_tree
    group = owned.mark(bpy.data.node_groups.new("Firetwin Open Land", "ShaderNodeTree"))
    group.description = "Grass, bushes, soil, fields and tracks"
    group[_MARK] = here.name
    for name, kind in (("Colour", "Color"), ("Height", "Float")):
        group.interface.new_socket(name, in_out="OUTPUT", socket_type=f"NodeSocket{kind}")
    inner = nodes.Tree(group)
    colour, height = _look(inner, _group_inputs(inner), here)
    inner.finish({"Colour": colour, "Height": height})
    return group


def _group_inputs(tree: nodes.Tree) -> Spot:
    """Add the inputs of the group at a point."""
    pixel = tree.input("Pixel", 1.0, "Size of a pixel, m", "GroundInputs")
    least = tree.input("Least", 1.0, "Pixels of the finest noise", "GroundInputs")
    shrub = tree.input("Shrub", 0.0, "Fraction of the land under bushes", "GroundInputs", most=1.0)
    hollow = tree.input("Hollow", 0.0, "-1: a crest, 1: a hollow", "GroundInputs", least=None)
    free = tree.input("Free", 1.0, "1: fields and tracks are procedural", "GroundInputs", most=1.0)
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    distance = tree.output("ShaderNodeCameraData", name="View Distance")
    return Spot(Grain(tree, position, pixel * least), position, distance, pixel, shrub, hollow, free)


def _look(tree: nodes.Tree, place: Spot, here: ShotBiome) -> tuple[nodes.Value, nodes.Value]:
    land = here.biome.open_land
    assert land is not None
    small = place.grain.noise(17.0, 4.0, 0.7)
    broad, middling, wet = patterns.wetness(place.grain.noise, place.hollow, land)
    colour = _grass(tree, place, here, wet, middling, small)
    if min(land.field) > 0.0:
        colour = _colour_fields(tree, place, here, colour, small)
    fine = tree.cells(place.position, land.tussock)
    shown = place.pixel.ramp(0.25 * land.tussock, 1.2 * land.tussock, 1.0, 0.0)
    shade = place.pixel.ramp(0.02, 0.15, 0.70, 1.0)  # between tufts that are instanced
    rough = (1.0 + (0.42 - fine) * 0.9 * shown) * shade
    colour = _scale_colour(tree, colour, rough)
    there = _bushes(tree, place, land, wet, middling)
    colour = tree.mix_colour(there.part, colour, _bush_colour(tree, place, land, there, broad, middling))
    height = small * 0.8 + (1.0 - fine) * 0.25 * shown + there.part * there.dome * (0.45 * land.bush)
    if land.tracks:
        colour = _colour_tracks(tree, place, land, colour)
    if land.hedge:
        hedge, thick = _hedges(tree, place, land)
        colour = tree.mix_colour(hedge, colour, tree.mix_colour(small.smoothstep(0.35, 0.65), *land.shrub))
        height = height + hedge * thick
    return colour, height


def bare_colour(tree: nodes.Tree, place: GroundInputs, here: ShotBiome) -> nodes.Value:
    """Return the colour of ground without fuel: soil, dry beds and stones."""
    land = here.biome.open_land
    assert land is not None
    noise = place.grain.noise
    soil = tree.mix_colour(noise(7.0, 5.0, 0.7).smoothstep(0.3, 0.7), *land.soil)
    broad = noise(75.0, 5.0, 0.68)
    soil = tree.mix_colour(broad.smoothstep(0.62, 0.40) * 0.55, soil, land.soil[0])
    sparse = (broad + place.hollow * 0.10 + (noise(9.0, 4.0, 0.7) - 0.5) * 0.4).smoothstep(0.52, 0.66)
    return tree.mix_colour(sparse * 0.85, soil, land.stale)


def _grass(
    tree: nodes.Tree,
    place: Spot,
    here: ShotBiome,
    wet: nodes.Value,
    middling: nodes.Value,
    small: nodes.Value,
) -> nodes.Value:
    """Return the colour of grass from wetness and season, with soil between."""
    land = here.biome.open_land
    assert land is not None
    streaks = place.grain.at(tree.vector("MULTIPLY", place.position, _STREAK)).noise(9.0, 3.0, 0.6)
    kind = middling * 0.55 + small * 0.45 + (streaks - 0.5) * 0.5
    dry = tree.mix_colour(kind.smoothstep(0.30, 0.52), land.stale, land.straw)
    dry = tree.mix_colour((kind - wet * 0.10).smoothstep(0.50, 0.72), dry, land.bleached)
    lush = tree.mix_colour((wet + (small - 0.5) * 0.5).smoothstep(0.1, 0.9), land.green, land.lush)
    # In a dry season only hollows are green; in a green one only crests are dry.
    dries = 0.95 - 1.9 * here.green
    green = (wet + (small - 0.5) * 0.7).smoothstep(dries - 0.35, dries + 0.45) * (0.55 + 0.45 * here.green)
    grass = tree.mix_colour(green, dry, lush)
    soil = tree.mix_colour(small, *land.soil)
    gaps = (small * 0.6 + (1.0 - middling) * 0.4 - wet * 0.08).smoothstep(
        0.66 - 0.35 * land.bare, 0.80 - 0.35 * land.bare
    )
    return tree.mix_colour(gaps * (0.85 - 0.5 * here.green), grass, soil)


@dataclass
class Bushes:
    """Bushes at a point.

    Attributes
    ----------
    part, cover
        0..1: coverage by a bush at the point, and shrub cover around it.
    tone, dome
        0..1: tone of the bush, and height of the point on the bush's dome, from rim (0) to top.
    groups
        Noise of the groups of bushes.
    """

    part: nodes.Value
    cover: nodes.Value
    tone: nodes.Value
    dome: nodes.Value
    groups: nodes.Value


def _bushes(tree: nodes.Tree, place: Spot, land: OpenLand, wet: nodes.Value, middling: nodes.Value) -> Bushes:
    """Return bushes; from afar they are below the pixel size and filtered to a mean within groups."""
    groups, cover = patterns.bushes(place.grain.noise, place.shrub, wet, land)
    cells = tree.node("ShaderNodeTexVoronoi", {"Vector": place.position, "Scale": 1.0 / land.bush})
    near = tree.pick(cells, "Distance")
    lot, tone, size = tree.separate(tree.pick(cells, "Color"))
    wide = (size * 0.35 + 0.45) * (0.75 + 0.45 * cover)
    dome = 1.0 - near / wide
    alone = (dome + (middling - 0.5) * 0.3).smoothstep(0.0, 0.14) * (cover * 1.12 > lot)
    sharp = place.distance.ramp(*_SEEN, 1.0, 0.0) * place.pixel.ramp(
        0.5 * land.bush, 1.5 * land.bush, 1.0, 0.0
    )
    part = tree.mix(sharp, (cover + (middling - 0.5) * 0.25 * cover) * 0.88, alone)
    # Close by, bushes are instanced; the ground shows their litter.
    far = place.pixel.ramp(0.10, 0.60)
    shed = (place.grain.noise(2.2, 5.0, 0.7) + cover - 0.95).smoothstep(-0.14, 0.14) * 0.8
    tones = tree.mix(sharp, 0.40, tone), tree.mix(sharp, 0.38, dome.clamp())
    return Bushes(tree.mix(far, shed, part.clamp()), cover, tones[0], tones[1] * far, groups)


def _bush_colour(
    tree: nodes.Tree, place: Spot, land: OpenLand, there: Bushes, broad: nodes.Value, middling: nodes.Value
) -> nodes.Value:
    """Return the colour of bushes: species in patches, self-shadowed clumps, dark below dense bushes."""
    sorts = (broad * 0.6 + middling * 0.7).smoothstep(0.48, 0.86)
    green = tree.mix_colour(there.tone, *land.shrub)
    green = tree.mix_colour(
        1.0, green, tree.mix_colour(sorts, (0.72, 0.84, 0.76), (1.28, 1.14, 1.10)), "MULTIPLY"
    )
    clumps = place.grain.noise(24.0, 4.0, 0.7) * 0.7 + there.groups * 0.3
    green = _scale_colour(tree, green, clumps.ramp(0.32, 0.66, 0.38, 1.42))
    under = tree.mix_colour(there.cover.smoothstep(0.2, 0.7), land.stale, land.shrub[0])
    return tree.mix_colour(there.dome.smoothstep(0.0, 0.35), _scale_colour(tree, under, 0.75), green)


def _maths(tree: nodes.Tree) -> field_lines.Maths:
    return field_lines.Maths(
        lambda x: tree.math("SINE", x),
        lambda x: tree.math("FLOOR", x),
        lambda x: tree.math("FRACT", x),
        lambda x, y: tree.math("MINIMUM", x, y),
    )


def _colour_fields(
    tree: nodes.Tree, place: Spot, here: ShotBiome, colour: nodes.Value, small: nodes.Value
) -> nodes.Value:
    """Colour fields in different greens: grazed, mown, hay, and some of them ploughed or stubble."""
    land = here.biome.open_land
    assert land is not None
    x, y, _ = tree.separate(place.position)
    off, row, number = field_lines.fields(_maths(tree), x, y, land.field)
    lot = tree.output("ShaderNodeTexWhiteNoise", {"Vector": tree.combine(row, number, 0.0)}, name="Color")
    tone, kind, turn = tree.separate(lot)
    colour = tree.mix_colour(
        place.free, colour, tree.mix_colour(tone, (0.78, 0.84, 0.80), (1.20, 1.12, 1.06)), "MULTIPLY"
    )
    if not land.tilled:
        return colour
    hay = tree.mix_colour(small, land.straw, land.bleached)
    colour = tree.mix_colour((kind > 0.84) * place.free * 0.6, colour, hay)
    soil = tree.mix_colour(small, *land.soil)
    colour = tree.mix_colour((kind < 0.06) * place.free * 0.85, colour, soil)
    # Rows of the mower or the plough, filtered to the pixel size.
    along = tree.mix(turn > 0.5, x, y)
    lines = tree.math("PINGPONG", along, 2.4) / 2.4
    shown = place.pixel.ramp(0.8, 2.4, 0.30, 0.0) * place.free * (tone > 0.35)
    colour = _scale_colour(tree, colour, 1.0 + (lines - 0.5) * shown)
    margin = off.smoothstep(1.5 * land.hedge + 2.0, 0.6 * land.hedge)
    return tree.mix_colour(margin * place.free * 0.6, colour, tree.mix_colour(small, land.lush, land.stale))


def _hedges(tree: nodes.Tree, place: Spot, land: OpenLand) -> tuple[nodes.Value, nodes.Value]:
    """Return hedges 0..1 along fields, with gaps, and their height, m."""
    x, y, _ = tree.separate(place.position)
    off = field_lines.fields(_maths(tree), x, y, land.field)[0]
    ragged = place.grain.noise(9.0, 3.0, 0.65)
    wide = tree.math("MAXIMUM", place.pixel * 0.7, 0.5 * land.hedge)
    line = (off + (ragged - 0.5) * land.hedge).smoothstep(wide * 1.25, wide * 0.75)
    gaps = place.grain.noise(75.0, 2.0, 0.5).smoothstep(0.36, 0.42)
    thin = tree.math("MINIMUM", 0.5 * land.hedge / wide, 1.0)
    return line * gaps * thin * place.free, 2.2 + ragged * 1.5


def _colour_tracks(tree: nodes.Tree, place: Spot, land: OpenLand, colour: nodes.Value) -> nodes.Value:
    """Colour winding tracks with two ruts, and cattle paths across them."""
    x, y, _ = tree.separate(place.position)
    wander = place.grain.noise(1600.0, 4.0, 0.42) - 0.5
    soil = tree.mix_colour(0.5, *land.soil)
    for turn, apart, wide, strong in ((0.5, land.tracks, _TRACK, 0.85), (1.9, 0.37 * land.tracks, 0.5, 0.5)):
        along = x * math.cos(turn) + y * math.sin(turn) + wander * 1500.0
        off = tree.math("PINGPONG", along, 0.5 * apart)
        resolved = tree.math("MAXIMUM", place.pixel * 0.7, 0.5 * wide)
        line = off.smoothstep(resolved * 1.2, resolved * 0.6)
        if wide > 2.0 * _RUT:
            ruts = tree.math("ABSOLUTE", off - (0.5 * wide - 0.5 * _RUT)).smoothstep(_RUT, 0.4 * _RUT)
            line = tree.mix(place.pixel.ramp(0.25, 0.8), ruts, line * 0.8)
        broken = place.grain.noise(210.0, 3.0, 0.6).smoothstep(0.33, 0.43)
        thin = tree.math("MINIMUM", 0.5 * wide / resolved, 1.0)
        colour = tree.mix_colour(line * thin * broken * place.free * strong, colour, soil)
    return colour


def _scale_colour(tree: nodes.Tree, colour: nodes.Value, factor: nodes.Value | float) -> nodes.Value:
    return tree.mix_colour(1.0, colour, tree.combine(factor, factor, factor), "MULTIPLY")
