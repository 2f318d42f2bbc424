"""What a source may ask of the network."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from .http_cache import LIMIT, folder


@dataclass(frozen=True)
class Network:
    """What a source may ask of the network.

    Attributes
    ----------
    online
        Servers may be asked; otherwise only the cache answers.
    setting
        Where that is set, for messages.
    hosts
        Further hosts that files may lie on, besides the root's.
    private
        Addresses of private networks are allowed.
    cache
        Folder of the cache; None: none.
    limit
        Bytes of the cache.
    """

    online: bool = True
    setting: str = "leave out --offline"
    hosts: tuple[str, ...] = ()
    private: bool = False
    cache: Path | None = field(default_factory=folder)
    limit: int = LIMIT
