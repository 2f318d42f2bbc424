"""Cache job: lists cached smoke volumes and tiles and prunes them; needs no worker process."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..errors import UsageError, writing
from ..shot.settings import scene_file
from ..smoke import cache
from ..smoke.cache import CachedVolumes
from ..tiles.sources import http_cache
from ..tiles.sources.http_cache import HttpCache
from .tiles import cache as tile_cache
from .tiles.cache import CachedTiles

Cached = CachedVolumes | CachedTiles


def folders(places: Iterable[Path]) -> list[Path]:
    """List the cache folders of scene files, or folders given directly, without duplicates.

    Raises
    ------
    UsageError
        A folder is missing.
    """
    caches = [scene_file.read(place).cache if place.suffix == ".toml" else place for place in places]
    for place, named in zip(caches, places, strict=True):
        if place == named and not place.is_dir():
            raise UsageError(f"cache: the folder {place} does not exist; name a cache folder or a scene file")
    return list(dict.fromkeys(place.absolute() for place in caches))


def by_last_use(places: Iterable[Path]) -> list[Cached]:
    """List smoke volumes and decoded tiles in these folders, most recently used first."""
    found: list[Cached] = []
    for place in places:
        found += [*cache.list_volumes(place), *tile_cache.list_tiles(place)]
    return sorted(found, key=lambda each: -each.used)


def prune(kept: list[Cached], limit: int, dry_run: bool = False) -> list[Cached]:
    """Remove the least recently used until at most `limit` bytes remain; return the removed items.

    Items in use are never removed. With `dry_run` nothing is removed; the result is the same.
    """
    going = cache.to_evict(kept, limit)
    if dry_run:
        return going
    gone = []
    for each in going:
        with writing(each.folder):
            if tile_cache.remove(each) if isinstance(each, CachedTiles) else cache.remove(each):
                gone.append(each)
    return gone


def answers() -> tuple[Path, int, int, float]:
    """Return the folder of the HTTP cache, number and bytes of its answers, and the time of last use."""
    kept = HttpCache(http_cache.folder())
    try:
        return (kept.place, *kept.content())
    finally:
        kept.close()


def prune_answers(limit: int, dry_run: bool = False) -> int:
    """Remove the least recently used answers of tile servers beyond `limit` bytes; return the bytes left."""
    place, _, total, _ = answers()
    if dry_run or total <= limit:
        return min(total, limit)
    kept = HttpCache(place)
    try:
        return kept.prune(limit)
    finally:
        kept.close()
