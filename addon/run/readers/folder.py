"""Firetwin's own format: a folder with run.toml and a file, or a folder of files, per field."""

from __future__ import annotations

from pathlib import Path

from firetwin_core import run
from firetwin_core.run import Run

NAME = "a folder with run.toml"


def sniff(path: Path) -> bool:
    """Whether there is a run.toml in it."""
    return (path / "run.toml").is_file()


def open(path: Path) -> Run:
    """Open it."""
    return run.open(path)
