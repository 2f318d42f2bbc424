"""Conservation of smoke, shape and heat in the solved flow; and a plume in calm air against theory.

In calm air the top of a plume is at 5.0 F^(1/4) s^(-3/8), and its buoyancy vanishes at 2.13 / 2.8 of that
(Morton, Taylor and Turner 1956, "Turbulent gravitational convection from maintained and instantaneous
sources", Proc. R. Soc. A 234; the number is Briggs's, 1969). A wide source without momentum soon behaves as a
point source (Hunt and Kaye 2001, "Virtual origin correction for lazy turbulent plumes", J. Fluid Mech. 435),
so it needs no correction.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from firetwin.bench.flow import (
    GRADIENT,
    GRAVITY,
    THETA,
    THREADS,
    below,
    burn,
    by_level,
    disc,
    middles,
    off,
    still_air,
    unbalanced,
)
from firetwin.bench.harness import Bench
from firetwin.bench.timing import threads
from firetwin.smoke import snapshots
from firetwin_core import flow
from numpy.typing import NDArray

CELLS = 75.0  # m, of the plume in calm air
ROOM = np.linspace(0.0, 2000.0, 21), (48, 64), 100.0  # levels, rows and columns, m: for conservation


def run(bench: Bench) -> None:
    """Measure a plume in calm air, then conservation."""
    with threads(THREADS):
        top, layer = calm(CELLS)
        theory = f"calm air, cells of {CELLS:g} m, deviation from Morton, Taylor and Turner"
        bench.target(f"Plume top in {theory}", off(top), 15, "%", most=True)
        bench.target(f"Spreading height in {theory}", off(layer), 25, "%", most=True)
        _measure_conservation(bench)


def calm(
    spacing: float, side: float = 3600.0, rise: float = 1500.0, radius: float = 150.0
) -> tuple[float, float]:
    """Return top and spreading height of a plume from a disc in calm air / theory, with its top at `rise` m.

    The box is `side` m wide. The top is the height below which 99 % of the smoke is, the spreading
    height is the level with most of it.
    """
    n = round(side / spacing)
    solver = still_air(
        (n, n), spacing, 3000.0, 50.0, 0.0,
        source_depth=50.0, gust_strength=0.6, gust_size=100.0, gust_time=20.0, damping_share=0.1,
    )  # fmt: skip
    flux = (rise / 5.0) ** 4 * (GRAVITY / THETA * GRADIENT) ** 1.5
    burn(solver, disc(radius) + n * spacing / 2, flux)
    smoke = by_level(solver, slice(None))
    top, layer = below(solver, smoke), float(middles(solver)[solver.smoke().sum((1, 2)).argmax()])
    return top / rise, layer / (2.13 / 2.8 * rise)


def _measure_conservation(bench: Bench) -> None:
    mass, shape, _ = advected()
    bench.target("Smoke mass under advection alone, relative change", mass, 1e-6, "", most=True)
    quantity = "Shape error of a ball of 4 cells' radius after 20 cells of advection"
    bench.target(quantity, 100 * shape, 8, "% of its mass", most=True)
    given, held = warmed()
    bench.target("Heat input against heat released by the fire, relative error", given, 1e-6, "", most=True)
    bench.target("Heat held against heat input, relative error", held, 1e-4, "", most=True)
    quantity = "Smoke mass balance (snapshot + outflow - emission), relative error"
    bench.target(quantity, written(), 1e-6, "", most=True)


def advected() -> tuple[float, float, flow.Solver]:
    """Return the change of mass and shape (sum of differences / sum) of a ball in steady wind, and the flow.

    The ball is a Gaussian of 4 cells' radius, advected 20 cells in 35 steps oblique to the rows.
    """
    solver = _room((10.0, 6.0), 0.0)
    state = solver.state()
    state["smoke"] = 1e-3 * _ball(solver, (2000.0, 1700.0, 1000.0))
    solver.restore(state)
    before = solver.mass()["airborne"]
    solver.step(5.0, 35)
    exact = 1e-3 * _ball(solver, (3750.0, 2750.0, 1000.0)) * solver.density[:, None, None]
    after = solver.mass()
    off = np.abs(solver.smoke().astype(float) - exact).sum() / exact.sum()
    return abs((after["airborne"] + after["left"]) / before - 1.0), float(off), solver


def warmed() -> tuple[float, float]:
    """Return the relative errors of heat input against heat release, and of heat held against heat input.

    The air is neutral. Heat raises potential temperature more at lower pressure; that is allowed for.
    """
    solver = _room((0.0, 0.0), 0.0, sponge_time=1e9, damping_time=1e9)
    _light(solver, 4e9)
    solver.step(5.0, 24)
    heat = solver.heat()
    return abs(heat["given"] / (4e9 * solver.time) - 1.0), abs(heat["held"] / heat["warmed"] - 1.0)


def written() -> float:
    """Return the mass balance error of a snapshot: smoke in its cells plus outflow against emission."""
    solver = _room((12.0, 3.0), 0.003, gust_strength=0.6)
    drift = flow.Drift(solver)
    _light(solver, 4e9)
    solver.step(5.0, 120)
    drift.advance()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "moment.npz"
        snapshots.save(path, solver, drift)
        moment = snapshots.load(path)
    smoke = moment.fields["smoke"].sum((1, 2), dtype=float)
    airborne = np.sum(smoke * np.diff(solver.levels)[: len(smoke)]) * solver.spacing**2
    return unbalanced(moment.mass | {"airborne": float(airborne)})


def _room(wind: tuple[float, float], lapse: float, **settings: float) -> flow.Solver:
    levels, shape, spacing = ROOM
    theta = [300.0, 300.0 + lapse * levels[-1]]
    profile = flow.Profile([0.0, levels[-1]], theta, [wind] * 2)
    return flow.Solver(flow.Domain(levels, shape, spacing), profile, flow.SolverSettings(**settings))


def _light(solver: flow.Solver, power: float) -> None:
    _, rows, columns = solver.shape
    place = solver.spacing * np.array([0.4 * columns + 0.2, 0.5 * rows - 0.3])
    solver.set_sources([place, place + solver.spacing], [0.7 * power, 0.3 * power], [8.0, 2.0])


def _ball(solver: flow.Solver, centre: tuple[float, float, float], radius: float = 400.0) -> NDArray:
    levels, (rows, columns), spacing = ROOM
    z, y, x = np.meshgrid(
        0.5 * (levels[1:] + levels[:-1]),
        (np.arange(rows) + 0.5) * spacing,
        (np.arange(columns) + 0.5) * spacing,
        indexing="ij",
    )
    away = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2
    return np.exp(-away / radius**2)
