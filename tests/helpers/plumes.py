"""Burning cells, their smoke, and smoke files read by Blender's OpenVDB."""

import numpy as np
import pytest
from firetwin_core import volume

CELL = 74.0
HEAT = 17.433e6


def burn(count=60, seed=3):
    """Cells along a front that moves east for an hour."""
    random = np.random.default_rng(seed)
    arrival = np.sort(random.uniform(0.0, 3600.0, count))
    position = np.column_stack([arrival * 0.8, random.uniform(-400.0, 400.0, count), np.full(count, 1000.0)])
    return arrival, random.uniform(1.0, 4.0, count), position


def smoke(time, wind=(6.0, 3.0), cells=None, **settings):
    return volume.puffs(time, *(cells or burn()), wind, CELL**2, **settings)


def steady(power=2.0e10, until=7200.0):
    """One source of constant power: a cell that burns all the time."""
    fuel = power * until / (HEAT * CELL**2)
    return np.array([0.0]), np.array([fuel]), np.array([[0.0, 0.0, 500.0]])


def briggs(power, wind10, stability):
    """Final plume rise, transcribed from Briggs (1984) with the constants of the documentation."""
    flux = 9.80665 * 0.7 * power / (np.pi * 1005.0 * 1.2 * 290.0)
    wind = wind10 * (300.0 / 10.0) ** 0.1
    return 2.6 * (flux / (wind * stability)) ** (1.0 / 3.0)


def read(path):
    """Read name -> dense array and lowest voxel, with Blender's OpenVDB."""
    bpy = pytest.importorskip("bpy")
    bpy.utils.expose_bundled_modules()
    import openvdb

    grids = {}
    for grid in openvdb.readAllGridMetadata(str(path)):
        full = openvdb.read(str(path), grid.name)
        low, high = (np.array(corner) for corner in full.evalActiveVoxelBoundingBox())
        dense = np.zeros(np.maximum(high - low + 1, 0), np.float32)
        if dense.size:
            full.copyToArray(dense, ijk=tuple(int(v) for v in low))
        grids[grid.name] = (dense, low)
    return grids
