"""Shares, quantiles and depths of forecast members, and depths compared with NumPy on all members at once.

The members are ellipses with random sizes and directions. NumPy computes depths from the common areas of all
pairs of members. Its arrays are in memory; firetwin's are read from the disk. The peak memory is of a process
that computes all three.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

import numpy as np
from firetwin import memory
from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Runner
from firetwin.forecasts.ensemble import ensemble, statistics, write
from firetwin.forecasts.ensemble.ensemble import Ensemble
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.jobs import worker
from firetwin.progress import MessageCallback, Progress, no_message, silent
from numpy.typing import NDArray

HORIZON = 86_400.0  # s
MOMENTS = np.linspace(HORIZON / 8, HORIZON, 8)
LEVELS = (0.1, 0.5, 0.9)
LARGE, MANY = (100, 720), (1000, 120)  # members, cells along a side


def members(count: int, side: int) -> Iterator[tuple[Member, NDArray[np.float32]]]:
    """Make members whose fire spreads as an ellipse, s; inf after the horizon."""
    y, x = np.mgrid[0:side, 0:side].astype(np.float32) / side - 0.5
    rng = np.random.default_rng(1)
    for index in range(count):
        angle, ratio, speed = rng.uniform(0.0, 0.8), rng.uniform(0.3, 0.7), rng.uniform(0.5, 1.5)
        along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
        arrival = np.hypot(along, across / ratio) * (2.0 * HORIZON / speed)
        yield Member(str(index)), np.where(arrival > HORIZON, np.inf, arrival).astype(np.float32)


def make(folder: Path, count: int, side: int) -> Ensemble:
    """Write an ensemble of cells of 0.001 degrees, and open it."""
    head = Manifest("bench", "", datetime(2014, 9, 17, tzinfo=UTC), HORIZON, (), synthetic=True)
    axis = 0.001 * np.arange(side)
    write.write(folder, head, 38.5 + axis, -120.5 + axis, members(count, side))
    return ensemble.open(folder)


def compute(forecast: Ensemble) -> tuple[NDArray, NDArray, NDArray]:
    """Compute shares, quantiles and depths."""
    shares = statistics.shares(forecast, MOMENTS).share
    return shares, statistics.quantiles(forecast, LEVELS), statistics.depths(forecast, HORIZON)


def numpy_depths(arrival: NDArray, area: NDArray) -> NDArray:
    """Compute epsilon inclusion depths (m,) from the common area of each pair; no member may be empty."""
    inside = (arrival <= HORIZON).reshape(len(arrival), -1).astype(np.float32)
    common = (inside * area.ravel().astype(np.float32)) @ inside.T
    share = common / np.diag(common)[:, None]
    return (np.minimum(share.sum(0), share.sum(1)) - 1.0) / (len(arrival) - 1)


def run(bench: Bench) -> None:
    """Measure run time and memory for 100 large members, and the depths of 1,000 small ones against NumPy."""
    with tempfile.TemporaryDirectory() as folder:
        forecast = make(Path(folder) / "large", *LARGE)
        case = f"{LARGE[0]} members of {LARGE[1]} x {LARGE[1]}"
        times = bench.race(
            case, [Runner(OURS, partial(compute, forecast))], int(np.prod(forecast.shape)), "value"
        )
        bench.target(f"Time of the three, {case}", times[OURS].seconds, 3.0, "s", most=True)
        peak = worker.run(partial(peak_of, forecast.path), blender=False)
        if peak:  # known
            bench.target(f"Peak memory of a process, {case}", peak / 1e6, 300.0, "MB", most=True)
        forecast = make(Path(folder) / "many", *MANY)
        arrival = np.load(forecast.path / ensemble.ARRIVAL)
        case = f"{MANY[0]:,} members of {MANY[1]} x {MANY[1]}"
        ours = Runner(OURS, partial(statistics.depths, forecast, HORIZON))
        pairs = Runner("NumPy, areas of all pairs", partial(numpy_depths, arrival, forecast.areas))
        times = bench.race(f"depths, {case}", [ours, pairs], int(np.prod(forecast.shape)), "value")
        speed = times[OURS].faster_than(times[pairs.label])
        bench.target(f"Speed of depths / areas of all pairs, {case}", speed, 2.0, "x")


def peak_of(folder: Path, progress: Progress = silent, tell: MessageCallback = no_message) -> int:
    """Compute the three statistics in a worker process; return its peak memory, bytes."""
    compute(ensemble.open(folder))
    return memory.peak()
