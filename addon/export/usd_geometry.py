"""USD geometry from arrays: meshes, bounding boxes, vectors and rotations."""

from __future__ import annotations

from typing import Any

import numpy as np
from pxr import Gf, UsdGeom, Vt


def define_mesh(stage: Any, path: str, points: np.ndarray, triangles: np.ndarray, normals: np.ndarray) -> Any:
    """Define a mesh of triangles with its extent, which is not subdivided.

    Parameters
    ----------
    normals
        Normals of the points (n, 3), or of the triangles (m, 3).
    """
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(vectors(points))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray(len(triangles), 3))
    indices = np.ascontiguousarray(triangles, np.int32).ravel()
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(indices))
    mesh.CreateNormalsAttr(vectors(normals))
    of_points = len(normals) == len(points)
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex if of_points else UsdGeom.Tokens.uniform)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateExtentAttr(extent(points))
    return mesh


def extent(points: np.ndarray, reach: np.ndarray | float = 0.0) -> Any:
    """Return the bounding box of points (n, 3) with spheres of radius `reach` around them."""
    if not len(points):
        return Vt.Vec3fArray([Gf.Vec3f(0.0), Gf.Vec3f(0.0)])
    low, high = (points - reach).min(axis=0), (points + reach).max(axis=0)
    return Vt.Vec3fArray([Gf.Vec3f(*map(float, low)), Gf.Vec3f(*map(float, high))])


def half_quaternions(rotation: np.ndarray) -> Any:
    """Convert unit quaternions (n, 4), w, x, y, z, to half precision."""
    flat = np.ascontiguousarray(rotation[:, [1, 2, 3, 0]], np.float16)  # in memory the real part comes last
    return Vt.QuathArray.FromNumpy(flat)


def vectors(values: np.ndarray) -> Any:
    """Convert vectors (n, 3) to single precision."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, np.float32))


def set_indexed(primvar: Any, values: Any, indices: np.ndarray) -> None:
    """Set a primvar by its different values, and the index of each element's value."""
    primvar.Set(values)
    primvar.SetIndices(Vt.IntArray.FromNumpy(np.ascontiguousarray(indices, np.int32)))
