"""Live scene builder: ground, forest, smoke and flames of a shot in few objects, for fast 3D views."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ...blender import node_updates, owned
from ...progress import MessageCallback, Progress, no_message, silent
from ...shot.shot import Shot
from . import forest, ground, switch

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
    try:
        yield "live ground"
        stage = owned.stage(owned.scene(uid))
        live = switch.empty(stage)
        base = ground.build(shot, stage, live, round(_GROUND * budget), None)
        spare = budget - len(base.data.polygons)
        yield "live forest"
        stage = owned.stage(owned.scene(uid))
        live = switch.collection(stage.scene)
        forest.build(shot, stage, live, spare, None)
    finally:
        node_updates.end_all()


def build(shot: Shot, scene: bpy.types.Scene, budget: int | None = None) -> None:
    """Build the live scene of a built scene."""
    for _ in steps(shot, scene, budget):
        pass
