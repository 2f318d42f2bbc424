"""Smoke -> OpenVDB files, beside the openvdb module that Blender brings along."""

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

SIDES = (36, 144, 288)
VOXEL = 20.0  # m
PUFFS, SMOKE_VOXEL = 1000, 50.0  # m
MEGAVOXELS = 45.0  # a second


def bundled_openvdb(bench: Bench) -> ModuleType | None:
    """The openvdb module of Blender's Python, which is beside `bpy`, not on the path."""
    spec = find_spec("bpy")
    if spec and spec.submodule_search_locations:
        places = Path(next(iter(spec.submodule_search_locations))).glob("*/python/lib/python*/site-packages")
        sys.path.extend(str(place) for place in places if list(place.glob("openvdb*")))
    return bench.rival("openvdb")


def plume(side: int) -> NDArray:
    """Density kg/m3 (side, side, side / 3): a noisy ring of smoke in empty air."""
    rng = np.random.default_rng(6)
    x, y, z = np.mgrid[:side, :side, : side // 3] / side - 0.5
    ring = np.abs(np.hypot(x, y) - 0.3) < 0.15
    return np.where(ring & (z < 0), 1e-4 * (1 + rng.random(x.shape)), 0).astype(np.float32)


def puffs(cells: int) -> volume.Puffs:
    """Smoke of a front of `cells` fuel cells an hour long."""
    rng = np.random.default_rng(7)
    arrival = np.sort(rng.uniform(0, 3600, cells))
    place = np.stack([arrival * 2, rng.uniform(-3000, 3000, cells), rng.uniform(800, 1200, cells)], axis=1)
    return volume.puffs(3600.0, arrival, rng.uniform(1, 6, cells), place, [4.0, 3.0], 74.0**2)


def run(bench: Bench) -> None:
    """Dense arrays of growing size through both, then several fields, then whole smoke frames from puffs."""
    openvdb = bundled_openvdb(bench)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "smoke.vdb")
        for side in SIDES:
            _dense(bench, path, side, openvdb)
        _boxes(bench, path)
        _smoke(bench, path)


def _dense(bench: Bench, path: str, side: int, openvdb: ModuleType | None) -> None:
    density = plume(side)
    voxels = int((density != 0).sum())
    exact = float(density.sum(dtype=np.float64)) * VOXEL**3

    def ours() -> volume.Frame:
        return volume.write(path, {"density": density}, VOXEL)

    def theirs() -> None:
        grid = openvdb.FloatGrid()
        grid.copyFromArray(density)
        grid.name, grid.saveFloatAsHalf = "density", True
        grid.transform = openvdb.createLinearTransform(voxelSize=VOXEL)
        openvdb.write(path, grids=[grid])

    wrong = abs(ours().mass / exact - 1)
    tools = [Runner(OURS, ours, threads, wrong) for threads in (1, 2)]
    if openvdb:
        tools.append(Runner("openvdb (Python)", theirs))
    found = bench.race(f"{side} x {side} x {side // 3} array", tools, voxels, "voxel", "of the mass")
    if side == SIDES[-1]:
        speed = found[OURS].speed(voxels / 1e6)
        bench.target("a dense array is built and written, on one thread, at", speed, MEGAVOXELS, "Mvoxel/s")
        bench.target("mass of a dense array off by", wrong, 1e-6, "", most=True)


def _boxes(bench: Bench, path: str) -> None:
    """Several fields of one box, as a solved flow gives them; the voxels of all fields are counted."""
    side = SIDES[-1]
    density = plume(side)
    warm = np.where(density > 0, 300 + 1e5 * density, 0).astype(np.float32)
    fields = {"density": density, "tint": density * np.float32(5e3), "temperature": warm}
    write = partial(volume.write, path, fields, VOXEL)
    frame = write()
    wrong = abs(frame.mass / (float(density.sum(dtype=np.float64)) * VOXEL**3) - 1)
    tools = [Runner(OURS, write, threads, wrong) for threads in (1, 2)]
    case = f"{len(fields)} fields of {side} x {side} x {side // 3}"
    found = bench.race(case, tools, frame.voxels, "voxel", "of the mass")
    speed = found[tools[1].label].speed(frame.voxels / 1e6)
    promise = "several fields of one box are built and written, on two threads, at"
    bench.target(promise, speed, MEGAVOXELS, "Mvoxel/s")


def _smoke(bench: Bench, path: str) -> None:
    smoke = puffs(PUFFS)
    write = partial(volume.write_smoke, path, smoke, SMOKE_VOXEL)
    frame = write()
    wrong = abs(frame.mass / float(np.sum(smoke.mass)) - 1)
    tools = [Runner(OURS, write, threads, wrong) for threads in (1, 2)]
    case, voxels = f"smoke of {PUFFS:,} puffs", frame.active_voxels
    found = bench.race(case, tools, voxels, "voxel", "of the mass")
    speed = found[tools[1].label].speed(voxels / 1e6)
    bench.target("a frame of smoke is built and written, on two threads, at", speed, MEGAVOXELS, "Mvoxel/s")
    bench.target("mass of smoke off by", wrong, 1e-6, "", most=True)
