"""What the solved flow keeps of smoke, its shape and heat; and a plume in calm air beside theory.

In calm air a plume's top is at 5.0 F^(1/4) s^(-3/8), and it has no more buoyancy at 2.13 / 2.8 of that
(Morton, Taylor and Turner 1956, "Turbulent gravitational convection from maintained and instantaneous
sources", Proc. R. Soc. A 234; the number is Briggs's, 1969). A wide source without momentum is soon as a
point's plume (Hunt and Kaye 2001, "Virtual origin correction for lazy turbulent plumes", J. Fluid Mech. 435):
nothing is allowed for it.
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
ROOM = np.linspace(0.0, 2000.0, 21), (48, 64), 100.0  # levels, rows and columns, m: for what is kept


def run(bench: Bench) -> None:
    """Theory in calm air, then accounts."""
    with threads(THREADS):
        top, layer = calm(CELLS)
        promise = (
            f"top of a plume in calm air, cells of {CELLS:g} m, off that of Morton, Taylor and Turner by"
        )
        bench.target(promise, off(top), 15, "%", most=True)
        promise = f"the layer that it spreads into there, cells of {CELLS:g} m, off theirs by"
        bench.target(promise, off(layer), 25, "%", most=True)
        _kept(bench)


def calm(
    spacing: float, side: float = 3600.0, rise: float = 1500.0, radius: float = 150.0
) -> tuple[float, float]:
    """Top and layer of a plume of a disc in calm air over theory's, which has the top at `rise` m.

    The box is `side` m wide. The top is the height below which 99 % of the smoke is, the layer the level with
    most of it.
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


def _kept(bench: Bench) -> None:
    mass, shape, _ = advected()
    bench.target("mass of smoke that only drifts with the wind changes by", mass, 1e-6, "", most=True)
    promise = "its shape after 20 cells, a ball of 4 cells' radius, is off by"
    bench.target(promise, 100 * shape, 8, "% of its mass", most=True)
    given, held = warmed()
    bench.target("heat that the flow was given, off what burned by", given, 1e-6, "", most=True)
    bench.target("heat that it holds, off what it was given by", held, 1e-4, "", most=True)
    promise = "smoke in a written moment and gone from the box, off what was given off by"
    bench.target(promise, written(), 1e-6, "", most=True)


def advected() -> tuple[float, float, flow.Solver]:
    """Change of mass, and of shape (sum of differences over sum), of a ball in a steady wind; and the flow.

    A Gaussian of 4 cells' radius, carried 20 cells in 35 steps that are not along the rows.
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
    """What a fire gives off beside what the flow was given, and that beside what neutral air holds of it.

    What warms air of a lower pressure makes more potential temperature of it; that is allowed for.
    """
    solver = _room((0.0, 0.0), 0.0, sponge_time=1e9, damping_time=1e9)
    _light(solver, 4e9)
    solver.step(5.0, 24)
    heat = solver.heat()
    return abs(heat["given"] / (4e9 * solver.time) - 1.0), abs(heat["held"] / heat["warmed"] - 1.0)


def written() -> float:
    """The smoke that the cells of a written moment hold, and what left, beside what was given off."""
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
