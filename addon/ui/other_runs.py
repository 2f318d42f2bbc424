"""Comparison runs of the scene file in the .blend file: `scene.firetwin.runs`, one item per run."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..shot.schema import fields
from ..shot.settings import OtherRun
from . import sections

FIRETWIN_PG_otherrun = sections.group_class(OtherRun)


def list_runs(panel: bpy.types.PropertyGroup) -> tuple[OtherRun, ...]:
    """Return all comparison runs in order."""
    return tuple(sections.take(item, fields(OtherRun), OtherRun()) for item in panel.runs)


def fill(panel: bpy.types.PropertyGroup, found: Iterable[OtherRun]) -> None:
    """Replace the list with these runs."""
    panel.runs.clear()
    for each in found:
        sections.put(panel.runs.add(), fields(OtherRun), each)


classes = (FIRETWIN_PG_otherrun,)
