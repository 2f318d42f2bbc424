"""Opening of run folders: run.toml by `description`, the fields by the core."""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path

from firetwin_core import run
from firetwin_core.run import Run

from . import description

__all__ = ["Run", "open"]


def open(folder: str | bytes | PathLike[str]) -> Run:
    """Open a run folder: run.toml, the axes and the shape of each field are checked; frames stay on disk.

    Raises
    ------
    InputError
        The folder is not a valid run.
    """
    path = Path(os.fsdecode(folder))
    content = run.read_description(path)
    described = description.parse(path.resolve() / "run.toml", content)
    return run.open(path, **vars(described))
