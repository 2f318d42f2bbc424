"""Selection of a shot's 3D tiles: selects, fetches and decodes them to files of the cache.

Tiles are fetched in a process without Blender, and decoded in separate processes (`decode`). Blender reads
validated arrays.
"""

from __future__ import annotations

import os
import shutil
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from ...errors import Error, InputError
from ...progress import MessageCallback, Progress, count, no_message, share, silent
from ...shot import comparison, picture_credits
from ...shot.settings import tile_heights_file
from ...shot.shot import Shot
from ...shot.source import ShotSource
from ...shot.surface import land_use
from ...shot.terrain import tile_heights
from ...shot.terrain.tile_heights import TileHeights
from ...shot.tiles import tile_cut, tile_difference, tile_terms
from ...shot.tiles.tile_cut import TileCut
from ...shot.tiles.tile_terms import Use
from ...tiles import decoded, policies
from .. import worker
from . import source as tile_source
from .access import TileAccess, apply_preferences
from .source import PreparedTiles, TileSource

PREVIEW_ERROR, PREVIEW_SIZE = 64.0, 200
"""Screen-space error in pixels and limit in MB of a coarse selection."""
_NAMED = 6  # missing tiles in messages; the manifest lists all


def prepare(
    choice: ShotSource,
    views: Sequence[str] = (),
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    access: TileAccess | None = None,
    uses: Sequence[Use] = (),
    keep: bool = False,
    preview: bool = False,
) -> None:
    """Prepare the tiles of a scene with sources.

    Parameters
    ----------
    views
        Views that are built separately; empty: all cameras are built together.
    access
        Access to tiles.
    uses
        Uses of the tiles in addition to the scene's settings.
    keep
        Keep complete selections of servers' tiles, so that a film continues with its tiles, even without the
        server.
    preview
        Make a coarse selection (see `coarse_shot`).

    Raises
    ------
    InputError
        A tileset is invalid or refused, or its policy forbids a use.
    Error
        A tile is missing, and `access` is strict.
    """
    settings, access = choice.settings(), access or TileAccess()
    if not settings.tiles.sources:
        return
    every = [*tile_terms.of_scene(settings), *uses]
    offline = [] if access.online else [("work_offline", "--offline")]
    tile_terms.check(settings, [*every, *offline])
    work = partial(in_process, choice, views, apply_preferences(access), every, keep, preview)
    worker.run(work, progress, tell=tell, blender=False, stop=stop)


def coarse_shot(shot: Shot) -> Shot:
    """Make a shot with a coarse, small selection of tiles, for a quick preview."""
    tiles, terrain = shot.settings.tiles, shot.settings.terrain
    least, most = max(tiles.max_screen_space_error, PREVIEW_ERROR), min(tiles.max_size, PREVIEW_SIZE)
    settings = replace(
        shot.settings,
        tiles=replace(tiles, max_screen_space_error=least, max_size=most),
        terrain=replace(terrain, height_source="elevation"),
    )
    return Shot(settings, shot.run)


