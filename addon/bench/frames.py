"""Heat flux of one frame of a film, between the model times of a run of 2000 x 2000 cells."""

from __future__ import annotations

import itertools
import tempfile
from pathlib import Path

import numpy as np
from firetwin_core import flux
from firetwin_core import run as runs
from numpy.typing import NDArray

from . import interpolation
from .harness import OURS, Bench
from .timing import Runner

SIDES = (144, 720, 2000)
MODEL_TIMES = 6
FRAMES_A_MINUTE = 24


def circle(side: int) -> NDArray[np.float32]:
    """Heat flux (MODEL_TIMES, side, side) W/m2 of a ring of fire that grows by two cells a minute."""
    y, x = np.mgrid[:side, :side] - side / 2.0
    inside = np.hypot(y, x).astype(np.float32) - side / 4.0
    reach = 2.0 * np.arange(MODEL_TIMES, dtype=np.float32)[:, None, None]
    return np.where((inside < reach) & (inside > reach - 6.0), 3e4, 0.0).astype(np.float32)


def run(bench: Bench) -> None:
    """Frame after frame through the run and again from its start; the scan of the run is not in it."""
    for side in SIDES:
        with tempfile.TemporaryDirectory() as folder:
            interpolation.write_run(Path(folder), circle(side), 60.0 * np.arange(MODEL_TIMES))
            model = runs.open(folder)
            end = FRAMES_A_MINUTE * (MODEL_TIMES - 1)
            seconds = itertools.cycle(60.0 * np.arange(1, end) / FRAMES_A_MINUTE)
            runners = [
                Runner(OURS, lambda: flux.at_time(model, next(seconds)), number)  # noqa: B023
                for number in (1, 2)
            ]
            bench.race(f"{side} x {side}", runners, 1, "frame")
