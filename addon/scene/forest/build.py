"""Forest builder: instances of trees (a stand, or Algorithm 2 with one per fuel cell), understorey and grass.

All are instances on points. Float attributes of a point are `scale` (height, m), `width` (ratio to the
model's width), `rotation`, `pitch` and `roll` (radians), `arrival_time`, `elevation`, `canopy_fuel`, `tint`,
`hue`, `dead`, `scorch`, `torched`, and the indices of its models, `model` and `snag_model`; trees also have
an instance number `number` (see `passes.masks`). Plants outside of all views are culled; in
renders `frame_culling` also hides trees outside of the frame's views.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import forest as core
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...blender import compat, nodes, owned
from ...blender.mesh import add_attribute, create_mesh
from ...blender.owned import Stage
from ...passes import masks
from ...shot.cameras.rigs.satellite import HEIGHT
from ...shot.shot import Shot
from ...shot.terrain import noise
from ...shot.terrain.terrain import NEVER
from ...shot.tiles import tile_vegetation
from .. import clock, flame_field
from . import fire_effects, models, preview, stand_structure, understorey, visibility, visible_cells
from .frame_culling import IN_VIEW
from .library import drawn, grass_models, levelled, tree_models
from .material import BARE_AFTER, LOW_BARE_AFTER, TORCHING, burning_share
from .stand import Stand

GRASS_DISTANCE = 400.0  # m
_ALIKE = (
    110.0,
    70.0,
    240.0,
)  # m, patches: trees of one shade, dead before, of one hue; by eye
_TALLEST, _GRASS = 31.0, 10.0  # m; as tall as any tree of Algorithm 2, and as a tree that would hold a clump
_WIDER = 12.0  # lower relative to trees: bushes and logs; by FLIP from among them (culling.py)


def build(shot: Shot, stage: Stage, grown: Stand | None) -> list[bpy.types.Object]:
    """Build "Firetwin Trees", "Firetwin Understorey" and "Firetwin Grass", each if any of it is visible."""
    collection = stage.part("Forest")
    objects, below, plants = [], understorey.grow(shot), {}
    if grown is not None:
        points = algorithm2(shot) if shot.settings.forest.density == "paper" else _stand(shot, grown)
        plants["Trees"] = levelled(shot, points)
    if len(below.size):
        plants["Understorey"] = levelled(shot, _understorey(shot, below), _WIDER)
    if plants:
        library = tree_models(shot, stage, set().union(*map(drawn, plants.values())))
    for name, points in plants.items():
        objects.append(_instances(shot, stage, collection, name, points, library))
    if shot.settings.forest.grass:
        library = grass_models(shot, stage)
        objects.append(_instances(shot, stage, collection, "Grass", _grass(shot), library))
    return objects


def algorithm2(shot: Shot) -> dict[str, NDArray]:
    """Point attributes of the visible trees of Algorithm 2.

    East and north come from the core. So does the height, except near cameras, where the terrain mesh has
    more relief.
    """
    run, seed, reach = shot.run, shot.settings.seed, shot.settings.forest.draw_distance
    axes = run.fuel_latitude, run.fuel_longitude
    trees = core.trees(
        run.canopy_fuel,
        *axes,
        shot.relief.fuel,
        shot.local_frame,
        seed=seed,
        mask=visible_cells.visible_cells(shot, _TALLEST, reach, *axes, shot.relief.fuel),
    )
    position = visibility.settled(shot.ground, trees.position)
    there = visibility.visible(shot, position, trees.scale, reach)
    kept = np.flatnonzero(there & tile_vegetation.may_grow(shot, position))
    cell = trees.cell[kept]
    first = np.array([models.FIRST_MODEL[k] for k in (0, 1, 2)])[trees.size_class[kept]]
    model = first + trees.model[kept]
    width = np.ones(len(cell))
    points = _points(
        shot, position[kept], trees.scale[kept], width, trees.rotation[kept], model, cell, cell * 0
    )
    return {**points, "number": masks.numbers(cell, cell * 0)}


def _stand(shot: Shot, grown: Stand) -> dict[str, NDArray]:
    shape = grown.position, grown.height, grown.width, grown.rotation, grown.model
    return {**_points(shot, *shape, *grown.key.T), "number": masks.numbers(*grown.key.T)}


def _understorey(shot: Shot, instances: understorey.Instances) -> dict[str, NDArray]:
    points = _points(
        shot,
        instances.position,
        instances.height,
        instances.width,
        instances.rotation,
        instances.model,
        *instances.key.T,
    )
    everywhere = np.ones(len(instances.size))  # flames of the surface fire reach the whole plant
    points |= {"scorch": everywhere, "torched": everywhere, "snag_model": instances.burned}
    return {**points, "pitch": instances.pitch, "roll": instances.roll}


def _grass(shot: Shot) -> dict[str, NDArray]:
    run, ground, seed = shot.run, shot.ground, shot.settings.seed
    axes = run.fuel_latitude, run.fuel_longitude
    mask = visible_cells.visible_cells(shot, _GRASS, GRASS_DISTANCE, *axes, shot.relief.fuel)
    clumps = core.grass(run.surface_fuel, *axes, shot.relief.fuel, ground.frame, seed=seed, mask=mask)
    position = visibility.settled(ground, clumps.position)
    moved = np.abs(position[:, 2] - clumps.position[:, 2]) > 0.0
    position[moved, 2] -= 0.7
    there = visibility.visible(shot, position, _GRASS, GRASS_DISTANCE)
    kept = np.flatnonzero(there & tile_vegetation.may_grow(shot, position))
    cell, position = clumps.cell[kept], position[kept]
    model = (noise.uniform(cell, 7, seed) < 0.5).astype(np.int64)
    scale, width = clumps.scale[kept], np.ones(len(cell))
    points = _points(shot, position, scale, width, clumps.rotation[kept], model, cell, cell * 0 + 1)
    return points | {"snag_model": model}


def _points(
    shot: Shot,
    position: NDArray,
    scale: NDArray,
    width: NDArray,
    rotation: NDArray,
    model: NDArray,
    key: NDArray,
    second: NDArray,
) -> dict[str, NDArray]:
    """All attributes of n trees; random ones are hashes of two integers per tree."""
    ground, seed = shot.ground, shot.settings.seed
    row, column = ground.under(position)
    tint, dead, hue = (
        stand_structure.clustered_uniform(
            position, size, noise.uniform(key, second, seed + 300 + k), seed + 330 + 10 * k
        )
        for k, size in enumerate(_ALIKE)
    )
    burned = fire_effects.of_trees(shot, row, column, scale, np.stack([key, second], axis=-1))
    size = np.select([scale > 20.0, scale > 12.0], [0, 1], 2)
    return {
        "position": position,
        "scale": scale,
        "width": width,
        "rotation": rotation,
        "model": model,
        "scorch": burned.scorch,
        "torched": burned.torched.astype(np.float64),
        "snag_model": np.where(burned.torched, np.array(models.SNAGS)[size], model),
        "arrival_time": np.minimum(ground.arrival_at(row, column), NEVER),
        "elevation": bilinear(ground.fields.elevation, row, column),
        "canopy_fuel": bilinear(ground.fields.canopy_fuel, row, column),
        "tint": tint,
        "dead": dead,
        "hue": hue,
    }


def _instances(
    shot: Shot,
    stage: Stage,
    collection: bpy.types.Collection,
    name: str,
    points: dict[str, NDArray],
    library: bpy.types.Collection,
) -> bpy.types.Object:
    """Create an object of plant instances, and its proxies for the viewport."""
    culled, low = name == "Trees", name == "Understorey"
    group = node_group(shot, stage, f"Firetwin {name}", library, culled=culled, low=low)
    full = _object(collection, name, points, group)
    if culled:
        add_attribute(full.data, IN_VIEW, "BOOLEAN", np.ones(len(points["position"])))
    shown = []
    for part, some, follows in preview.parts(shot, points, name != "Grass"):
        title = f"{part} {name} in Viewport".strip()
        few = preview.used(title, library, some)
        group = node_group(shot, stage, f"Firetwin {title}", few, burns=follows, low=low)
        shown.append(_object(collection, title, some, group))
    preview.show_proxies(full, shown)
    return full


def _object(
    collection: bpy.types.Collection, name: str, points: dict[str, NDArray], group: bpy.types.NodeTree
) -> bpy.types.Object:
    """Create a point cloud object with the node group that instances models on it."""
    data = create_mesh(f"Firetwin {name}", points["position"])
    for key, values in points.items():
        if key != "position":
            add_attribute(data, key, "INT" if key.endswith("model") else "FLOAT", values)
    obj = owned.add(collection, name, data)
    modifier = obj.modifiers.new("Firetwin Instances", "NODES")
    modifier.node_group = group
    return obj


def _drawn(tree: nodes.Tree, shot: Shot) -> nodes.Value | bool:
    """Return a value that is true if plants are rendered: not for a satellite that resolves none.

    Plants placed for other cameras would be a patch in its picture, in which the ground's colour represents
    the forest.
    """
    if not visibility.too_far(shot):
        return True
    camera = tree.output("GeometryNodeInputActiveCamera")
    place = tree.output("GeometryNodeObjectInfo", {"Object": camera}, "Location")
    return tree.separate(place)[2] < 0.75 * HEIGHT


def node_group(
    shot: Shot,
    stage: Stage,
    name: str,
    library: bpy.types.Collection,
    *,
    burns: bool = True,
    culled: bool = False,
    low: bool = False,
) -> bpy.types.NodeTree:
    """Geometry nodes that instance a model on each point; with `burns` it then becomes a snag.

    It becomes a snag as its flames end: within the field of flames, which shows them, sooner than far away.
    Plants that are `low`, bushes and tufts, are bare sooner still.

    If `culled`, points outside of a frame's views have no instance (see `frame_culling`).
    """
    tree, given = nodes.geometry(name)
    collection = tree.node("GeometryNodeCollectionInfo", transform_space="ORIGINAL")
    compat.find_socket(collection.inputs, "Collection").default_value = library
    compat.find_socket(collection.inputs, "Separate Children").default_value = True
    compat.find_socket(collection.inputs, "Reset Children").default_value = True

    def attribute(key: str, kind: str) -> nodes.Value:
        return tree.output("GeometryNodeInputNamedAttribute", {"Name": key}, data_type=kind)

    model = attribute("model", "INT")
    if burns:
        age = clock.geometry_time(tree, shot) - attribute("arrival_time", "FLOAT")
        after = tree.input("Bare After", TORCHING, "Time (s) from the fire to a bare plant", "Fire")
        soon = attribute("tint", "FLOAT").ramp(0.0, 1.0, *BARE_AFTER)
        near = flame_field.distance_beyond(tree, stage) < 0.0
        after = tree.mix(near, after, tree.math("MINIMUM", after, soon))
        if low:
            spent = (TORCHING * burning_share(shot) * part for part in LOW_BARE_AFTER)
            after = tree.math("MINIMUM", after, attribute("tint", "FLOAT").ramp(0.0, 1.0, *spent))
        burned = tree.output("FunctionNodeCompare", [age, after], data_type="FLOAT", operation="GREATER_THAN")
        choice = {"Switch": burned, "False": model, "True": attribute("snag_model", "INT")}
        model = tree.output("GeometryNodeSwitch", choice, input_type="INT")
    selection = _drawn(tree, shot) if burns else True
    if culled:
        seen = attribute(IN_VIEW, "BOOLEAN")
        selection = seen if selection is True else tree.output("FunctionNodeBooleanMath", [seen, selection])
    taller = tree.input("Height", 1.0, "Factor on the size of all plants", "Size")
    wider = tree.input("Width", 1.0, "Factor on how wide plants are for their height", "Size")
    up = attribute("scale", "FLOAT") * taller
    across = up * attribute("width", "FLOAT") * wider
    instances = tree.output(
        "GeometryNodeInstanceOnPoints",
        {
            "Points": tree.pick(given, "Geometry"),
            "Selection": selection,
            "Instance": collection,
            "Pick Instance": True,
            "Instance Index": model,
            "Rotation": tree.combine(*(attribute(turn, "FLOAT") for turn in ("roll", "pitch", "rotation"))),
            "Scale": tree.combine(across, across, up),
        },
    )
    tree.geometry(instances)
    return tree.node_tree
