"""Smoke cache job: lists cached smoke volumes and prunes them; needs no worker process."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..errors import UsageError, writing
from ..shot.settings import scene_file
from ..smoke import cache
from ..smoke.cache import CachedVolumes


def folders(places: Iterable[Path]) -> list[Path]:
    """Cache folders of scene files, or folders given directly; each once.

    Raises
    ------
    UsageError
        A folder is missing.
    """
    caches = [scene_file.read(place).cache if place.suffix == ".toml" else place for place in places]
    for place, named in zip(caches, places, strict=True):
        if place == named and not place.is_dir():
            raise UsageError(f"cache: there is no folder {place}; name a cache folder or a scene file")
    return list(dict.fromkeys(place.absolute() for place in caches))


def by_last_use(places: Iterable[Path]) -> list[CachedVolumes]:
    """Volumes in these folders, most recently used first."""
    return sorted(
        (volume for place in places for volume in cache.list_volumes(place)), key=lambda volume: -volume.used
    )


def prune(volumes: list[CachedVolumes], limit: int, dry_run: bool = False) -> list[CachedVolumes]:
    """Remove the least recently used volumes until at most `limit` bytes remain; returns those removed.

    Volumes in use are never removed. With `dry_run` nothing is removed; the result is the same.
    """
    going = cache.beyond(volumes, limit)
    if dry_run:
        return going
    gone = []
    for each in going:
        with writing(each.folder):
            if cache.remove(each):
                gone.append(each)
    return gone
