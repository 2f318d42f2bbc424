"""Sources of tilesets: one file for each kind of source."""

from __future__ import annotations

import re
from pathlib import Path

from . import ion
from ._source import MissingError, Source
from .archive import Archive
from .folder import Folder
from .http import Http
from .network import Network

__all__ = ["MissingError", "Network", "Source", "open_source"]

_URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+://")


def open_source(place: str, network: Network | None = None) -> Source:
    """Open a folder, a tileset.json, a .3tz archive, a URL, or an asset such as ``ion:96188``.

    Raises
    ------
    InputError
        The source does not exist, or is not allowed.
    """
    if place.startswith(ion.PREFIX):
        return ion.open_asset(place, network or Network())
    if _URL.match(place):
        return Http(place, network)
    path = Path(place)
    return Archive(path) if path.suffix.lower() == ".3tz" else Folder(path, network.root if network else None)
