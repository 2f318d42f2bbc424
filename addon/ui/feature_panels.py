"""Panels of the installed optional features.

A panel's module has `classes` to register, `properties` (a class of annotations for the scene) and
`unregister`.
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

classes = tuple(each for panel in panels for each in panel.classes)
properties = tuple(panel.properties for panel in panels)


def unregister() -> None:
    """Call `unregister` of all panels."""
    for panel in panels:
        panel.unregister()
