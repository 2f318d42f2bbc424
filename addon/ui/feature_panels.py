"""Panels of the installed optional features.

A panel's module has `classes` to register, `properties` (a class of annotations for the scene), `unregister`
and, if it has more than classes, `register`.
"""

from __future__ import annotations

from types import ModuleType

from .. import optional_features

panels: list[ModuleType] = []
if optional_features.is_installed("farm"):
    from . import farm

    panels.append(farm)
if optional_features.is_installed("allocation"):
    from . import allocation

    panels.append(allocation)
if optional_features.is_installed("export"):
    from . import exports

    panels.append(exports)

classes = tuple(each for panel in panels for each in panel.classes)
properties = tuple(panel.properties for panel in panels)


def register() -> None:
    """Call `register` of the panels that have it."""
    for panel in panels:
        if hasattr(panel, "register"):
            panel.register()


def unregister() -> None:
    """Call `unregister` of all panels."""
    for panel in panels:
        panel.unregister()
