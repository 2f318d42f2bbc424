"""Panels of the features of this installation: the module or package `panel` in each feature's folder.

A panel can have `classes` to register, `properties` (a class of annotations for the scene), `menu` (lines of
the menu Firetwin by submenu), `register` and `unregister`. A panel that shows more of a run has
`look(folder)`, its state before the run is read, called in a thread, `start(folder, state)`, called after
that, and `draw_run(context, layout, folder)`, which draws lines into the panel Run.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from .. import plugins
from .menu_entries import Line

panels = plugins.of_features("panel")
classes = tuple(each for panel in panels for each in getattr(panel, "classes", ()))
properties = tuple(panel.properties for panel in panels if hasattr(panel, "properties"))


def menu_lines(submenu: str) -> tuple[Line, ...]:
    """Return the lines of the features in a submenu."""
    return tuple(line for panel in panels for line in getattr(panel, "menu", {}).get(submenu, ()))


def register() -> None:
    """Call `register` of the panels that have it."""
    for panel in panels:
        if hasattr(panel, "register"):
            panel.register()


def unregister() -> None:
    """Call `unregister` of all panels."""
    for panel in panels:
        if hasattr(panel, "unregister"):
            panel.unregister()


def look(folder: Path) -> list[Callable[[], None]]:
    """Look at a run before it is read; returns functions to call after that."""
    return [partial(each.start, folder, each.look(folder)) for each in panels if hasattr(each, "look")]


def draw_run(*place: Any) -> None:
    """Draw lines of the features into the panel Run: context, layout and folder."""
    for panel in panels:
        if hasattr(panel, "draw_run"):
            panel.draw_run(*place)
