"""Motion of smoke: how evenly pictures of a flow's smoke change, at the speeds of films."""

import functools

import motion
import numpy as np
import pytest
from firetwin_core import flow

SPACING, SHAPE, LEVELS, DEPTH, VOXEL = 66.7, (20, 40), 18, 60.0, 30.0  # m; rows and columns
FRAME = motion.SPEED / motion.FPS  # s of fire


def test_even_motion_has_no_second_difference_and_noise_has_all_of_it():
    even = np.arange(8.0)[:, None, None] * np.ones((4, 5))
    assert motion.ratio(even) == pytest.approx(0.0)
    noise = np.random.default_rng(1).normal(size=(200, 20, 20))
    assert motion.ratio(noise) == pytest.approx(motion.MEMORYLESS, rel=0.01)


@pytest.mark.parametrize(("seconds", "low", "high"), [(FRAME, 0.0, motion.LIMIT), (30.0, 1.5, 1.95)])
def test_smoke_flows_at_ten_times_real_time_and_boils_at_hundreds(seconds, low, high):
    assert low < motion.ratio(film(seconds, 7)) < high


def test_detail_that_does_not_go_with_the_air_boils():
    still = motion.ratio(film(FRAME, 7, turns=lambda frame: (3 * frame, 3 * frame + 1)))
    assert still > motion.LIMIT


def film(seconds, count, turns=None):
    """Pictures of a plume from the side, lit from above, `seconds` apart."""
    solver, drift = plume()
    pictures = []
    for frame in range(count):
        pictures.append(picture(solver, drift, drift.turns if turns is None else turns(frame)))
        steps = max(1, round(seconds / 5.0))
        for _ in range(steps):
            solver.step(seconds / steps)
            drift.advance()
    return np.array(pictures)


def plume():
    """A steady fire in wind, after three minutes, with detail that drifted for two."""
    solver, drift = _new()
    state, moved, time = _burned()
    solver.restore(state)
    drift.restore(time, moved)
    return solver, drift


def _new():
    levels = np.arange(LEVELS + 1) * DEPTH
    profile = flow.Profile([0.0, levels[-1]], [300.0, 304.0], [[5.0, 0.0], [10.0, 0.0]])
    settings = flow.SolverSettings(sponge_width=4, gust_strength=0.9, gust_size=180.0, gust_time=45.0)
    solver = flow.Solver(flow.Domain(levels, SHAPE, SPACING), profile, settings)
    place = np.array([0.25 * SHAPE[1], 0.5 * SHAPE[0]]) * SPACING
    place = place + np.random.default_rng(1).uniform(-120, 120, (20, 2))
    solver.set_sources(place, np.full(20, 1.5e8), np.full(20, 0.2))
    return solver, flow.Drift(solver, 120.0)


@functools.cache
def _burned():
    solver, _ = _new()
    solver.step(5.0, 12)
    drift = flow.Drift(solver, 120.0)
    for _ in range(24):
        solver.step(5.0)
        drift.advance()
    return solver.state(), drift.values(), drift.time


def picture(solver, drift, turns):
    middle = (np.arange(LEVELS) + 0.5) * DEPTH
    moved = drift.values()
    for axis, count in enumerate(solver.shape):
        moved = np.repeat(moved, 2, axis).take(range(count), axis)
    detail = flow.Detail(
        spacing=SPACING,
        corner=(0.0, 0.0),
        levels=middle,
        heights=np.broadcast_to(middle[:, None, None], solver.shape),
        ground=np.zeros(SHAPE),
        smoke=solver.smoke(),
        age=solver.age(),
        rise=solver.velocity()[..., 2],
        temperature_excess=solver.temperature_excess(),
        drift=moved,
        weights=tuple(drift.weights),
        turns=tuple(turns),
        blur=(3.5, 2.5, 2.5),
    )
    columns, rows = (int(count * SPACING / VOXEL) for count in SHAPE[::-1])
    flat = np.zeros((columns, rows))
    extinction, _, _ = detail.paint((0.0, 0.0, 0.0), VOXEL, flat, flat + 1.0, int(LEVELS * DEPTH / VOXEL))
    depth = np.asarray(extinction, np.float64) * VOXEL
    above = np.cumsum(depth[:, :, ::-1], axis=2)[:, :, ::-1]
    before = np.cumsum(depth, axis=1) - depth
    return np.sum(np.exp(-before - 0.15 * above) * -np.expm1(-depth), axis=1)
