"""Latitude, longitude, height -> local east-north-up, beside NumPy, pymap3d and pyproj."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from firetwin_core.geo import LocalFrame
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner, Times

GRID, SCATTERED = f"{OURS} (grid)", f"{OURS} (scattered)"
ORIGIN = (38.93, -120.55, 0.0)
SIDES = (36, 144, 720, 2880)
CHECKED = 200
A, F = 6378137.0, 1 / 298.257223563  # WGS84
PIPELINE = (
    "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart +ellps=WGS84 "
    "+step +proj=topocentric +ellps=WGS84 +lat_0={} +lon_0={} +h_0={}"
)
Points = tuple[NDArray, NDArray, NDArray]


def numpy_enu(
    latitude: NDArray, longitude: NDArray, height: NDArray, origin: tuple[float, ...] = ORIGIN
) -> NDArray:
    """The closed form, vectorised: degrees, degrees, metres (n,) -> (n, 3) metres about `origin`."""
    e2 = F * (2 - F)

    def polar(latitude: Any, height: Any) -> tuple[Any, Any]:
        """Distance from the axis and height over the equator, m."""
        sine, cosine = np.sin(latitude), np.cos(latitude)
        normal = A / np.sqrt(1 - e2 * sine * sine)
        return (normal + height) * cosine, (normal * (1 - e2) + height) * sine

    latitude0 = np.radians(origin[0])
    r0, z0 = polar(latitude0, origin[2])
    r, z = polar(np.radians(latitude), height)
    turn = np.radians(longitude - origin[1])
    dr, dz = r * np.cos(turn) - r0, z - z0
    sine, cosine = np.sin(latitude0), np.cos(latitude0)
    return np.stack([r * np.sin(turn), cosine * dz - sine * dr, sine * dz + cosine * dr], axis=-1)


def error(points: Points, enu: NDArray) -> float | None:
    """Largest error (m) of any component of CHECKED points against 50-digit arithmetic."""
    try:
        import mpmath
    except ImportError:
        return None
    every = max(1, len(enu) // CHECKED)
    worst = mpmath.mpf(0)
    with mpmath.workdps(50):
        for lat, lon, h, found in zip(*(p[::every] for p in points), enu[::every], strict=True):
            for a, b in zip(_exact(mpmath, lat, lon, h), found, strict=True):
                worst = max(worst, abs(a - mpmath.mpf(float(b))))
    return float(worst)


def _exact(mp: Any, lat: float, lon: float, h: float) -> list:
    f = 1 / mp.mpf("298.257223563")
    e2 = f * (2 - f)

    def centred(lat: float, lon: float, h: float) -> tuple:
        phi, lam = mp.radians(mp.mpf(float(lat))), mp.radians(mp.mpf(float(lon)))
        n = mp.mpf(A) / mp.sqrt(1 - e2 * mp.sin(phi) ** 2)
        r = (n + mp.mpf(float(h))) * mp.cos(phi)
        return r * mp.cos(lam), r * mp.sin(lam), (n * (1 - e2) + mp.mpf(float(h))) * mp.sin(phi)

    x, y, z = (a - b for a, b in zip(centred(lat, lon, h), centred(*ORIGIN), strict=True))
    phi, lam = mp.radians(mp.mpf(ORIGIN[0])), mp.radians(mp.mpf(ORIGIN[1]))
    out = mp.cos(lam) * x + mp.sin(lam) * y
    north, up = mp.cos(phi) * z - mp.sin(phi) * out, mp.cos(phi) * out + mp.sin(phi) * z
    return [mp.cos(lam) * y - mp.sin(lam) * x, north, up]


def rivals(bench: Bench) -> dict[str, Callable[[Points], NDArray]]:
    """What else takes scattered points."""
    tools: dict[str, Callable[[Points], NDArray]] = {"NumPy": lambda points: numpy_enu(*points)}
    if pymap3d := bench.rival("pymap3d"):
        tools["pymap3d"] = lambda p: np.stack(pymap3d.geodetic2enu(*p, *ORIGIN), axis=-1)
    if pyproj := bench.rival("pyproj"):
        transform = pyproj.Transformer.from_pipeline(PIPELINE.format(*ORIGIN)).transform
        tools["pyproj"] = lambda p: np.stack(transform(p[1], p[0], p[2]), axis=-1)
    return tools


def run(bench: Bench) -> None:
    """Grids of growing size; the rivals know no grids and get every point."""
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
        if side <= 720 or bench.full:
            calls |= {tool: partial(call, points) for tool, call in others.items()}
            runners += [Runner(tool, calls[tool], error=_wrong(points, calls[tool])) for tool in others]
        found = bench.race(f"{side} x {side}", runners, side * side, "point", "m")
        if side == 720:
            _targets(bench, found, side * side, {runner.label: runner.error for runner in runners})


def _wrong(points: Points, call: Callable[[], NDArray]) -> float | None:
    return error(points, call().reshape(-1, 3))


def _targets(bench: Bench, found: dict[str, Times], points: int, wrong: dict[str, float | None]) -> None:
    for tool, what in ((GRID, "points of a grid"), (SCATTERED, "scattered points")):
        if (metres := wrong[tool]) is not None:
            bench.target(
                f"largest error of {what}, against 50-digit arithmetic", metres * 1e9, 5, "nm", most=True
            )
    each = [seconds / points * 1e9 for seconds in found[GRID].seconds]
    bench.target("a point of a grid takes", each, 5, "ns", most=True)
    for tool in ("pymap3d", "pyproj"):
        if tool in found:
            bench.target(
                f"speed of placing a grid's points, over {tool}'s",
                found[GRID].faster_than(found[tool]),
                15,
                "x",
            )
