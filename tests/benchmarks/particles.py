"""A particle with linear drag in a gusting wind and explicit Euler, against the exact solution.

dv/dt = (w(t) - v) / r + a, with w(t) = W sin(o t): the exact velocity and place are in closed form.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Runner
from firetwin_core import constants, particles
from numpy.typing import NDArray

SECONDS = 10.0
PARTICLES = 1000
RELAXATION, LIFT = 0.25, -constants.GRAVITY  # s, m/s2
GUST, TURN = np.array([12.0, 5.0, 1.0]), 1.3  # m/s, rad/s
VELOCITY = np.array([3.0, -1.0, 20.0])  # m/s at the start
PAPER = 24_000  # steps a second
EULER = "explicit Euler (NumPy)"


def wind(time: float) -> NDArray:
    """Return the wind (3,), m/s."""
    return GUST * np.sin(TURN * time)


def exact(time: float) -> NDArray:
    """Return the position (3,), m, after `time` s from the origin, by variation of constants."""
    r, o = RELAXATION, TURN
    pull = np.array([0.0, 0.0, LIFT])
    factor = GUST / (1 + (r * o) ** 2)
    steady = factor * (np.sin(o * time) - r * o * np.cos(o * time)) + r * pull
    start = -factor * r * o + r * pull
    decay = VELOCITY - start
    moved = factor * ((1 - np.cos(o * time)) / o - r * np.sin(o * time)) + r * pull * time
    assert steady.shape == (3,)
    return moved + decay * r * (1 - np.exp(-time / r))


def euler(rate: int, number: int, duration: float = SECONDS) -> NDArray:
    """Advance `number` equal particles by explicit Euler at `rate` steps/s; return one position (3,)."""
    step = 1.0 / rate
    place, velocity = np.zeros((number, 3)), np.tile(VELOCITY, (number, 1))
    pull = np.array([0.0, 0.0, LIFT])
    for i in range(round(duration * rate)):
        place = place + step * velocity
        velocity = velocity + step * ((wind(i * step) - velocity) / RELAXATION + pull)
    return place[0]


def run(bench: Bench) -> None:
    """Measure the error after SECONDS and the time per simulated second, for several rates and both tools."""
    truth = exact(SECONDS)
    errors = {}
    for rate in (24, 60, 240, 2400, PAPER):
        tools = [(OURS, ours)] if rate <= 240 else []
        tools += [(EULER, euler)] if rate >= 60 else []
        for tool, call in tools:
            errors[tool, rate] = float(np.linalg.norm(call(rate, 1) - truth))
        runners = [
            Runner(tool, partial(call, rate, PARTICLES, 1.0), error=errors[tool, rate])
            for tool, call in tools
        ]
        bench.race(f"{rate} steps/s", runners, PARTICLES, "particle second", "m")
    bench.target(
        "Position error of a particle after 10 s, 60 steps/s",
        errors[OURS, 60] * 1e3,
        errors[EULER, PAPER] * 1e3,
        "mm",
        most=True,
        rival=f"explicit Euler at {PAPER:,}",
    )


def ours(rate: int, number: int, duration: float = SECONDS) -> NDArray:
    """Advance `number` equal particles by the core at `rate` steps/s; return one position (3,)."""
    step = 1.0 / rate
    place, velocity = np.zeros((number, 3)), np.tile(VELOCITY, (number, 1))
    for i in range(round(duration * rate)):
        begin, middle, end = (wind((i + f) * step) for f in (0, 0.5, 1))
        place, velocity, _ = particles.advance(
            place, velocity, begin, step, RELAXATION, LIFT, wind_end=end, wind_middle=middle
        )
    return place[0]
