"""Fuel grid -> trees and grass (Algorithm 2), and a stand of stems, compared with Blender's Poisson disk.

Both give each stem room. Firetwin's stand also has sizes, and the distance levels that a drone's view needs;
Blender's node "Distribute Points on Faces" gives positions alone. The speed decides how long a change of the
forest takes to show.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from firetwin_core import forest, lod
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from ..jobs import worker
from ..progress import MessageCallback, Progress, no_message, silent
from .harness import ORIGIN, OURS, Bench
from .timing import LEAST, Runner, Stopwatch, Times

SIDE = 720
TREES, GRASS = 363_632 / 720**2, 419_048 / 720**2  # shares of the paper's cells
STEMS = 1_000_000
CELL = 74.0**2  # m2
POISSON, FIELD = "Blender's Poisson disk", 700.0  # m, side of its field of points at least a metre apart
FRAMES = 48
Grid = tuple[NDArray, NDArray, NDArray, NDArray, NDArray]


def fuel_grid(side: int) -> Grid:
    """Make canopy and surface fuel (side, side) kg/m2, latitude, longitude and elevation."""
    rng = np.random.default_rng(3)
    shape = (side, side)
    canopy = np.where(rng.random(shape) < TREES, 0.02 + rng.gamma(2, 0.6, shape), 0).astype(np.float32)
    surface = np.where(rng.random(shape) < GRASS, 0.1 + rng.random(shape), 0).astype(np.float32)
    latitude, longitude = np.linspace(38.69, 39.17, side), np.linspace(-120.85, -120.23, side)
    return canopy, surface, latitude, longitude, rng.uniform(300, 2900, shape).astype(np.float32)


def planted(grid: Grid) -> tuple[forest.Trees, forest.Grass]:
    """Plant one tree and one grass clump per cell with fuel."""
    canopy, surface, latitude, longitude, elevation = grid
    frame = LocalFrame(*ORIGIN)
    return (
        forest.trees(canopy, latitude, longitude, elevation, frame, seed=5),
        forest.grass(surface, latitude, longitude, elevation, frame, seed=5),
    )


def drone() -> lod.ViewSet:
    """Return the views of a drone that flies 5 km and looks ahead and slightly down."""
    camera = np.column_stack([np.linspace(0.0, 5000.0, FRAMES), np.zeros(FRAMES), np.full(FRAMES, 3500.0)])
    down = np.radians(17.0)
    right, up = (0.0, -1.0, 0.0), (np.sin(down), 0.0, np.cos(down))
    back = (-np.cos(down), 0.0, np.sin(down))
    rotation = np.broadcast_to(np.column_stack([right, up, back]), (FRAMES, 3, 3))
    return lod.ViewSet(camera, rotation, np.tile([0.64, 0.36], (FRAMES, 1)))


def part(grid: Grid, stems: int) -> NDArray[np.float32]:
    """Return the fraction of stems to retain in each cell (fy, fx) for this total."""
    return np.full(grid[0].shape, stems / (forest.stems(grid[0]).sum() * CELL), np.float32)


def stand(grid: Grid, kept: NDArray, views: lod.ViewSet) -> tuple[forest.Stems, NDArray]:
    """Grow the stems, and return them with the level of detail of each visible one."""
    canopy, _, latitude, longitude, elevation = grid
    frame = LocalFrame(*ORIGIN)
    stems = forest.stand(canopy, latitude, longitude, elevation, frame, seed=5, retained=kept)
    visible = lod.visible_mask(stems.position, 0.6 * stems.scale, views)
    return stems, lod.levels(lod.distance(stems.position[visible], views))


def run(bench: Bench) -> None:
    """Measure a fuel grid of the King Fire's size: a plant per cell, then a stand, on one and two threads."""
    grid, views = fuel_grid(SIDE), drone()
    trees, grass = planted(grid)
    plants, call = len(trees) + len(grass), partial(planted, grid)
    bench.race(f"{SIDE} x {SIDE}", [Runner(OURS, call), Runner(OURS, call, threads=2)], plants, "plant")
    grow = partial(stand, grid, part(grid, STEMS), views)
    stems, tools = len(grow()[0]), [Runner(OURS, grow), Runner(OURS, grow, threads=2)]
    case = f"a stand of {STEMS:,} stems"
    speed = bench.race(case, tools, stems, "stem")[tools[1].label].speed(stems / 1e6)
    if bench.blender():
        points, seconds = worker.run(distribute)
        bench.row(f"a field of {points:,} points", POISSON, Times(tuple(seconds)), points, "point", threads=2)
        theirs = points / 1e6 / float(np.median(seconds))
        bench.target("Speed of a stand, two threads", speed, theirs, "Mstem/s", rival=POISSON)


# The following function runs in the worker process, where Blender is.


def distribute(progress: Progress = silent, tell: MessageCallback = no_message) -> tuple[int, list[float]]:
    """Distribute points on a plane repeatedly; return their number, and the seconds of each repetition."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=FIELD)
    field: Any = bpy.context.object
    tree = bpy.data.node_groups.new("Field", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    points = tree.nodes.new("GeometryNodeDistributePointsOnFaces")
    points.distribute_method = "POISSON"
    points.inputs["Distance Min"].default_value = points.inputs["Density Max"].default_value = 1.0
    tree.links.new(tree.nodes.new("NodeGroupInput").outputs[0], points.inputs["Mesh"])
    tree.links.new(points.outputs["Points"], tree.nodes.new("NodeGroupOutput").inputs[0])
    field.modifiers.new("Field", "NODES").node_group = tree
    seconds = []
    for seed in range(LEAST):
        points.inputs["Seed"].default_value = seed
        watch = Stopwatch()
        geometry = field.evaluated_get(bpy.context.evaluated_depsgraph_get()).evaluated_geometry()
        seconds.append(watch.read().seconds)
    return len(geometry.pointcloud.points), seconds
