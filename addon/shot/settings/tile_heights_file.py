"""Name of the file that holds the heights of a scene's tiles."""

from __future__ import annotations

import hashlib
from pathlib import Path

from firetwin_core.run import Run

from ...run.frame import local_frame
from . import Settings


def location(settings: Settings, run: Run) -> Path:
    """File of the heights of a scene's tiles; its name follows the settings by which tiles are selected."""
    frame = local_frame(run)
    mapped = str(settings.terrain.land_use)
    parts = settings.tiles, settings.cameras, settings.time, settings.render.resolution, mapped
    digest = hashlib.sha256(repr((*parts, frame.latitude, frame.longitude)).encode())
    return settings.cache / "tiles" / f"heights-{digest.hexdigest()[:16]}.npz"
