"""The forest: Algorithm 2's trees and grass, and the stand near the cameras, as instances on points.

A point has float attributes `scale` (height, m), `rotation`, `arrival_time`, `elevation`, `canopy_fuel`,
`tint`, `dead`, `severity`, and the numbers of its models, `model` and `snag_model`. Only what a camera can
see is made.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import forest as core
from numpy.typing import NDArray

from ...blender import compat, nodes, owned
from ...blender.owned import Stage
from ...shot import noise
from ...shot.ground import NEVER, Ground, bilinear
from ...shot.shot import Shot
from .. import clock
from . import models
from .library import grass_models, levelled, tree_models
from .stand import Stand

GRASS_DISTANCE = 400.0  # m
BARE_AFTER = 900.0  # s after the fire came a burned tree is a snag
_TALLEST, _GRASS = 31.0, 10.0  # m; as tall as any tree of Algorithm 2, and as one that would hold a clump
_AROUND = 30.0  # m; a tree farther beside the view than it is tall takes little light of the sky from it
_RELIEF = 30.0  # m; so far up and down the drawn ground's relief may move a tree
_SNAG = 0.85  # part of the burned trees that become snags
_PIXEL = 25.0  # m; a satellite whose pixels are larger sees no tree


def build(shot: Shot, stage: Stage, grown: Stand | None) -> list[bpy.types.Object]:
    """Build "Firetwin Trees", "Firetwin Stand" and "Firetwin Grass", each where there is something to see."""
    collection = stage.part("Forest")
    made = []
    if grown is not None:
        library = tree_models(shot, stage)
        for name, points in (("Trees", algorithm2(shot)), ("Stand", _stand(shot, grown))):
            made.append(_instances(shot, collection, name, levelled(shot, points), library))
    if shot.settings.forest.grass:
        library = grass_models(shot, stage)
        made.append(_instances(shot, collection, "Grass", _grass(shot), library))
    return made


def algorithm2(shot: Shot) -> dict[str, NDArray]:
    """Point attributes of those trees of Algorithm 2 that a camera sees.

    East and north are the core's; so is the height but near cameras, where the drawn ground has more relief.
    """
    run, seed, reach = shot.run, shot.settings.seed, shot.settings.forest.draw_distance
    axes = run.fuel_latitude, run.fuel_longitude
    found = core.trees(
        run.canopy_fuel,
        *axes,
        run.fuel_elevation,
        shot.local_frame,
        seed=seed,
        mask=_cells(shot, _TALLEST, reach),
    )
    position = _settled(shot.ground, found.position)
    kept = np.flatnonzero(visible(shot, position, found.scale, reach))
    cell = found.cell[kept]
    first = np.array([models.FIRST_MODEL[k] for k in (0, 1, 2)])[found.size_class[kept]]
    model = first + found.model[kept]
    return _points(shot, position[kept], found.scale[kept], found.rotation[kept], model, cell, cell * 0)


def visible(shot: Shot, foot: NDArray, height: NDArray | float, reach: float) -> NDArray[np.bool_]:
    """Which plants (n,) `height` m tall with feet at (n, 3) count: seen, or throwing shadows on what is.

    Those beside a view within `_AROUND` count too, as they take light of the sky from it; those farther away
    than `reach` or too small for a satellite do not.
    """
    height = np.broadcast_to(height, len(foot))
    middle = np.column_stack([foot[:, :2], foot[:, 2] + 0.5 * height])
    return shot.sights.seen(
        middle, models.REACH * height, reach=reach, margin=_AROUND, shadows=True, pixel=_PIXEL
    )


def _cells(shot: Shot, height: float, reach: float) -> NDArray[np.bool_]:
    """Fuel cells (fy, fx) of the run where a plant of at most this height may count."""
    run = shot.run
    place = shot.local_frame.forward_grid(run.fuel_latitude, run.fuel_longitude, run.fuel_elevation)
    slope = sum(_steps(place[..., 2], axis) for axis in (0, 1))
    size = np.hypot(0.5 * np.hypot(*shot.ground.cell), slope) + _RELIEF
    counts = visible(shot, place.reshape(-1, 3), height + size.ravel() / models.REACH, reach)
    return counts.reshape(size.shape)


def _steps(height: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    """Largest difference of each height from its neighbours' along an axis, where they are known."""
    padded = np.pad(height, [(1, 1) if k == axis else (0, 0) for k in (0, 1)], "edge")
    step = np.nan_to_num(np.abs(np.diff(padded, axis=axis)))
    return np.lib.stride_tricks.sliding_window_view(step, 2, axis).max(-1)


