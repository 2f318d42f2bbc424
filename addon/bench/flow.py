"""Smoke solved as a flow: plumes beside theory, what is kept, finer cells, and a step beside NumPy's.

Plumes and their theory are described in `flow_plumes`, NumPy's step in `numpy_flow`; both steps begin with
the same moment of dry air over even ground, with a fire in it.
"""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray

from ..smoke import snapshots
from .flow_plumes import Plume, bent, calm, unbalanced
from .harness import OURS, Bench
from .numpy_flow import NumpyFlow
from .timing import Runner, threads

SPACINGS, FINEST = (200.0, 100.0), 50.0  # m
DISC = 150.0  # m, radius of the source of which the grid is varied
CALM_CELLS, CALM_FINER = 75.0, 50.0  # m
THREADS = 2
BOX, CELLS, DT = (44, 96, 96), 200.0, 10.0  # levels, rows, columns; m; s
WIND, LAPSE = (8.0, 3.0), 0.004  # m/s, K/m
POWER, SMOKE = 2e10, 1.2e-9  # W, kg/J
ROOM = np.linspace(0.0, 2000.0, 21), (48, 64), 100.0  # levels, rows and columns, m: for what is kept


def run(bench: Bench) -> None:
    """Theory, grids, accounts, speed."""
    with threads(THREADS):
        _theory(bench)
        _grids(bench)
        _kept(bench)
    _speed(bench)


def _theory(bench: Bench) -> None:
    for wind, rise in ((10.0, 1000.0), *(((6.0, 800.0), (14.0, 800.0)) if bench.full else ())):
        off = _off(bent(100.0, wind, rise).rise)
        promise = f"a steady plume rises in stable air and {wind:g} m/s of wind, off Briggs's height by"
        bench.target(promise, off, 15, "%", most=True)
    for spacing in (CALM_CELLS, CALM_FINER) if bench.full else (CALM_CELLS,):
        found = calm(spacing)
        promise = f"its top in calm air, cells of {spacing:g} m, off that of Morton, Taylor and Turner by"
        bench.target(promise, _off(found.rise), 15, "%", most=True)
        promise = f"the layer that it spreads into there, cells of {spacing:g} m, off theirs by"
        bench.target(promise, _off(found.layer), 25, "%", most=True)


def _grids(bench: Bench) -> None:
    """The same plume in finer and finer cells."""
    found: dict[float, Plume] = {}
    for spacing in (*SPACINGS, FINEST) if bench.full else SPACINGS:
        found[spacing] = bent(spacing, radius=DISC)
        case = "plume of a disc in 10 m/s"
        tool = f"{OURS}, cells of {spacing:g} m"
        bench.row(case, tool, None, 1, "plume", error=_off(found[spacing].rise), error_unit="% off Briggs")
    for coarse, fine in zip(found, list(found)[1:], strict=False):
        change = _off(found[coarse].top / found[fine].top)
        promise = f"top of the plume of a disc in cells of {coarse:g} m, off that in {fine:g} m by"
        bench.target(promise, change, 15, "%", most=True)
    worst = max(unbalanced(each.mass) for each in found.values())
    promise = "smoke neither in the air nor gone, over what was given off, in any of these cells"
    bench.target(promise, worst, 1e-6, "", most=True)


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
    solver = _room((0.0, 0.0), 0.0, side_time=1e9, top_time=1e9)
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
        snapshots.keep(path, solver, drift)
        moment = snapshots.load(path)
    smoke = moment.fields["smoke"].sum((1, 2), dtype=float)
    airborne = np.sum(smoke * np.diff(solver.levels)[: len(smoke)]) * solver.spacing**2
    return unbalanced(moment.mass | {"airborne": float(airborne)})


def _speed(bench: Bench) -> None:
    ours = burning(BOX)
    theirs = with_numpy(ours)
    cells = int(np.prod(BOX))
    step = partial(ours.step, DT)
    tools = [
        Runner(OURS, step),
        Runner(OURS, step, threads=2),
        Runner("NumPy", partial(theirs.step, DT)),
    ]
    levels, rows, columns = BOX
    found = bench.race(f"step of {rows} x {columns} x {levels} cells", tools, cells, "cell step")
    speed = found[OURS].speed(cells / 1e6)
    bench.target("steps of a flow are solved, on one thread, at", speed, 1.0, "Mcell/s")
    faster = found[OURS].faster_than(found["NumPy"])
    bench.target("speed over a step in NumPy", faster, 4, "x")


def burning(shape: tuple[int, int, int], **options: float) -> flow.Solver:
    """Our solver under a fire that has burned for two minutes."""
    levels = _levels(shape[0])
    theta = [300.0, 300.0 + LAPSE * levels[-1]]
    solver = flow.Solver(levels, shape[1:], CELLS, [0.0, levels[-1]], theta, [WIND] * 2, **options)
    place, share = _fire(shape)
    solver.set_sources(place, POWER * share, SMOKE * POWER * share)
    solver.step(DT, 12)
    return solver


def with_numpy(solver: flow.Solver) -> NumpyFlow:
    """The same in NumPy, from the same moment on."""
    levels, state = solver.levels, solver.state()
    middle, depth = 0.5 * (levels[1:] + levels[:-1]), np.diff(levels)
    found = NumpyFlow(levels, solver.density, CELLS, 300.0 + LAPSE * middle, state)
    place, share = _fire(solver.shape)
    column = np.zeros(solver.shape[1:])
    spread = (place[:, None] / CELLS - 0.5 + np.array([[0, 0], [0, 1], [1, 0], [1, 1]])).astype(int)
    near = np.prod(1.0 - np.abs(place[:, None] / CELLS - 0.5 - spread), axis=2)
    np.add.at(column, (spread[..., 1], spread[..., 0]), near * share[:, None])
    deep = np.exp(-levels[:-1] / 90.0) - np.exp(-levels[1:] / 90.0)
    added = (deep / deep.sum() / (solver.density * depth * CELLS**2))[:, None, None] * column * POWER
    exner = (1.0 - 9.80665 * middle / (1004.7 * 300.0))[:, None, None]
    found.heating = (added / (1004.7 * exner)).astype(np.float32)
    found.smoking = (SMOKE * added).astype(np.float32)
    return found


def _levels(count: int) -> NDArray[np.float64]:
    """Levels as a shot has them: 60 m deep at the ground, 270 m at the top."""
    k = np.arange(count + 1)
    return 60.0 * k + 0.5 * 210.0 / count * k * k


def _fire(shape: tuple[int, int, int]) -> tuple[NDArray, NDArray]:
    """Places (400, 2) m along a front, and their shares of its heat."""
    size = np.array(shape[:0:-1]) * CELLS
    return np.random.default_rng(0).uniform([0.35, 0.4], [0.5, 0.45], (400, 2)) * size, np.full(400, 1 / 400)


def _room(wind: tuple[float, float], lapse: float, **options: float) -> flow.Solver:
    levels, shape, spacing = ROOM
    theta = [300.0, 300.0 + lapse * levels[-1]]
    return flow.Solver(levels, shape, spacing, [0.0, levels[-1]], theta, [wind] * 2, **options)


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


def _off(ratio: float) -> float:
    """Per cent."""
    return 100.0 * abs(ratio - 1.0)
