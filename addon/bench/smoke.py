"""Smoke of one moment -> OpenVDB at several voxel sizes, and half beside single precision.

Mass and its error are those of the file, read back with the openvdb module that Blender brings along, where
there is one; else those that the core reports from before rounding to half precision.
"""

from __future__ import annotations

import os
import tempfile
from functools import partial
from types import ModuleType

import numpy as np
from firetwin_core import volume

from .harness import OURS, Bench
from .timing import Runner, label
from .volume import VOXEL, bundled_openvdb, plume, puffs

CELLS = 100
VOXELS = (400.0, 200.0, 100.0, 50.0)  # m
FINEST = 25.0  # m, in the full benchmark
DENSE = 144


def mass_in(openvdb: ModuleType, path: str, grid: str, unit: float) -> float:
    """Sum of a grid of the file times the volume of a voxel times `unit`."""
    found = openvdb.read(path, grid)
    low, high = found.evalActiveVoxelBoundingBox()
    values = np.zeros([b - a + 1 for a, b in zip(low, high, strict=True)], np.float32)
    found.copyToArray(values, ijk=low)
    voxel = np.prod(found.transform.voxelSize())
    return float(values.sum(dtype=float)) * float(voxel) * unit


def run(bench: Bench) -> None:
    """Voxel sizes, then precisions."""
    openvdb = bundled_openvdb(bench)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "smoke.vdb")
        _voxel_sizes(bench, path, openvdb)
        _precisions(bench, path, openvdb)


def _voxel_sizes(bench: Bench, path: str, openvdb: ModuleType | None) -> None:
    smoke = puffs(CELLS)
    exact = float(np.sum(smoke.mass))
    for voxel in (*VOXELS, FINEST) if bench.full else VOXELS:
        write = partial(volume.write_smoke, path, smoke, voxel)
        times = bench.time([Runner(OURS, write, threads=2)])
        frame = write()
        mass = mass_in(openvdb, path, "dilution", volume.FRESH_SMOKE) if openvdb else frame.mass
        bench.row(
            f"puffs of {CELLS} cells at {voxel:g} m",
            OURS,
            times[label(OURS, 2)],
            frame.active_voxels,
            "voxel",
            error=abs(mass / exact - 1),
            error_unit="of the mass",
            threads=2,
            bytes=frame.bytes,
        )


def _precisions(bench: Bench, path: str, openvdb: ModuleType | None) -> None:
    density = plume(DENSE)
    exact = float(density.sum(dtype=float)) * VOXEL**3
    halves = {"half": True, "single": False}
    writes = {
        name: partial(volume.write, path, {"density": density}, VOXEL, half=half)
        for name, half in halves.items()
    }
    times = bench.time([Runner(name, write) for name, write in writes.items()])
    for name, write in writes.items():
        frame = write()
        mass = mass_in(openvdb, path, "density", 1.0) if openvdb else frame.mass
        bench.row(
            f"dense array in {name} precision",
            OURS,
            times[name],
            frame.active_voxels,
            "voxel",
            error=abs(mass / exact - 1),
            error_unit="of the mass",
            bytes=frame.bytes,
        )