def _settled(ground: Ground, position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions on the ground as it is drawn."""
    position = position.copy()
    near = np.flatnonzero(ground.detail(*position.T) > 0.0)
    if len(near):
        position[near, 2] = ground.up(position[near, 0], position[near, 1])
    return position


def _stand(shot: Shot, grown: Stand) -> dict[str, NDArray]:
    return _points(shot, grown.position, grown.height, grown.rotation, grown.model, *grown.key.T)


def _grass(shot: Shot) -> dict[str, NDArray]:
    run, ground, seed = shot.run, shot.ground, shot.settings.seed
    axes = run.fuel_latitude, run.fuel_longitude
    mask = _cells(shot, _GRASS, GRASS_DISTANCE)
    found = core.grass(run.surface_fuel, *axes, run.fuel_elevation, ground.frame, seed=seed, mask=mask)
    position = _settled(ground, found.position)
    moved = np.abs(position[:, 2] - found.position[:, 2]) > 0.0
    position[moved, 2] -= 0.7
    kept = np.flatnonzero(visible(shot, position, _GRASS, GRASS_DISTANCE))
    cell, position = found.cell[kept], position[kept]
    model = (noise.uniform(cell, 7, seed) < 0.5).astype(np.int64)
    return _points(shot, position, found.scale[kept], found.rotation[kept], model, cell, cell * 0 + 1)


def _points(
    shot: Shot,
    position: NDArray,
    scale: NDArray,
    rotation: NDArray,
    model: NDArray,
    key: NDArray,
    second: NDArray,
) -> dict[str, NDArray]:
    """All attributes of n trees; random ones hang on two integers per tree."""
    ground, seed = shot.ground, shot.settings.seed
    row, column = ground.indices(*ground.geodetic(position[:, 0], position[:, 1]))
    tint, dead, lot = (noise.uniform(key, second, seed + 300 + k) for k in range(3))
    size = np.select([scale > 20.0, scale > 12.0], [0, 1], 2)
    return {
        "position": position,
        "scale": scale,
        "rotation": rotation,
        "model": model,
        "severity": 1.0 - lot,
        "snag_model": np.where(lot < _SNAG, np.array(models.SNAGS)[size], model),
        "arrival_time": np.minimum(ground.arrival_at(row, column), NEVER),
        "elevation": bilinear(ground.fields.elevation, row, column),
        "canopy_fuel": bilinear(ground.fields.canopy_fuel, row, column),
        "tint": tint,
        "dead": dead,
    }


def _instances(
    shot: Shot,
    collection: bpy.types.Collection,
    name: str,
    points: dict[str, NDArray],
    library: bpy.types.Collection,
) -> bpy.types.Object:
    """Make an object of bare points with the node group that puts models on them."""
    data = bpy.data.meshes.new(f"Firetwin {name}")
    data.vertices.add(len(points["position"]))
    data.vertices.foreach_set("co", points["position"].astype(np.float32).ravel())
    for key, values in points.items():
        if key != "position":
            whole = key.endswith("model")
            attribute = data.attributes.new(key, "INT" if whole else "FLOAT", "POINT")
            attribute.data.foreach_set("value", values.astype(np.int32 if whole else np.float32))
    data.update()
    thing = owned.add(collection, name, data)
    modifier = thing.modifiers.new("Firetwin Instances", "NODES")
    modifier.node_group = _node_group(shot, f"Firetwin {name}", library)
    return thing


def _node_group(shot: Shot, name: str, library: bpy.types.Collection) -> bpy.types.NodeTree:
    """A model on every point, which becomes a snag some time after the fire came."""
    tree, given = nodes.geometry(name)
    collection = tree.node("GeometryNodeCollectionInfo", transform_space="ORIGINAL")
    compat.find_socket(collection.inputs, "Collection").default_value = library
    compat.find_socket(collection.inputs, "Separate Children").default_value = True
    compat.find_socket(collection.inputs, "Reset Children").default_value = True

    def attribute(key: str, kind: str) -> nodes.Value:
        return tree.output("GeometryNodeInputNamedAttribute", {"Name": key}, data_type=kind)

    age = clock.geometry_time(tree, shot) - attribute("arrival_time", "FLOAT")
    burned = tree.output(
        "FunctionNodeCompare", [age, BARE_AFTER], data_type="FLOAT", operation="GREATER_THAN"
    )
    model = {"Switch": burned, "False": attribute("model", "INT"), "True": attribute("snag_model", "INT")}
    instances = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": tree.pick(given, "Geometry"),
            "Instance": collection,
            "Pick Instance": True,
            "Instance Index": tree.output("GeometryNodeSwitch", model, input_type="INT"),
            "Rotation": tree.combine(0.0, 0.0, attribute("rotation", "FLOAT")),
            "Scale": attribute("scale", "FLOAT"),
        },
    )
    tree.node("NodeGroupOutput", {"Geometry": instances})
    return tree.node_tree
