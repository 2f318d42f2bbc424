"""Smoke files, read by Blender's OpenVDB."""

import numpy as np
import pytest


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
