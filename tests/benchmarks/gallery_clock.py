"""Clocks of runs, moved so that a fire burns by day or by night."""

from __future__ import annotations

import os
import re
import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from firetwin.run import sun, times
from firetwin_core.run import open as open_run

_LOW = 12.0  # degrees over the horizon that the sun of a day's pictures has at least
DAY, NIGHT = 15.5, 22.5  # hours of local solar time that clocks are moved to


def is_day(run: Path, moment: datetime) -> bool:
    """Whether a run's moment is by day."""
    opened = open_run(run)
    place = (float(np.mean(axis)) for axis in (opened.latitude, opened.longitude))
    return sun.angles(*place, moment)[1] > _LOW


def moved(run: Path, folder: Path, moment: datetime, hour: float) -> timedelta:
    """Make the same fire with its clock moved, so that a moment of it comes at an hour; what it is moved by.

    The fields of the run in `folder` are further names of the run's files.
    """
    opened = open_run(run)
    solar = moment.astimezone(UTC) + timedelta(hours=float(np.mean(opened.longitude)) / 15.0)
    by = timedelta(hours=(hour - solar.hour - solar.minute / 60.0) % 24.0)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file in run.resolve().iterdir():
        if file.suffix == ".npy":
            _linked(file, folder / file.name)
    start = times.utc(opened, 0.0).astimezone(UTC) + by
    said = (run / "run.toml").read_text(encoding="utf-8")
    said = re.sub(r"^event = .*$", "", said, flags=re.MULTILINE)  # its dated reports are of the true clock
    stamp = f"start = {start:%Y-%m-%dT%H:%M:%S.%f}Z"
    said = re.sub(r"^start = .*$", stamp, said, count=1, flags=re.MULTILINE)
    (folder / "run.toml").write_text(said, encoding="utf-8")
    return by


def _linked(file: Path, name: Path) -> None:
    """A second name of a file, or a copy where its disk has no such thing."""
    try:
        os.link(file, name)
    except OSError:
        shutil.copyfile(file, name)
