"""Imagery of servers: fetches the tiles of a shot's orthophoto before its build, into pictures of the cache.

Tiles are fetched in a process without Blender, with the cache, back-off and checks of servers of 3D tiles.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ...errors import InputError
from ...progress import MessageCallback, Progress, count, no_message, share, silent
from ...shot import comparison, picture_credits
from ...shot.shot import Shot
from ...shot.source import ShotSource
from ...shot.surface import drape, drape_plan
from ...shot.surface.drape import Drape, DrapeArea
from ...shot.surface.drape_plan import PlannedArea
from ...shot.terrain.raster import extent, format_bounds, overlap
from ...tiles import notices
from ...tiles.imagery import address, wmts
from ...tiles.imagery.address import TileAddress
from ...tiles.imagery.mosaic import Patch, TileServer
from ...tiles.sources.address import origin
from ...tiles.sources.backoff import Clock
from ...tiles.sources.http import Http
from ...tiles.sources.network import Network
from .. import worker
from .access import TileAccess, apply_preferences

_NAMED = 3  # missing tiles in a message; the drape's file lists all


def prepare(
    choice: ShotSource,
    views: Sequence[str] = (),
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    access: TileAccess | None = None,
) -> None:
    """Fetch the orthophoto of a scene with `terrain.photo_url`.

    Parameters
    ----------
    views
        Views that are built separately; empty: all cameras are built together.

    Raises
    ------
    InputError
        The address is invalid or refused, or the server stopped answering.
    """
    if choice.settings().terrain.photo_url:
        work = partial(in_process, choice, views, apply_preferences(access or TileAccess()))
        worker.run(work, progress, tell=tell, blender=False, stop=stop)


def in_process(
    choice: ShotSource, views: Sequence[str], access: TileAccess, progress: Progress, tell: MessageCallback
) -> None:
    """Fetch the orthophoto; worker side."""
    made = set()
    for built in comparison.for_views(choice.shot(), views):
        if (path := drape.location(built)) not in made:
            made.add(path)
            for sentence in make(built, progress, access.network()):
                tell(sentence)


def make(
    shot: Shot, progress: Progress = silent, network: Network | None = None, clock: Clock | None = None
) -> list[str]:
    """Write the drape of a shot.

    Returns
    -------
    Messages for the user.
    """
    terrain, path = shot.settings.terrain, drape.location(shot)
    picture_credits.check_room(shot, picture_credits.of_settings(shot.settings))
    try:
        source = Http(address.with_variables(terrain.photo_url), network, clock)
    except InputError as error:
        raise drape.key_error(shot.settings, f"{error.path} {error.reason}") from None
    try:
        tiles = _tile_address(source, shot)
        server = TileServer(source, tiles)
        messages, planned = _plan(shot, server)
        areas = [
            _write_area(server, area, path.parent, share(progress, number, len(planned), "orthophoto"))
            for number, area in enumerate(planned)
        ]
    finally:
        source.close()
    used = max(area.level for area in areas)
    missing = tuple(
        f"{name}: {reason}" for key, (name, reason) in sorted(server.missing.items()) if key[0] <= used
    )
    credits = tuple(dict.fromkeys(notices.split(terrain.photo_credit)))
    result = Drape(path.parent, tuple(areas), credits, missing)
    drape.write(result, path)
    credit = f"credit of the orthophoto, which pictures show: {'; '.join(result.credits)}"
    return [credit, *messages, *_missing_messages(missing)]


def _tile_address(source: Http, shot: Shot) -> TileAddress:
    """Read the address of the tiles from the settings or the server's capabilities."""
    terrain, url = shot.settings.terrain, address.with_variables(shot.settings.terrain.photo_url)
    if address.is_template(url):
        return TileAddress(url, highest=terrain.photo_level)
    name = source.name(source.root)
    tile_address = wmts.address_of(source.read(source.root, wmts.MAX_BYTES), name, url, terrain.photo_layer)
    there = origin(tile_address.url(tile_address.lowest, 0, 0), name)
    if there != source.home:
        reason = (
            f"has its tiles at {there}, another host; name them as terrain.photo_url: {tile_address.template}"
        )
        raise drape.key_error(shot.settings, source.redactor.text(f"{name} {reason}"))
    if not overlap(tile_address.bounds, shot.run.latitude, shot.run.longitude):
        here = format_bounds(extent(shot.run))
        reason = f"covers {format_bounds(tile_address.bounds)}, outside of the run, which covers {here}"
        raise drape.key_error(shot.settings, f"{name} {reason}")
    return tile_address


def _plan(shot: Shot, server: TileServer) -> tuple[list[str], list[PlannedArea]]:
    """Plan the areas by the size of the server's tiles and its available levels."""
    tiles, side = server.address, 256
    lowest, highest = tiles.lowest, min(tiles.highest, max(shot.settings.terrain.photo_level, tiles.lowest))
    messages: list[str] = []
    while True:
        planned = drape_plan.plan(shot, tiles.bounds, (lowest, highest), side)
        finest = _probe_level(server, planned[-1].patch)
        if server.side and server.side != side:
            side = server.side
            continue
        top = planned[-1].patch.level
        if finest < top and finest >= lowest and server.side:
            messages.append(
                f"the orthophoto's server has no tiles of level {top} here; level {finest} is used"
            )
            highest = finest
            continue
        return messages + [_level_message(area, highest, side) for area in planned], planned


def _probe_level(server: TileServer, patch: Patch) -> int:
    """Find the finest level, at most the patch's, with a tile at one of five places of the patch."""
    for up in range(patch.level - server.address.lowest + 1):
        for across, down in ((2, 2), (1, 1), (3, 1), (1, 3), (3, 3)):
            x, y = (
                ends[0] + (ends[1] - ends[0]) * part // 4
                for ends, part in ((patch.columns, across), (patch.rows, down))
            )
            if server.tile(patch.level - up, x >> up, y >> up) is not None:
                return patch.level - up
    return patch.level


def _write_area(server: TileServer, area: PlannedArea, folder: Path, progress: Progress) -> DrapeArea:
    pixels = server.mosaic(area.patch, progress)
    name = f"{hashlib.sha256(pixels.tobytes()).hexdigest()[:24]}.png"
    if not (folder / name).exists():
        folder.mkdir(parents=True, exist_ok=True)
        sensor.write_image(folder / name, pixels / np.float32(255.0))
    return DrapeArea(
        low=_pair(area.low),
        high=_pair(area.high),
        step=area.step,
        level=area.patch.level,
        column=area.patch.columns[0],
        row=area.patch.rows[0],
        side=server.side,
        file=name,
    )


def _pair(place: NDArray[np.float64]) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def _level_message(area: PlannedArea, highest: int, side: int) -> str:
    """Describe the level of an area, and the reason for not using a finer level."""
    width, height = (tiles * side for tiles in area.patch.size)
    text = f"orthophoto: level {area.patch.level} of {highest}, {area.step:.3g} m a texel, {width} x {height}"
    if not area.limited:
        return text
    why = {
        "level": "the server has no finer level (terrain.photo_level)",
        "size": "terrain.photo_size allows no finer level",
    }
    return f"{text}; a pixel of the nearest view is {area.wanted:.3g} m large, but {why[area.limited]}"


def _missing_messages(missing: Sequence[str]) -> list[str]:
    if not missing:
        return []
    more = f"; and {len(missing) - _NAMED} more" if len(missing) > _NAMED else ""
    named = "; ".join(missing[:_NAMED])
    return [
        f"{count(len(missing), 'tile')} of the orthophoto missing, replaced by coarser tiles: {named}{more}"
    ]
