"""Solver button: shows the cost of solving smoke that is only a preview, and selects the solver."""

from __future__ import annotations

from dataclasses import replace

import bpy

from ..blender import owned
from ..shot.source import ShotSource
from . import scene_file
from .job import InThread, Steps

OPERATOR = "firetwin.solve"


def replaced_method(panel: bpy.types.PropertyGroup) -> str:
    """Return the method of which the panel's smoke is a preview; empty if it is not a preview."""
    from ..smoke import sources

    return sources.known()[panel.smoke.method].preview_of


def estimate_cost(uid: int) -> Steps:
    """Estimate the cost of solving the smoke, if the scene with this `session_uid` shows a preview."""
    panel = owned.scene(uid).firetwin
    panel.smoke_cost = ""
    better = replaced_method(panel)
    if not panel.smoke.enabled or not better:
        return ""
    chosen = replace(scene_file.shot_source(panel), smoke=better)
    cost = yield InThread("estimating the cost of the smoke", lambda **_: _cost_text(chosen))
    owned.scene(uid).firetwin.smoke_cost = cost
    return cost


def _cost_text(chosen: ShotSource) -> str:
    """Return time and disk space as a short text; empty if the run includes its smoke, or nothing burns."""
    from ..smoke import sources

    cost = sources.select(chosen.shot()).cost()
    return cost.brief() if cost else ""


def draw(layout: bpy.types.UILayout, panel: bpy.types.PropertyGroup) -> None:
    """Draw the button with the cost, if a preview is shown."""
    if panel.run and panel.smoke.enabled and panel.smoke_cost and replaced_method(panel):
        layout.operator(OPERATOR, text=f"Solve smoke ({panel.smoke_cost})", icon="MOD_FLUIDSIM")
