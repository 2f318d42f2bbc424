"""Runs of a scene file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ..shot.shot import Shot


def is_scene(path: Path) -> bool:
    """Check whether a path is a scene file, and not a run folder."""
    return path.suffix == ".toml" and path.is_file()


def open_runs(scene: Path) -> dict[str, Run]:
    """Open all runs of a scene file, by name and in order."""
    from ..shot.source import ShotSource

    return list_runs(ShotSource(scene=str(scene)).shot())


def list_runs(shot: Shot) -> dict[str, Run]:
    """Return all runs of a shot, by name and in order."""
    return {shot.label: shot.run, **shot.others}
