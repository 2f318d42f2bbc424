"""Reader of Firetwin's own format: a folder with run.toml, and a file or a folder of files per field."""

from __future__ import annotations

from pathlib import Path

from firetwin_core import run
from firetwin_core.run import Run

NAME = "a folder with run.toml"


def sniff(path: Path) -> bool:
    """Check whether the folder contains a run.toml."""
    return (path / "run.toml").is_file()


def open(path: Path) -> Run:
    """Open the run."""
    return run.open(path)
