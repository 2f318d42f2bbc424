"""Solved smoke in place of puffs: what it costs is told, and a button accepts it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ..blender import owned
from . import choice
from .job import Away, Steps

if TYPE_CHECKING:
    from ..shot.source import Choice


OPERATOR = "firetwin.solve"


def price(uid: int) -> Steps:
    """Find out what solving the smoke would take, where the scene with this `session_uid` shows puffs."""
    panel = owned.scene(uid).firetwin
    panel.smoke_cost = ""
    if not panel.smoke.enabled or panel.smoke.method != "puffs":
        return ""
    chosen = replace(choice.from_panel(panel), smoke="flow")
    found = yield Away("estimating the cost of the smoke", lambda **_: _cost(chosen))
    owned.scene(uid).firetwin.smoke_cost = found
    return found


def _cost(chosen: Choice) -> str:
    """Time and room in a few words; empty where the run brings its smoke, or nothing burns."""
    from ..smoke import cost_estimate

    found = cost_estimate.cost(chosen.shot())
    return found.brief() if found else ""


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    """The button, which names the cost, where puffs are shown."""
    if panel.run and panel.smoke.enabled and panel.smoke.method == "puffs" and panel.smoke_cost:
        layout.operator(OPERATOR, text=f"Solve smoke ({panel.smoke_cost})", icon="MOD_FLUIDSIM")
