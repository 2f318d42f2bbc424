"""Plumes of steady sources in the solved flow, and what theory says of them.

In a uniform wind U and stable air (s = g / theta dtheta/dz) a plume of the buoyancy flux F settles at
2.6 (F / (U s))^(1/3) (Briggs 1975, "Plume rise predictions", in Lectures on Air Pollution and Environmental
Impact Analyses). That is of a point: one that begins with the radius R0 at the height h0 has its radius
R0 + beta z, and the same equations give (z + R0 / beta)^3 = rise^3 + (R0 / beta)^3 above h0, beta = 0.6
(Briggs 1984, "Plume rise and buoyancy effects", in Atmospheric Science and Power Production). R0 is that of
the area which the wind blows through at the source: its width times twice the depth h0 that heat goes in.

In calm air its top is at 5.0 F^(1/4) s^(-3/8), and it has no more buoyancy at 2.13 / 2.8 of that (Morton,
Taylor and Turner 1956, "Turbulent gravitational convection from maintained and instantaneous sources", Proc.
R. Soc. A 234; the number is Briggs's, 1969). A wide source without momentum is soon as a point's plume (Hunt
and Kaye 2001, "Virtual origin correction for lazy turbulent plumes", J. Fluid Mech. 435): nothing is allowed
for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray

CP, GRAVITY, THETA = 1004.7, 9.80665, 300.0
ENTRAINMENT = 0.6  # Briggs's beta: a bent plume's radius over its rise
GRADIENT = 0.01  # K/m
LAST = 700.0  # s that a plume is followed
STEP = 0.05  # s for each metre of the cells

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plume:
    """Heights over what theory says, the height (m) below which 99 % of the smoke is, and its account."""

    rise: float
    layer: float
    top: float
    mass: dict[str, float]


def still_air(
    shape: tuple[int, int], spacing: float, lid: float, depth: float, wind: float, **options: Any
) -> flow.Solver:
    """Air of one stability, `GRADIENT`, and one wind east, m/s, in even levels of about `depth` m."""
    levels = np.linspace(0, lid, round(lid / depth) + 1)
    theta = [THETA, THETA + GRADIENT * lid]
    return flow.Solver(levels, shape, spacing, [0.0, lid], theta, [[wind, 0.0]] * 2, **options)


def power_of(flux: float, solver: flow.Solver) -> float:
    """Heat, W, of a buoyancy flux F (m4/s3, Briggs's: without pi)."""
    return float(flux * np.pi * CP * solver.density[0] * THETA / GRAVITY)


def disc(radius: float) -> Array:
    """Places (n, 2) 25 m apart within `radius` of the origin."""
    grid = np.arange(-radius, radius + 1, 25.0)
    places = np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2)
    return places[np.hypot(*places.T) <= radius]


def bent(
    spacing: float, wind: float = 10.0, rise: float = 1000.0, depth: float = 90.0, radius: float = 0.0
) -> Plume:
    """A plume of a point, which is a cell wide, or of a disc of `radius` m, in a wind; and Briggs.

    `rise` is a point's, m. Its height is the mean of the smoke from 2.5 to 4.5 km downwind.
    """
    shape = (round(4000 / spacing), round(7600 / spacing))
    solver = still_air(shape, spacing, 2400.0, 60.0 * max(1.0, spacing / 100), wind, source_depth=depth)
    stability = GRAVITY / THETA * GRADIENT
    x = (round(1800 / spacing) + 0.5) * spacing
    _burn(
        solver,
        disc(radius) + np.array([x, (shape[0] // 2 + 0.5) * spacing]),
        (rise / 2.6) ** 3 * wind * stability,
    )
    start = np.sqrt(2 * depth * max(spacing, 2 * radius) / np.pi) / ENTRAINMENT
    expected = (rise**3 + start**3) ** (1 / 3) - start + depth
    downwind = (np.arange(shape[1]) + 0.5) * spacing - x
    smoke = _by_level(solver, (downwind > 2500) & (downwind < 4500))
    height = float(np.sum(smoke * _middles(solver)) / smoke.sum())
    return Plume(height / expected, np.nan, _below(solver, smoke), solver.mass())


def calm(spacing: float, side: float = 3600.0, rise: float = 1500.0, radius: float = 150.0) -> Plume:
    """A plume of a disc in calm air whose top theory has at `rise` m, in a box of `side` m; and theory.

    Its top is the height below which 99 % of the smoke is, its layer the level with most of it.
    """
    n = round(side / spacing)
    solver = still_air(
        (n, n), spacing, 3000.0, 50.0, 0.0,
        source_depth=50.0, gust_strength=0.6, gust_size=100.0, gust_time=20.0, top=0.1,
    )  # fmt: skip
    flux = (rise / 5.0) ** 4 * (GRAVITY / THETA * GRADIENT) ** 1.5
    _burn(solver, disc(radius) + n * spacing / 2, flux)
    smoke = _by_level(solver, slice(None))
    top, layer = _below(solver, smoke), float(_middles(solver)[solver.smoke().sum((1, 2)).argmax()])
    return Plume(top / rise, layer / (2.13 / 2.8 * rise), top, solver.mass())


def unbalanced(mass: dict[str, float]) -> float:
    """Smoke that is neither in the air nor has left, over what was given off."""
    return abs((mass["airborne"] + mass["left"]) / mass["emitted"] - 1.0)


def _burn(solver: flow.Solver, place: Array, flux: float) -> None:
    n = len(place)
    solver.set_sources(place, np.full(n, power_of(flux, solver) / n), np.full(n, 10.0 / n))
    step = STEP * solver.spacing
    solver.step(step, round(LAST / step))


def _middles(solver: flow.Solver) -> Array:
    return 0.5 * (solver.levels[1:] + solver.levels[:-1])


def _by_level(solver: flow.Solver, columns: Any) -> Array:
    """Smoke (nz,) of each level in some columns, in any unit."""
    return solver.smoke()[:, :, columns].sum((1, 2), dtype=float) * np.diff(solver.levels)


def _below(solver: flow.Solver, smoke: Array) -> float:
    """The height below which 99 % of the smoke (nz,) is, m."""
    share = np.cumsum(smoke)
    return float(np.interp(0.99, share / share[-1], solver.levels[1:]))
