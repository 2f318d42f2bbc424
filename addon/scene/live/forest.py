"""Live forest: the film's trees as a few meshes, by tile, of near and far shapes.

Vertex attributes are `leaf` (colour; alpha is 1 on leaves and 0 on wood), `fire` (arrival time in s, effect,
height in the tree 0..1), and `outward` (normal). The effect is the scorch height 0..1 of a tree that
survives, and 2 for a crown that burns. The shader compares the arrival with the scene's time.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...shot.shot import Shot
from ...shot.terrain import noise
from ...shot.terrain.terrain import NEVER
from .. import haze
from ..forest import fire_effects, stand
from ..forest.material import TINTS, TORCHING
from ..glow import FLAME, brightness
from . import burning, trees, viewers
from .shade import Shade

_SIDE = 4  # tiles along a side
_TORCHED = 2.0
_FAR_COST, _NEAR_COST = 4, 24  # triangles of a tree, for the budget
_BROWN, _BLACK = (0.085, 0.058, 0.036), (0.016, 0.013, 0.011)
_BARE = 60.0, 180.0  # s from the fire to a bare tree
_SPARSE = 0.62  # part of the leaves of a burned crown that is gone: sheets stand for its branches
_TORCH = 0.06  # factor on the radiance of flames of a whole crown (by eye)
_CLEAR = 0.22  # translucency


def build(
    shot: Shot,
    stage: Stage,
    collection: bpy.types.Collection,
    budget: int,
    shade: Shade | None,
    grown: stand.Stand | None,
) -> list[bpy.types.Object]:
    """Build "Firetwin Live Trees", of at most `budget` triangles; none where the film has no stand."""
    if grown is None or not len(grown.height):
        return []
    away = viewers.distance(shot, grown.position)
    kept, near = choose(away, budget)
    if not len(kept):
        return []
    look = _material(shot, stage, shade)
    objects = []
    for number, tile in enumerate(_tiles(grown.position[kept])):
        data = _mesh(shot, grown, kept[tile], near[kept[tile]], number)
        data.materials.append(look)
        objects.append(owned.add(collection, f"Live Trees {number:02d}", data))
        objects[
            -1
        ].visible_shadow = False  # of each lamp of the flames, EEVEE draws six pictures of all trees
    return objects


def grow(shot: Shot) -> stand.Stand | None:
    """Return the film's trees; None if it has none."""
    return stand.grow(shot, in_film=False) if shot.settings.forest.trees else None


