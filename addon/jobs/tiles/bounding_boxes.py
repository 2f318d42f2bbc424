"""Bounding boxes and facts of a shot's tilesets from their root documents, without fetching tiles."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from ...progress import MessageCallback, Progress, no_message, silent
from ...shot.source import ShotSource
from .. import worker
from .access import TileAccess, apply_preferences

MOST = 2000
"""Maximum boxes of a source; the coarsest tiles are listed."""


def run(
    choice: ShotSource,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> list[dict[str, Any]]:
    """Read the root documents of a scene's tilesets, but no other files.

    Returns
    -------
    For each source: `name`, number of `tiles` in its root document, `credits`, and `corners`: x, y, z of
    eight corners for each box, m in the scene.

    Raises
    ------
    InputError
        A tileset is invalid or refused.
    """
    work = partial(in_process, choice, apply_preferences(TileAccess()))
    return worker.run(work, progress, tell=tell, blender=False, stop=stop)


def in_process(
    choice: ShotSource, access: TileAccess, progress: Progress, tell: MessageCallback
) -> list[dict[str, Any]]:
    """Read the root documents; worker side."""
    from ...tiles.loader import Loader
    from . import source as tile_source

    shot = choice.shot()
    boxes = []
    for number in range(len(shot.settings.tiles.sources)):
        progress(number, len(shot.settings.tiles.sources), "reading the tilesets")
        source = tile_source.open_tileset(shot, number, access)
        try:
            tree = Loader(source).tree
        finally:
            source.close()
        some = np.argsort(tree.level, kind="stable")[:MOST]
        _, matrix = tile_source.to_scene(shot)
        placed = tree.volumes.take(some).moved(matrix[None], np.zeros(len(some), np.int64))
        wide = placed.half + placed.padding[:, None]
        corners = type(placed)(placed.centre, placed.axis, wide, placed.padding).corners()
        boxes.append(
            {
                "name": source.name(source.root),
                "tiles": tree.size,
                "credits": [each.copyright for each in tree.documents if each.copyright],
                "corners": np.round(corners, 2).ravel().tolist(),
            }
        )
    return boxes
