"""Terrain mesh of the sample's DEM: vertices and time against vertical error, compared with coarser grids."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core import run as runs
from firetwin_core import terrain
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from ..data import sample
from .harness import ORIGIN, OURS, Bench
from .timing import Runner

ERRORS = (2.0, 8.0)  # m
STEPS = (4, 8)  # step along both axes of the grid's points that are retained


def relief() -> NDArray[np.float32]:
    """Return the points (720, 720, 3) of the sample's fuel grid, rows to the north, m."""
    with tempfile.TemporaryDirectory() as name:
        sample.write(Path(name) / "run", 3, "npy")
        run = runs.open(Path(name) / "run")
        north, east = np.argsort(run.fuel_latitude), np.argsort(run.fuel_longitude)
        height = np.asarray(run.fuel_elevation)[np.ix_(north, east)]
        axes = run.fuel_latitude[north], run.fuel_longitude[east]
    return LocalFrame(*ORIGIN).forward_grid(*axes, height).astype(np.float32)


def off(place: NDArray, mesh: tuple[NDArray, NDArray, NDArray]) -> float:
    """Return the largest vertical distance (m) of a mesh from a point of the grid, batched by triangle size.

    Rows and columns, whose lines are slightly curved, are taken as axes: the result is 0.2 % larger than in
    metres.
    """
    row, column = (axis.astype(np.int64) for axis in mesh[:2])
    z, corners = place[..., 2].astype(np.float64), mesh[2]
    y, x = row[corners], column[corners]
    low, left = y.min(1), x.min(1)
    height, width = y.max(1) - low, x.max(1) - left
    worst = 0.0
    for size in np.unique(np.stack([height, width], -1), axis=0):
        j, i = (v.ravel() for v in np.mgrid[: size[0] + 1, : size[1] + 1])
        same = np.flatnonzero((height == size[0]) & (width == size[1]))
        for some in np.array_split(same, max(len(same) * len(i) // 1_000_000, 1)):
            at = low[some, None] + j, left[some, None] + i
            (y0, y1, y2), (x0, x1, x2) = (v[some].T[..., None] for v in (y, x))
            area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
            b = ((at[1] - x0) * (y2 - y0) - (at[0] - y0) * (x2 - x0)) / area
            c = ((at[0] - y0) * (x1 - x0) - (at[1] - x0) * (y1 - y0)) / area
            z0, z1, z2 = z[y[some].T, x[some].T][..., None]
            gap = np.abs(z0 + b * (z1 - z0) + c * (z2 - z0) - z[at])
            worst = max(worst, np.max(gap, initial=0.0, where=(b >= 0.0) & (c >= 0.0) & (b + c <= 1.0)))
    return float(worst)


def every(place: NDArray, step: int) -> tuple[int, float]:
    """Return the number of vertices of a grid of every `step`-th point, and its largest error (m)."""
    rows, columns = (np.unique([*range(0, count, step), count - 1]) for count in place.shape[:2])
    number = np.arange(len(rows) * len(columns)).reshape(len(rows), len(columns))
    low, right, top, left = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    halves = (low, right, top), (low, top, left)
    triangle = np.concatenate([np.stack(half, -1).reshape(-1, 3) for half in halves])
    column, row = np.meshgrid(columns.astype(float), rows.astype(float))
    return len(rows) * len(columns), off(place, (row.ravel(), column.ravel(), triangle))


def run(bench: Bench) -> None:
    """Measure two meshes, then two grids."""
    place = relief()
    worst = 0.0
    for most in ERRORS:
        tolerance = np.full(place.shape[:2], most, np.float32)
        make = partial(terrain.mesh, place, tolerance)
        mesh = make()
        error = off(place, mesh)
        worst = max(worst, error / most)
        bench.race(f"at most {most:g} m", [Runner(OURS, make, error=error)], len(mesh[0]), "vertex", "m")
    for step in STEPS:
        vertices, error = every(place, step)
        bench.row(f"every {step} points", "grid", None, vertices, "vertex", error=error, error_unit="m")
    bench.target("Largest mesh error / tolerance", worst, 1.002, "", most=True)
