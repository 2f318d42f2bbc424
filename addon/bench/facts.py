"""What is in a run (`firetwin info`), asked for the first time and once more."""

from __future__ import annotations

import shutil
import tempfile
from functools import partial
from pathlib import Path

from ..data import sample
from ..run import info, readers
from .harness import OURS, Bench
from .timing import Runner

FRAMES = 60  # model times of 144 x 144 cells, with 720 x 720 cells of fuel


def gather(folder: Path) -> dict:
    """Everything `firetwin info` says."""
    return info.gather(readers.open(folder), "UTC")


def run(bench: Bench) -> None:
    """A run that nobody has looked at is a new copy each time, made while no clock runs."""
    with tempfile.TemporaryDirectory() as name:
        known, new = Path(name) / "known", Path(name) / "new"
        sample.write(known, FRAMES, "npy")

        def copy() -> None:
            shutil.rmtree(new, ignore_errors=True)
            shutil.copytree(known, new, ignore=shutil.ignore_patterns(".*"), copy_function=shutil.copyfile)

        runners = [
            Runner(f"{OURS}, the first time", partial(gather, new), before=copy),
            Runner(f"{OURS}, again", partial(gather, known)),
        ]
        bench.race(f"{FRAMES} model times", runners, FRAMES, "model time")
