"""Latitude, longitude, height -> local east-north-up, compared with pymap3d and pyproj."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from firetwin.bench.harness import ORIGIN, OURS, Bench
from firetwin.bench.timing import Runner, Times
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

GRID, SCATTERED = f"{OURS} (grid)", f"{OURS} (scattered)"
SIDES = (36, 144, 720)
CHECKED = 200
PIPELINE = (
    "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 "
    "+step +proj=topocentric +ellps=WGS84 +lat_0={} +lon_0={} +h_0={}"
)
Points = tuple[NDArray, NDArray, NDArray]


def error(points: Points, enu: NDArray) -> float | None:
    """Return the largest error (m) of any component of CHECKED points against 50-digit arithmetic."""
    try:
        from geodesy import enu_exact
    except ImportError:  # of mpmath
        return None
    every = max(1, len(enu) // CHECKED)
    some = np.stack([axis[::every] for axis in points], axis=-1).tolist()
    worst = 0.0
    for point, found in zip(some, enu[::every].tolist(), strict=True):
        worst = max(
            worst, *(abs(float(a - b)) for a, b in zip(enu_exact(*point, ORIGIN), found, strict=True))
        )
    return worst


def rivals(bench: Bench) -> dict[str, Callable[[Points], NDArray]]:
    """Return the other tools for scattered points."""
    tools: dict[str, Callable[[Points], NDArray]] = {}
    if pymap3d := bench.rival("pymap3d"):
        tools["pymap3d"] = lambda p: np.stack(pymap3d.geodetic2enu(*p, *ORIGIN), axis=-1)
    if pyproj := bench.rival("pyproj"):
        transform = pyproj.Transformer.from_pipeline(PIPELINE.format(*ORIGIN)).transform
        tools["pyproj"] = lambda p: np.stack(transform(p[1], p[0], p[2]), axis=-1)
    return tools


def run(bench: Bench) -> None:
    """Measure grids of growing size; the other tools have no grids and receive every point."""
    frame = LocalFrame(*ORIGIN)
    others = rivals(bench)
    for side in SIDES:
        latitude = np.linspace(38.4, 39.2, side)
        longitude = np.linspace(-121.1, -120.1, side)
        height = np.random.default_rng(2).uniform(200, 3000, (side, side))
        points = np.repeat(latitude, side), np.tile(longitude, side), height.ravel()
        calls: dict[str, Callable[[], NDArray]] = {
            GRID: partial(frame.forward_grid, latitude, longitude, height),
            SCATTERED: partial(frame.forward, *points),
        }
        runners = [
            Runner(tool, call, threads, _wrong(points, call))
            for tool, call in calls.items()
            for threads in (1, 2)
        ]
        calls |= {tool: partial(call, points) for tool, call in others.items()}
        runners += [Runner(tool, calls[tool], error=_wrong(points, calls[tool])) for tool in others]
        found = bench.race(f"{side} x {side}", runners, side * side, "point", "m")
        if side == 720:
            _targets(bench, found, side * side, {runner.label: runner.error for runner in runners})


def _wrong(points: Points, call: Callable[[], NDArray]) -> float | None:
    return error(points, call().reshape(-1, 3))


def _targets(bench: Bench, times: dict[str, Times], points: int, wrong: dict[str, float | None]) -> None:
    for tool, points_of in ((GRID, "points of a grid"), (SCATTERED, "scattered points")):
        if (metres := wrong[tool]) is not None:
            quantity = f"Largest error against 50-digit arithmetic, {points_of}"
            bench.target(quantity, metres * 1e9, 5, "nm", most=True)
    each = [seconds / points * 1e9 for seconds in times[GRID].seconds]
    bench.target("Time per point of a grid", each, 5, "ns", most=True)
    for tool in ("pymap3d", "pyproj"):
        if tool in times:
            bench.target(
                f"Speed on the points of a grid / {tool}",
                times[GRID].faster_than(times[tool]),
                15,
                "x",
            )
