"""Smoke at one time -> OpenVDB: fields of a box, and puffs; time, file size and mass error.

The mass of puffs is read back from the file with the openvdb module bundled with Blender. Without that module
it is the mass that the core reports before rounding to half precision.
"""

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
CELLS = 100  # of the front that emits puffs
VOXELS = (200.0, 100.0)  # m
MANY, FINE = 1000, 50.0  # such cells; m
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


def puffs(cells: int) -> volume.Puffs:
    """Make the smoke of a front that burned `cells` fuel cells in an hour."""
    rng = np.random.default_rng(7)
    arrival = np.sort(rng.uniform(0, 3600, cells))
    place = np.stack([arrival * 2, rng.uniform(-3000, 3000, cells), rng.uniform(800, 1200, cells)], axis=1)
    return volume.puffs(3600.0, arrival, rng.uniform(1, 6, cells), place, [4.0, 3.0], 74.0**2)


def mass_in(openvdb: ModuleType, path: str, grid: str, unit: float) -> float:
    """Sum a grid of the file, times the volume of a voxel, times `unit`."""
    density = openvdb.read(path, grid)
    low, high = density.evalActiveVoxelBoundingBox()
    values = np.zeros([b - a + 1 for a, b in zip(low, high, strict=True)], np.float32)
    density.copyToArray(values, ijk=low)
    voxel = np.prod(density.transform.voxelSize())
    return float(values.sum(dtype=float)) * float(voxel) * unit


def run(bench: Bench) -> None:
    """Measure three fields of a box, as a solved flow has them, then puffs at several voxel sizes."""
    openvdb = bundled_openvdb(bench)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "smoke.vdb")
        _box(bench, path, openvdb)
        _voxel_sizes(bench, path, openvdb)
        _many(bench, path)


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


def _voxel_sizes(bench: Bench, path: str, openvdb: ModuleType | None) -> None:
    smoke = puffs(CELLS)
    exact = float(np.sum(smoke.mass))
    for voxel in VOXELS:
        tool = Runner(OURS, partial(volume.write_smoke, path, smoke, voxel), threads=2)
        times = bench.time([tool])[tool.label]
        frame = tool.call()
        mass = mass_in(openvdb, path, "dilution", volume.FRESH_SMOKE) if openvdb else frame.mass
        bench.row(
            f"puffs of {CELLS} cells at {voxel:g} m",
            OURS,
            times,
            frame.active_voxels,
            "voxel",
            error=abs(mass / exact - 1),
            error_unit="of the mass",
            threads=2,
            bytes=frame.bytes,
        )


def _many(bench: Bench, path: str) -> None:
    """Measure a complete frame, whose voxels count once."""
    smoke = puffs(MANY)
    write = partial(volume.write_smoke, path, smoke, FINE)
    frame = write()
    wrong = abs(frame.mass / float(np.sum(smoke.mass)) - 1)
    tools = [Runner(OURS, write, threads, wrong) for threads in (1, 2)]
    case = f"puffs of {MANY:,} cells at {FINE:g} m"
    times = bench.race(case, tools, frame.active_voxels, "voxel", "of the mass")
    speed = times[tools[1].label].speed(frame.active_voxels / 1e6)
    bench.target("Build and write rate, a frame of puffs, two threads", speed, MEGAVOXELS, "Mvoxel/s")
    bench.target("Smoke mass of puffs, relative error", wrong, 1e-6, "", most=True)
