"""How a job may get tiles: which hosts, whether a missing one is an error, and Blender's own permission."""

from __future__ import annotations

import sys
from dataclasses import asdict, dataclass, replace
from typing import Any

from ...tiles.sources import Network

PREFERENCE = "allow it by Edit > Preferences > System > Network > Allow Online Access"


@dataclass(frozen=True)
class TileAccess:
    """How tiles may be had; plain values, for another process.

    Attributes
    ----------
    strict
        A tile that is missing is an error; otherwise an ancestor stands in and it is reported.
    online
        Servers may be asked; otherwise the cache and files of this machine are used alone.
    setting
        Where that is set, for messages.
    hosts, private
        As `Network` has them.
    """

    strict: bool = False
    online: bool = True
    setting: str = "leave out --offline"
    hosts: tuple[str, ...] = ()
    private: bool = False

    def plain(self) -> dict[str, Any]:
        """Plain form, which `from_plain` takes."""
        return asdict(self)

    def network(self) -> Network:
        """What a source may ask of the network."""
        return Network(self.online, self.setting, tuple(self.hosts), self.private)


def from_plain(values: dict[str, Any]) -> TileAccess:
    """Access from its plain form; JSON has made its tuples lists."""
    return TileAccess(**values | {"hosts": tuple(values["hosts"])})


def apply_preferences(access: TileAccess) -> TileAccess:
    """What Blender's preferences leave of it, where this is Blender; asked anew by each job."""
    return access if is_online() else replace(access, online=False, setting=PREFERENCE)


def is_online() -> bool:
    """Whether the user lets Blender use the network; Python without Blender's window has no such setting."""
    bpy = sys.modules.get("bpy")
    return bpy is None or bool(bpy.app.module) or bool(bpy.app.online_access)
