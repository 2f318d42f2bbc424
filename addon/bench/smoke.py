"""Smoke at one time -> OpenVDB: fields of a box; time, file size and mass error."""

from __future__ import annotations

import os
import sys
import tempfile
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner

SIDE, VOXEL = 288, 20.0  # m
MEGAVOXELS = 45.0  # a second


def bundled_openvdb(bench: Bench) -> ModuleType | None:
    """Import the openvdb module of Blender's Python, which `bpy` bundles outside of the path."""
    spec = find_spec("bpy")
    if spec and spec.submodule_search_locations:
        places = Path(next(iter(spec.submodule_search_locations))).glob("*/python/lib/python*/site-packages")
        sys.path.extend(str(place) for place in places if list(place.glob("openvdb*")))
    return bench.rival("openvdb")


def ring(side: int) -> NDArray[np.float32]:
    """Make density (side, side, side / 3), kg/m3: a noisy ring of smoke in empty air."""
    rng = np.random.default_rng(6)
    x, y, z = np.mgrid[:side, :side, : side // 3] / side - 0.5
    inside = np.abs(np.hypot(x, y) - 0.3) < 0.15
    return np.where(inside & (z < 0), 1e-4 * (1 + rng.random(x.shape)), 0).astype(np.float32)


def run(bench: Bench) -> None:
    """Measure three fields of a box, as a solved flow has them."""
    openvdb = bundled_openvdb(bench)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "smoke.vdb")
        _box(bench, path, openvdb)


def _box(bench: Bench, path: str, openvdb: ModuleType | None) -> None:
    """Measure a box; the voxels of all fields count."""
    density = ring(SIDE)
    warm = np.where(density > 0, 300 + 1e5 * density, 0).astype(np.float32)
    fields = {"density": density, "tint": density * np.float32(5e3), "temperature": warm}
    write = partial(volume.write, path, fields, VOXEL)
    frame = write()
    wrong = abs(frame.mass / (float(density.sum(dtype=np.float64)) * VOXEL**3) - 1)
    tools = [Runner(OURS, write, threads, wrong) for threads in (1, 2)]
    if openvdb:
        tools.append(Runner("openvdb (Python)", partial(with_openvdb, openvdb, path, fields)))
    case = f"{len(fields)} fields of {SIDE} x {SIDE} x {SIDE // 3}"
    times = bench.race(case, tools, frame.voxels, "voxel", "of the mass")
    speed = times[tools[1].label].speed(frame.voxels / 1e6)
    quantity = "Build and write rate, several fields of a box, two threads"
    bench.target(quantity, speed, MEGAVOXELS, "Mvoxel/s")
    bench.target("Smoke mass of a box, relative error", wrong, 1e-6, "", most=True)


def with_openvdb(openvdb: ModuleType, path: str, fields: dict[str, NDArray]) -> None:
    """Write the same fields with the openvdb module."""
    grids = []
    for name, values in fields.items():
        grid = openvdb.FloatGrid()
        grid.copyFromArray(values)
        grid.name, grid.saveFloatAsHalf = name, True
        grid.transform = openvdb.createLinearTransform(voxelSize=VOXEL)
        grids.append(grid)
    openvdb.write(path, grids=grids)