def choose(away: NDArray[np.float64], budget: int) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Choose trees at distances (n,), m: indices of the nearest that fit, and which (n,) have near shapes."""
    order, budget = np.argsort(away, kind="stable"), max(budget, 0)
    kept = order[: budget // _FAR_COST]
    spare = budget - _FAR_COST * len(kept)
    near: NDArray[np.bool_] = np.zeros(len(away), bool)
    near[kept[: spare // (_NEAR_COST - _FAR_COST)]] = True
    return np.sort(kept), near


def _tiles(position: NDArray[np.float64]) -> list[NDArray[np.int64]]:
    """Divide positions (n, 3) into at most `_SIDE` squared tiles of equal counts; return their indices."""
    made = []
    for column in np.array_split(np.argsort(position[:, 0], kind="stable"), _SIDE):
        made += np.array_split(column[np.argsort(position[column, 1], kind="stable")], _SIDE)
    return [tile for tile in made if len(tile)]


def _mesh(
    shot: Shot, grown: stand.Stand, chosen: NDArray[np.int64], near: NDArray[np.bool_], number: int
) -> bpy.types.Mesh:
    """Create one mesh of trees, by their indices (n,)."""
    fire = _fire(shot, grown, chosen)
    lot = noise.uniform(grown.key[chosen, 0], grown.key[chosen, 1], shot.settings.seed + 300)[:, None]
    tint = np.array(TINTS[0]) + lot * np.subtract(TINTS[1], TINTS[0])
    points, triangles, colours, fires, outward, total = [], [], [], [], [], 0
    for model, close in np.unique(np.stack([grown.model[chosen], near], axis=-1), axis=0).tolist():
        crown = (trees.near if close else trees.far)(int(model))
        here = np.flatnonzero((grown.model[chosen] == model) & (near == bool(close)))
        index, count = chosen[here], len(crown.points)
        sine, cosine = np.sin(grown.rotation[index])[:, None], np.cos(grown.rotation[index])[:, None]

        def turned(way: NDArray, sine: NDArray = sine, cosine: NDArray = cosine) -> NDArray:
            x, y = way[:, 0], way[:, 1]
            z = np.broadcast_to(way[:, 2], (len(sine), len(way)))
            return np.stack([x * cosine - y * sine, x * sine + y * cosine, z], axis=-1)

        size = grown.height[index][:, None, None] * np.stack(
            [grown.width[index], grown.width[index], np.ones(len(index))], axis=-1
        ).reshape(-1, 1, 3)
        points.append((turned(crown.points) * size + grown.position[index][:, None]).reshape(-1, 3))
        step = np.arange(len(index))[:, None, None] * count + total
        triangles.append((crown.triangles + step).reshape(-1, 3))
        shaded = crown.colours * (crown.leaf[:, None] * (tint[here][:, None] - 1.0) + 1.0)
        leaf = np.broadcast_to(crown.leaf[None, :, None], (len(index), count, 1))
        colours.append(np.concatenate([shaded, leaf], axis=-1).reshape(-1, 4))
        high = np.broadcast_to(crown.points[None, :, 2:], (len(index), count, 1))
        both = np.broadcast_to(fire[here][:, None], (len(index), count, 2))
        fires.append(np.concatenate([both, high], axis=-1).reshape(-1, 3))
        outward.append(turned(crown.outward).reshape(-1, 3))
        total += len(index) * count
    data = create_mesh(f"Firetwin Live Trees {number:02d}", np.concatenate(points), np.concatenate(triangles))
    add_attribute(data, "leaf", "BYTE_COLOR", np.clip(np.concatenate(colours), 0.0, 1.0))
    add_attribute(data, "fire", "FLOAT_VECTOR", np.concatenate(fires))
    add_attribute(data, "outward", "FLOAT_VECTOR", np.concatenate(outward))
    return data


def _fire(shot: Shot, grown: stand.Stand, chosen: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the arrival time (s) and the effect of the fire (n, 2) of trees (n,)."""
    row, column = shot.ground.under(grown.position[chosen])
    effects = fire_effects.of_trees(shot, row, column, grown.height[chosen], grown.key[chosen])
    arrival = np.minimum(shot.ground.arrival_at(row, column), NEVER)
    return np.stack([arrival, np.where(effects.torched, _TORCHED, effects.scorch)], axis=-1)


def _material(shot: Shot, stage: Stage, shade: Shade | None) -> bpy.types.Material:
    """Build "Firetwin Live Trees": living, scorched, in flames, charred and bare."""
    material, tree = nodes.material("Firetwin Live Trees", (0.16, 0.32, 0.10))
    colour, leaf = tree.attribute("leaf", output="Color"), tree.attribute("leaf", output="Alpha")
    arrival, effect, high = tree.separate(tree.attribute("fire", output="Vector"))
    normal = tree.attribute("outward", output="Vector")
    position = tree.output("ShaderNodeNewGeometry", name="Position")
    age = nodes.model_time(tree) - arrival
    torched = effect > 1.5
    reach = effect * 1.16 - 0.08
    scorched = high.smoothstep(reach + 0.08, reach - 0.08) * age.smoothstep(5.0, 60.0) * leaf
    colour = tree.mix_colour(scorched, colour, _BROWN)
    colour = tree.mix_colour(torched * age.smoothstep(2.0, 20.0), colour, _BLACK)
    if shade is not None:
        colour = shade.apply(tree, colour, position)
    matt = tree.output("ShaderNodeBsdfDiffuse", {"Color": colour, "Normal": normal})
    through = tree.output("ShaderNodeBsdfTranslucent", {"Color": colour, "Normal": normal})
    x, y, z = tree.separate(position)
    flicker = tree.noise(tree.combine(x, y, (z - age * 6.0) * 0.3), 4.0, 2.0)
    part = burning.short(shot)
    alight = age.smoothstep(0.0, 40.0 * part) * age.smoothstep(TORCHING * part, 0.4 * TORCHING * part)
    power = alight * torched * flicker.smoothstep(0.47, 0.69) * (_TORCH * brightness(shot))
    shader = tree.add_shader(tree.mix_shader(_CLEAR, matt, through), tree.emission(FLAME, power))
    shader = haze.apply(tree, shader, stage)
    grain = tree.noise(position, 1.5, 0.0)
    gone = (grain < _SPARSE) * leaf * torched * (age > grain.ramp(0.3, 0.7, *_BARE))
    clear = tree.output("ShaderNodeBsdfTransparent")
    tree.surface(tree.mix_shader(gone, shader, clear))
    return material
