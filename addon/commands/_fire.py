"""Fire of a run, for stations around it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ._scene_runs import is_scene, open_runs

if TYPE_CHECKING:
    from ..stations.verbs import Fire


def open_fire(path: Path) -> Fire:
    """Open the run of a folder, or the first run of a scene file, with the head of its fire."""
    from ..run import readers
    from ..shot.runs.run_head import Head
    from ..stations.verbs import Fire

    run = next(iter(open_runs(path).values())) if is_scene(path) else readers.open(path)
    return Fire(run, Head(run))
