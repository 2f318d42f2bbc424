"""Rise of the puffs of a steady fire in a uniform wind, against theory, and theory integrated step by step.

Briggs's bent-over plume (Briggs 1975, "Plume rise predictions", in Lectures on Air Pollution and
Environmental Impact Analyses) in a wind U with the buoyancy frequency N: its radius is b z, its momentum
m = b^2 z^2 w, and dz/dt = w, dm/dt = F / U, dF/dt = -N^2 U m, which is solved by
z^3 = 3 Fb / (b^2 U N^2) (1 - cos N t) up to its top at N t = pi; b = 0.6. Past that, plumes settle at
2.6 (Fb / (U N^2))^(1/3).
"""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Runner
from firetwin_core import constants, volume
from numpy.typing import NDArray

POWERS = (1e8, 1e9, 1e10)  # W
WIND = np.array([6.0, 8.0])  # m/s east and north, 10 m up
STABILITY, ENTRAINMENT = 1e-4, 0.6  # 1/s2
CONVECTIVE, BURN_TIME = 0.7, 1e4  # share of the heat, s
AGE = 5400.0  # s, after which a plume has settled
EULER_STEPS = (10.0, 1.0, 0.1)  # s


def buoyancy(power: float) -> float:
    """Return the buoyancy flux Fb = g c Q / (pi cp rho T) of a fire of `power` W, m4/s3."""
    return constants.BUOYANCY_FLUX * CONVECTIVE * power


def wind_aloft() -> float:
    """Return the wind speed at 300 m, which the theory needs, by a power law of exponent 0.1, m/s."""
    return float(np.hypot(*WIND)) * 30**0.1


def theory(power: float, time: NDArray) -> NDArray:
    """Return the rise (n,), m, at `time`, s, up to the top of the plume."""
    turn = np.sqrt(STABILITY) * time
    scale = 3 * buoyancy(power) / (ENTRAINMENT**2 * wind_aloft() * STABILITY)
    return np.cbrt(scale * (1 - np.cos(turn)))


def settled(power: float) -> float:
    """Return the final rise, m."""
    return 2.6 * float(np.cbrt(buoyancy(power) / (wind_aloft() * STABILITY)))


def column(power: float) -> tuple[NDArray, NDArray]:
    """Return ages (s) and rise (m), by age, of the puffs of a fire that has burned evenly for AGE seconds.

    The first puff is left out: it holds the heat of less than a full interval.
    """
    fuel = power * BURN_TIME / constants.HEAT_OF_COMBUSTION
    smoke = volume.puffs(
        AGE + 1,
        [0.0],
        [fuel],
        [[0.0, 0.0, 0.0]],
        WIND,
        1.0,
        burn_time=BURN_TIME,
        max_age=3 * AGE,
        stability=STABILITY,
        turbulence=0.0,
        smallest=1e9,
    )
    fire = np.sqrt(power / (np.pi * 1e5))
    by_age = np.argsort(smoke.age)[:-1]
    return smoke.age[by_age].astype(float), smoke.position[by_age, 2] - 0.8 * fire


def euler(power: float, step: float) -> tuple[float, float]:
    """Return time (s) and rise (m) near the top, by explicit Euler from the theory's values after one step.

    At time 0 the plume has no size and unlimited speed.
    """
    wind, frequency, number = wind_aloft(), np.sqrt(STABILITY), round(np.pi / np.sqrt(STABILITY) / step)
    momentum = buoyancy(power) / (wind * frequency) * float(np.sin(frequency * step))
    force = buoyancy(power) * float(np.cos(frequency * step))
    height = float(theory(power, np.array(step)))
    for _ in range(number - 1):
        speed = momentum / (ENTRAINMENT * height) ** 2
        momentum, force = momentum + step * force / wind, force - step * STABILITY * wind * momentum
        height += step * speed
    return number * step, height


def errors(power: float) -> tuple[float, float]:
    """Return the largest deviation of our column from theory up to its top, and the final one, percent."""
    age, rise = column(power)
    rising = (age > 0) & (age <= np.pi / np.sqrt(STABILITY))
    under_way = np.abs(rise[rising] / theory(power, age[rising]) - 1).max()
    return 100 * float(under_way), 100 * abs(float(rise[-1]) / settled(power) - 1)


def run(bench: Bench) -> None:
    """Measure fires of three powers: the rise under way, and the final rise."""
    under_way, end = 0.0, 0.0
    for power in POWERS:
        way, top = errors(power)
        under_way, end = max(under_way, way), max(end, top)
        tools = [Runner(OURS, partial(column, power), error=way)]
        for step in EULER_STEPS:
            time, rise = euler(power, step)
            error = 100 * abs(rise / float(theory(power, np.array(time))) - 1)
            tools.append(Runner(f"Euler, {step:g} s steps", partial(euler, power, step), error=error))
        bench.race(f"{power / 1e9:g} GW", tools, 1, "plume", "% of the rise")
    bench.target("Rise of a plume under way, largest deviation from Briggs", under_way, 10, "%", most=True)
    bench.target("Final rise, deviation from 2.6 (Fb / U s)^(1/3)", end, 1, "%", most=True)
