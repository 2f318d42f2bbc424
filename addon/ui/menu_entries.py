"""Entries of the menu Firetwin."""

from __future__ import annotations

from typing import Any, NamedTuple


class MenuEntry(NamedTuple):
    """A menu entry: operator, text (empty: the operator's name), icon, and its options."""

    operator: str
    text: str = ""
    icon: str = "NONE"
    options: dict[str, Any] = {}
    choice: str = ""  # option of which the entry is a submenu


class Submenu(NamedTuple):
    """A menu of another module, by its `bl_idname`, with a text that is complete in F3."""

    name: str
    text: str


Line = MenuEntry | Submenu
