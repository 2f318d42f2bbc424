"""Smoke as a solved flow: rise of a steady plume against theory, convergence with cell size, and step time.

In a uniform wind U and stable air (s = g / theta dtheta/dz) a plume of the buoyancy flux F settles at
2.6 (F / (U s))^(1/3) (Briggs 1975, "Plume rise predictions", in Lectures on Air Pollution and Environmental
Impact Analyses). That holds for a point source. A source of radius R0 at the height h0 has the plume radius
R0 + beta z, and the same equations give (z + R0 / beta)^3 = rise^3 + (R0 / beta)^3 above h0, beta = 0.6
(Briggs 1984, "Plume rise and buoyancy effects", in Atmospheric Science and Power Production). R0 belongs to
the source's cross-section to the wind: its width times twice the depth h0 over which heat is released.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from firetwin_core import constants, flow
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner, threads

CP, GRAVITY, THETA = constants.SPECIFIC_HEAT, constants.GRAVITY, 300.0
ENTRAINMENT = 0.6  # Briggs's entrainment coefficient beta: a bent plume's radius over its rise
GRADIENT = 0.01  # K/m
LAST = 700.0  # s of simulated time of a plume
STEP = 0.05  # s of time step per metre of the cells
COARSE, FINE = 200.0, 100.0  # m
DISC = 150.0  # m, radius of the source in the study of cell sizes
THREADS = 2
BOX, CELLS, DT = (44, 96, 96), 200.0, 10.0  # levels, rows, columns; m; s
WIND, LAPSE = (8.0, 3.0), 0.004  # m/s, K/m
POWER, SMOKE = 2e10, 1.2e-9  # W, kg/J

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plume:
    """Rise / theoretical rise, height (m) below which 99 % of the smoke is, and mass balance."""

    rise: float
    top: float
    mass: dict[str, float]


def run(bench: Bench) -> None:
    """Measure the error against theory, the error between grids, and the speed."""
    with threads(THREADS):
        quantity = "Rise of a steady plume in stable air and 10 m/s of wind, deviation from Briggs"
        bench.target(quantity, off(bent(FINE).rise), 15, "%", most=True)
        _grids(bench)
    _speed(bench)


def _grids(bench: Bench) -> None:
    """Compare the same plume in coarse and fine cells."""
    coarse, fine = (bent(spacing, radius=DISC) for spacing in (COARSE, FINE))
    for spacing, plume in ((COARSE, coarse), (FINE, fine)):
        tool = f"{OURS}, cells of {spacing:g} m"
        error = off(plume.rise)
        bench.row("plume of a disc in 10 m/s", tool, None, 1, "plume", error=error, error_unit="% off Briggs")
    quantity = f"Top of a plume from a disc, cells of {COARSE:g} m against {FINE:g} m, deviation"
    bench.target(quantity, off(coarse.top / fine.top), 15, "%", most=True)
    worst = max(unbalanced(each.mass) for each in (coarse, fine))
    quantity = "Smoke mass balance (airborne + outflow - emission), relative error, both cell sizes"
    bench.target(quantity, worst, 1e-6, "", most=True)


def _speed(bench: Bench) -> None:
    levels, rows, columns = BOX
    step, cells = partial(burning(BOX).step, DT), levels * rows * columns
    tools = [Runner(OURS, step), Runner(OURS, step, threads=2)]
    times = bench.race(f"step of {rows} x {columns} x {levels} cells", tools, cells, "cell step")
    speed = times[OURS].speed(cells / 1e6)
    bench.target("Solver speed, one thread", speed, 1.0, "Mcell/s")


def burning(shape: tuple[int, int, int]) -> flow.Solver:
    """Create a flow over a fire that has burned for two minutes, with the vertical levels of a shot."""
    k = np.arange(shape[0] + 1)
    levels = 60.0 * k + 0.5 * 210.0 / shape[0] * k * k  # m: 60 deep at the ground, 270 at the top
    theta = [300.0, 300.0 + LAPSE * levels[-1]]
    profile = flow.Profile([0.0, levels[-1]], theta, [WIND] * 2)
    solver = flow.Solver(flow.Domain(levels, shape[1:], CELLS), profile)
    size = np.array(shape[:0:-1]) * CELLS
    place = np.random.default_rng(0).uniform([0.35, 0.4], [0.5, 0.45], (400, 2)) * size
    share = np.full(400, POWER / 400)
    solver.set_sources(place, share, SMOKE * share)
    solver.step(DT, 12)
    return solver


def still_air(
    shape: tuple[int, int], spacing: float, lid: float, depth: float, wind: float, **settings: Any
) -> flow.Solver:
    """Create air of stability `GRADIENT` and eastward wind, m/s, in equal levels of about `depth` m."""
    levels = np.linspace(0, lid, round(lid / depth) + 1)
    theta = [THETA, THETA + GRADIENT * lid]
    profile = flow.Profile([0.0, lid], theta, [[wind, 0.0]] * 2)
    return flow.Solver(flow.Domain(levels, shape, spacing), profile, flow.SolverSettings(**settings))


def power_of(flux: float, solver: flow.Solver) -> float:
    """Return the heat release, W, of a buoyancy flux F (m4/s3; Briggs's, without pi)."""
    return float(flux * np.pi * CP * solver.density[0] * THETA / GRAVITY)


def disc(radius: float) -> Array:
    """Return points (n, 2) 25 m apart within `radius` of the origin."""
    grid = np.arange(-radius, radius + 1, 25.0)
    places = np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2)
    return places[np.hypot(*places.T) <= radius]


