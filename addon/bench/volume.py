"""Smoke -> OpenVDB files, beside the openvdb module that Blender brings along."""

from __future__ import annotations

import os
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from .harness import OURS, Bench, threads

SIDES = (36, 144, 288)
VOXEL = 20.0  # m
PUFFS, SMOKE_VOXEL = 1000, 50.0  # m


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
        for number in (1, 2):
            _boxes(bench, path, number)
            _smoke(bench, path, number)


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

    case, unit = f"{side} x {side} x {side // 3} array", "voxel"
    for number in (1, 2):
        with threads(number):
            seconds = bench.best(ours, 5)
        wrong = abs(ours().mass / exact - 1)
        bench.row(case, OURS, seconds, voxels, unit, error=wrong, error_unit="of the mass", threads=number)
        if side == SIDES[-1] and number == 1:
            bench.target("array built and written", voxels / seconds / 1e6, 30, "Mvoxel/s")
            bench.target("mass kept within", wrong, 1e-6, "", most=True)
    if openvdb:
        bench.row(case, "openvdb (Python)", bench.best(theirs, 5), voxels, unit)


def _boxes(bench: Bench, path: str, number: int) -> None:
    """Several fields of one box, as a solved flow gives them; the voxels of all fields are counted."""
    side = SIDES[-1]
    density = plume(side)
    warm = np.where(density > 0, 300 + 1e5 * density, 0).astype(np.float32)
    fields = {"density": density, "tint": density * np.float32(5e3), "temperature": warm}
    with threads(number):
        seconds = bench.best(lambda: volume.write(path, fields, VOXEL), 5)
        frame = volume.write(path, fields, VOXEL)
    exact = float(density.sum(dtype=np.float64)) * VOXEL**3
    bench.row(
        f"{len(fields)} fields of {side} x {side} x {side // 3}",
        OURS,
        seconds,
        frame.voxels,
        "voxel",
        error=abs(frame.mass / exact - 1),
        error_unit="of the mass",
        threads=number,
    )
    if number == 2:
        speed = frame.voxels / seconds / 1e6
        bench.target("several fields built and written on two threads", speed, 45, "Mvoxel/s")


def _smoke(bench: Bench, path: str, number: int) -> None:
    smoke = puffs(PUFFS)
    with threads(number):
        seconds = bench.best(lambda: volume.write_smoke(path, smoke, SMOKE_VOXEL), 3)
        frame = volume.write_smoke(path, smoke, SMOKE_VOXEL)
    exact = float(np.sum(smoke.mass))
    wrong = abs(frame.mass / exact - 1)
    bench.row(
        f"smoke of {PUFFS:,} puffs",
        OURS,
        seconds,
        frame.active_voxels,
        "voxel",
        error=wrong,
        error_unit="of the mass",
        threads=number,
    )
    if number == 2:
        bench.target("smoke frame on two threads", frame.active_voxels / seconds / 1e6, 30, "Mvoxel/s")
        bench.target("smoke keeps its mass within", wrong, 1e-6, "", most=True)
