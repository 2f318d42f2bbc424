"""Solved smoke in place of a preview: the panel tells what it costs, and a button accepts it."""

from __future__ import annotations

from dataclasses import replace

import bpy

from ..blender import owned
from ..shot.source import ShotSource
from . import choice
from .job import InThread, Steps

OPERATOR = "firetwin.solve"


def replacement(panel: bpy.types.PropertyGroup) -> str:
    """The method that the panel's smoke is a preview of; empty where it is none."""
    from ..smoke import sources

    return sources.known()[panel.smoke.method].preview_of


def price(uid: int) -> Steps:
    """Find out what solving the smoke would take, where the scene with this `session_uid` shows a preview."""
    panel = owned.scene(uid).firetwin
    panel.smoke_cost = ""
    better = replacement(panel)
    if not panel.smoke.enabled or not better:
        return ""
    chosen = replace(choice.from_panel(panel), smoke=better)
    found = yield InThread("estimating the cost of the smoke", lambda **_: _cost(chosen))
    owned.scene(uid).firetwin.smoke_cost = found
    return found


def _cost(chosen: ShotSource) -> str:
    """Time and room in a few words; empty where the run brings its smoke, or nothing burns."""
    from ..smoke import sources

    found = sources.select(chosen.shot()).cost()
    return found.brief() if found else ""


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    """The button, which names the cost, where a preview is shown."""
    if panel.run and panel.smoke.enabled and panel.smoke_cost and replacement(panel):
        layout.operator(OPERATOR, text=f"Solve smoke ({panel.smoke_cost})", icon="MOD_FLUIDSIM")