def in_process(
    choice: ShotSource,
    views: Sequence[str],
    access: TileAccess,
    uses: Sequence[Use],
    keep: bool,
    preview: bool,
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Prepare the tiles; worker side."""
    shot = choice.shot()
    if preview:
        make(coarse_shot(shot), progress, access, uses)
        return
    if shot.settings.terrain.height_source == "tiles":
        terrain = replace(shot.settings.terrain, height_source="elevation")
        first = Shot(replace(shot.settings, terrain=terrain), shot.run)
        heights = tile_heights_file.location(shot.settings, shot.run)
        if not (_can_keep(first, keep) and heights.exists()):
            make(first, progress, access, uses)
            found = tile_cut.heights_file(tile_cut.location(first))
            if found.is_file():
                shutil.copyfile(found, heights)
        shot = choice.shot()
    for built in comparison.for_views(shot, views):
        if not _can_keep(built, keep):
            for sentence in make(built, progress, access, uses):
                tell(sentence)


def _can_keep(shot: Shot, keep: bool) -> bool:
    """Test whether a shot's selection is still valid; local files may have changed, so read them again."""
    try:
        cut = tile_cut.prepared(shot) if keep else None
    except InputError:  # damaged: select again
        return False
    places = shot.settings.tiles.sources
    remote = all("://" in place and policies.for_source(place).may_work_offline for place in places)
    if not remote or cut is None or not cut.is_whole():
        return False
    os.utime(tile_cut.location(shot))  # time of last use
    return True


def make(
    shot: Shot, progress: Progress = silent, access: TileAccess | None = None, uses: Sequence[Use] = ()
) -> list[str]:
    """Select the tiles of a shot and write the cut.

    Returns
    -------
    Messages for the user.

    Raises
    ------
    Error
        A tile is missing, and `access` is strict.
    InputError
        A policy forbids a use, or pictures are too small for the credits.
    """
    settings, path, access = shot.settings.tiles, tile_cut.location(shot), access or TileAccess()
    path.parent.mkdir(parents=True, exist_ok=True)
    undulation, matrix = tile_source.to_scene(shot)
    prepared = [
        TileSource(shot, number, path.parent, matrix, access, uses).prepare(
            share(progress, number, len(settings.sources), "tiles")
        )
        for number in range(len(settings.sources))
    ]
    names = tuple(name for each in prepared for name in each.names)
    heights = _heights(shot, path, names)
    notices = Counter(part for each in prepared for part in each.credits)
    cut = TileCut(
        path.parent,
        path.stem,
        names,
        tuple(notice for notice, _ in notices.most_common()),
        tuple(sorted(reason for each in prepared for reason in each.missing)),
        max(each.selection.error for each in prepared),
        tuple(dict.fromkeys(each.policy.logo for each in prepared if each.policy.logo)),
        sum(each.empty for each in prepared),
        tile_difference.measure(heights, shot.settings, shot.run) if heights else None,
        sum(each.selection.bytes for each in prepared),
        sum(each.triangles for each in prepared),
    )
    picture_credits.check_room(shot, picture_credits.of_cuts(shot.settings, [cut]))
    if access.strict and cut.missing:
        raise Error(f"--strict: {count(len(cut.missing), 'tile')} missing: {'; '.join(cut.missing)}")
    tile_cut.write(cut, path)
    difference = [tile_difference.sentence(cut.difference, undulation)] if heights else []
    return [*_messages(cut, prepared), *difference]


def _heights(shot: Shot, path: Path, names: Sequence[str]) -> TileHeights | None:
    """Write the heights of a cut's tiles next to it; None without tiles."""
    if not names:
        tile_cut.heights_file(path).unlink(missing_ok=True)
        return None
    found = (decoded.read(path.parent / name) for name in names)
    surface = tile_heights.rasterise(found, shot.bare_ground.up, land_use.buildings(shot))
    tile_heights.write(tile_cut.heights_file(path), surface)
    return TileHeights(shot.ground.frame, surface)


def _messages(cut: TileCut, prepared: Sequence[PreparedTiles]) -> Iterator[str]:
    """List the messages on a cut."""
    if cut.words:
        yield f"credits of tiles, which pictures show: {cut.words.text()}"
    for each in prepared:
        if each.advised:
            yield (
                f"{each.policy.name} recommends tiles to {each.selection.requested_error:g} pixels; "
                "tiles.max_screen_space_error sets another value"
            )
        if sentence := each.selection.message():
            yield sentence
    if more := cut.missing[1:_NAMED]:
        yield f"also missing: {'; '.join(more)}" + (" ..." if len(cut.missing) > _NAMED else "")
    if cut.empty:
        yield f"empty, without triangles between finite vertices: {count(cut.empty, 'tile')}"
