"""Live scene builder: ground, forest, smoke and flames of a shot in few objects, for fast 3D views."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ...blender import node_updates, owned
from ...progress import MessageCallback, Progress, no_message, silent
from ...shot.shot import Shot
from . import flames, forest, ground, labels, smoke, sun, switch

TRIANGLES = 1_200_000
"""Budget of triangles."""
_GROUND = 0.25  # share of the ground


def steps(
    shot: Shot,
    scene: bpy.types.Scene,
    budget: int | None = None,
    tell: MessageCallback = no_message,
    progress: Progress = silent,
) -> Iterator[str]:
    """Build the live scene of a built scene step by step; each step yields its name before it runs.

    Parameters
    ----------
    budget
        Limit on triangles; None: `TRIANGLES`.
    tell
        Receives each warning for the user.
    progress
        Receives the progress of long steps.
    """
    uid, budget = scene.session_uid, budget or TRIANGLES

    def stage() -> owned.Stage:
        return owned.stage(owned.scene(uid))  # an undo between steps replaces the scene

    try:
        yield "live smoke"
        baked = smoke.bake(shot.full, stage(), progress, tell)
        yield "live labels and ground"
        live = switch.empty(stage())
        shadow = smoke.shade(baked) if baked else None
        if baked:
            sheets = smoke.build(stage(), live, baked)
            budget -= 2 * sum(len(each.data.polygons) for each in sheets)
        sun.build(stage(), live)
        lettered = labels.build(shot, stage(), live)
        if lettered:
            budget -= len(lettered.data.loops) - 2 * len(lettered.data.polygons)
        base = ground.build(shot, stage(), live, round(_GROUND * budget), shadow)
        spare = budget - len(base.data.polygons)
        yield "live forest and flames"
        live = switch.collection(stage().scene)
        if live is not None:
            grown = forest.grow(shot)
            fire = flames.build(shot, stage(), live, round(flames.SHARE * budget), grown)
            spare -= 2 * len(fire.data.polygons) if fire else 0
            forest.build(shot, stage(), live, spare, shadow, grown)
    finally:
        node_updates.end_all()


def build(shot: Shot, scene: bpy.types.Scene, budget: int | None = None) -> None:
    """Build the live scene of a built scene."""
    for _ in steps(shot, scene, budget):
        pass
