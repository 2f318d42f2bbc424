"""Infrared pictures: table of Planck's integral, and EXR in, PNG out, compared with NumPy."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from .harness import OURS, Bench
from .timing import Runner

BAND = (8.0, 14.0)
SHAPE = (360, 640)
LOW, HIGH, KNEE = 290.0, 1000.0, 5.0


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


def ours_on_files(exr: Path, png: Path, table: sensor.PlanckTable) -> None:
    """Read EXR radiance and write a palette PNG."""
    kelvin = table.brightness_temperature(sensor.read_image(exr)[..., 0])
    sensor.write_image(png, sensor.colour(kelvin, LOW, HIGH, "ironbow", KNEE))


def numpy_on_files(exr: Path, png: Path, stops: NDArray[np.float64]) -> None:
    """Read EXR radiance and write a palette PNG, with NumPy between the same reader and writer."""
    kelvin = with_numpy(sensor.read_image(exr)[..., 0])
    above = np.clip(kelvin - LOW, 0.0, HIGH - LOW)
    place = np.log1p(above / KNEE) / np.log1p((HIGH - LOW) / KNEE)
    at = np.linspace(0.0, 1.0, len(stops))
    colour = np.stack([np.interp(place, at, stops[:, channel]) for channel in range(3)], axis=-1)
    sensor.write_image(png, colour)


def run(bench: Bench) -> None:
    """Measure the table against the integral and NumPy, then files."""
    radiance = picture()
    exact = sensor.brightness_temperature(radiance, BAND)
    pixels = radiance.size
    tools = [Runner("the integral", partial(sensor.brightness_temperature, radiance, BAND), threads=2)]
    ours = _runner(OURS, partial(sensor.PlanckTable(BAND).brightness_temperature, radiance), exact)
    tools += [ours, _runner("NumPy", partial(with_numpy, radiance), exact)]
    bench.race("radiance to kelvin", tools, pixels, "pixel", "mK")
    assert ours.error is not None
    bench.target("Largest brightness temperature error of the table", ours.error, 1.0, "mK", most=True)
    with tempfile.TemporaryDirectory() as folder:
        exr, png = Path(folder) / "in.exr", Path(folder) / "out.png"
        sensor.write_image(exr, radiance)
        stops = sensor.palette("ironbow")
        files = [
            Runner(OURS, partial(ours_on_files, exr, png, sensor.PlanckTable(BAND)), threads=2),
            Runner("NumPy", partial(numpy_on_files, exr, png, stops)),
        ]
        bench.race("thermal picture, EXR in, PNG out", files, pixels, "pixel")


def _runner(name: str, work: partial, exact: NDArray[np.float64]) -> Runner:
    """Create a runner with its largest error, mK; NumPy runs on one thread, the others on two."""
    error = 1e3 * float(np.abs(work() - exact).max())
    return Runner(name, work, threads=1 if name == "NumPy" else 2, error=error)
