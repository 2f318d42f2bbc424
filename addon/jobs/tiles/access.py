"""Access of jobs to tiles: hosts, strictness, and Blender's permission for the network."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

from ...tiles.sources import Network

PREFERENCE = "allow it by Edit > Preferences > System > Network > Allow Online Access"


@dataclass(frozen=True)
class TileAccess:
    """Access to tiles.

    Attributes
    ----------
    strict
        A missing tile is an error; otherwise an ancestor replaces it, with a message.
    online
        Requests to servers are allowed; otherwise only the cache and files on this machine are used.
    setting
        Remedy for `online` being off, for messages.
    hosts, private, root
        As in `Network`; the root is empty for none.
    """

    strict: bool = False
    online: bool = True
    setting: str = "leave out --offline"
    hosts: tuple[str, ...] = ()
    private: bool = False
    root: str = ""

    def network(self) -> Network:
        """Return the network permissions of a source."""
        root = Path(self.root) if self.root else None
        return Network(self.online, self.setting, self.hosts, self.private, root=root)


def apply_preferences(access: TileAccess) -> TileAccess:
    """Restrict an access by Blender's current preferences, inside Blender."""
    return access if is_online() else replace(access, online=False, setting=PREFERENCE)


def is_online() -> bool:
    """Test whether Blender may use the network; always true for Python without Blender's window."""
    bpy = sys.modules.get("bpy")
    return bpy is None or bool(bpy.app.module) or bool(bpy.app.online_access)
