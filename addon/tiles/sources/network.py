"""Permissions of a source: network, and folders of this machine."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from .http_cache import LIMIT, folder
from .watchdog import PACE, Pace, Spent


@dataclass(frozen=True)
class Network:
    """Permissions of a source.

    Attributes
    ----------
    online
        Requests are allowed; otherwise only the cache is used.
    setting
        Remedy for `online` being off, for messages.
    hosts
        Allowed hosts in addition to the root's.
    private
        Allow addresses of private networks.
    cache
        Folder of the cache; None: no cache.
    limit
        Limit of the cache, bytes.
    root
        Folder within which files of tilesets on this machine may refer to one another; None: their own.
    pace
        Time limits of downloads.
    spent
        Time of the requests of all sources with these permissions.
    """

    online: bool = True
    setting: str = "leave out --offline"
    hosts: tuple[str, ...] = ()
    private: bool = False
    cache: Path | None = field(default_factory=folder)
    limit: int = LIMIT
    root: Path | None = None
    pace: Pace = PACE
    spent: Spent = field(default_factory=Spent, compare=False)
