"""Panels of the features of this installation: the module or package `panel` in each feature's folder.

A panel has `classes` to register, `properties` (a class of annotations for the scene), `menu` (lines of the
menu Firetwin by submenu), `unregister`, and, if it has more than classes, `register`.
"""

from __future__ import annotations

from .. import plugins
from .menu_entries import Line

panels = tuple(plugins.parts(str(__package__).rpartition(".")[0], "panel").values())
classes = tuple(each for panel in panels for each in panel.classes)
properties = tuple(panel.properties for panel in panels)


def menu_lines(submenu: str) -> tuple[Line, ...]:
    """Return the lines of the features in a submenu."""
    return tuple(line for panel in panels for line in panel.menu.get(submenu, ()))


def register() -> None:
    """Call `register` of the panels that have it."""
    for panel in panels:
        if hasattr(panel, "register"):
            panel.register()


def unregister() -> None:
    """Call `unregister` of all panels."""
    for panel in panels:
        panel.unregister()