def bent(
    spacing: float, wind: float = 10.0, rise: float = 1000.0, depth: float = 90.0, radius: float = 0.0
) -> Plume:
    """Compare with Briggs a bent-over plume from a point, which is a cell wide, or from a disc of `radius` m.

    `rise` is the rise above a point source, m. The height of the plume is the mean of the smoke from 2.5 to
    4.5 km downwind.
    """
    shape = (round(4000 / spacing), round(7600 / spacing))
    solver = still_air(shape, spacing, 2400.0, 60.0 * max(1.0, spacing / 100), wind, source_depth=depth)
    stability = GRAVITY / THETA * GRADIENT
    x = (round(1800 / spacing) + 0.5) * spacing
    burn(
        solver,
        disc(radius) + np.array([x, (shape[0] // 2 + 0.5) * spacing]),
        (rise / 2.6) ** 3 * wind * stability,
    )
    start = np.sqrt(2 * depth * max(spacing, 2 * radius) / np.pi) / ENTRAINMENT
    expected = (rise**3 + start**3) ** (1 / 3) - start + depth
    downwind = (np.arange(shape[1]) + 0.5) * spacing - x
    smoke = by_level(solver, (downwind > 2500) & (downwind < 4500))
    height = float(np.sum(smoke * middles(solver)) / smoke.sum())
    return Plume(height / expected, below(solver, smoke), solver.mass())


def unbalanced(mass: dict[str, float]) -> float:
    """Return the mass balance error: (airborne + outflow - emission) / emission."""
    return abs((mass["airborne"] + mass["left"]) / mass["emitted"] - 1.0)


def burn(solver: flow.Solver, place: Array, flux: float) -> None:
    """Integrate the plume of a buoyancy flux that is released evenly at these points."""
    n = len(place)
    solver.set_sources(place, np.full(n, power_of(flux, solver) / n), np.full(n, 10.0 / n))
    step = STEP * solver.spacing
    solver.step(step, round(LAST / step))


def middles(solver: flow.Solver) -> Array:
    """Return the heights (nz,) of the levels' centres, m."""
    return 0.5 * (solver.levels[1:] + solver.levels[:-1])


def by_level(solver: flow.Solver, columns: Any) -> Array:
    """Sum the smoke of each level (nz,) over some columns, in arbitrary units."""
    return solver.smoke()[:, :, columns].sum((1, 2), dtype=float) * np.diff(solver.levels)


def below(solver: flow.Solver, smoke: Array) -> float:
    """Return the height below which 99 % of the smoke (nz,) is, m."""
    share = np.cumsum(smoke)
    return float(np.interp(0.99, share / share[-1], solver.levels[1:]))


def off(ratio: float) -> float:
    """Return the deviation from 1, percent."""
    return 100.0 * abs(ratio - 1.0)
