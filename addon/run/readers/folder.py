"""Reader of Firetwin's own format: a folder with run.toml, and a file or a folder of files per field.

A folder of `firetwin watch` is the newest revision of its run.
"""

from __future__ import annotations

from pathlib import Path

from firetwin_core import run
from firetwin_core.run import Run

from ..growing import watched

NAME = "a folder with run.toml"


def sniff(path: Path) -> bool:
    """Check whether the folder contains a run.toml, or is a watched folder with a time."""
    return (path / "run.toml").is_file() or (path / watched.TIMES).is_file()


def changing_file(path: Path) -> Path:
    """Return the file of a run that changes with the run."""
    description = path / "run.toml"
    return description if description.is_file() else path / watched.TIMES


def open(path: Path) -> Run:
    """Open the run."""
    if not (path / "run.toml").is_file() and (newest := watched.newest(path)):
        return run.open(newest)
    return run.open(path)
