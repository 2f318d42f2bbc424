"""Infrared pictures: table of Planck's integral, compared with the integral and NumPy."""

from __future__ import annotations

from functools import partial

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner

BAND = (8.0, 14.0)
SHAPE = (360, 640)


def picture() -> NDArray[np.float32]:
    """Make radiance (h, w) of ground at 280 to 330 K, 1 % of it on fire, W m-2 sr-1."""
    random = np.random.default_rng(2)
    kelvin = random.uniform(280.0, 330.0, SHAPE)
    fire = random.random(SHAPE) < 0.01
    kelvin[fire] = random.uniform(400.0, 1200.0, int(fire.sum()))
    return sensor.radiance(kelvin, BAND).astype(np.float32)


def with_numpy(radiance: NDArray[np.float32]) -> NDArray[np.float64]:
    """Interpolate temperatures linearly between the 4,096 knots of a table."""
    knots = np.geomspace(150.0, 3000.0, 4096)
    return np.interp(radiance, sensor.radiance(knots, BAND), knots)


def run(bench: Bench) -> None:
    """Measure the table against the integral and NumPy."""
    radiance = picture()
    exact = sensor.brightness_temperature(radiance, BAND)
    pixels = radiance.size
    tools = [Runner("the integral", partial(sensor.brightness_temperature, radiance, BAND), threads=2)]
    ours = _runner(OURS, partial(sensor.PlanckTable(BAND).brightness_temperature, radiance), exact)
    tools += [ours, _runner("NumPy", partial(with_numpy, radiance), exact)]
    bench.race("radiance to kelvin", tools, pixels, "pixel", "mK")
    assert ours.error is not None
    bench.target("Largest brightness temperature error of the table", ours.error, 1.0, "mK", most=True)


def _runner(name: str, work: partial, exact: NDArray[np.float64]) -> Runner:
    """Create a runner with its largest error, mK; NumPy runs on one thread, the others on two."""
    error = 1e3 * float(np.abs(work() - exact).max())
    return Runner(name, work, threads=1 if name == "NumPy" else 2, error=error)
