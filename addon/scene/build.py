"""Builds the scene of a shot, or some parts of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np

from ..blender import owned
from ..shot.light import exposure
from ..shot.shot import Shot
from . import clock, infrared, temperature
from .camera import build as camera
from .fire import build as fire
from .forest import build as forest
from .forest import stand
from .labels import build as labels
from .light import build as light
from .smoke import build as smoke
from .terrain import build as ground

PARTS = {
    "terrain": "building the ground",
    "forest": "planting the forest",
    "fire": "lighting the fire",
    "smoke": "hanging the smoke",
    "light": "setting the sun",
    "cameras": "setting the cameras",
    "labels": "naming the places",
}
"""What can be built by itself, and what is told while it is."""

_WITH_STAND = {"terrain", "forest", "fire"}  # parts that need to know where single trees stand


def build(
    shot: Shot,
    scene: bpy.types.Scene | None = None,
    parts: Sequence[str] = tuple(PARTS),
    tell: Callable[[str], None] = lambda _: None,
) -> bpy.types.Scene:
    """Build parts into `scene` (the current one unless given); what was built of them before goes first.

    Of a scene that is not our own (see `owned.adopt`) nothing else is changed: engine, world, colours,
    frames, view layers and compositor stay.
    """
    scene = scene or bpy.context.scene
    for _ in steps(shot, scene, parts, tell):
        pass
    return scene


def steps(
    shot: Shot,
    scene: bpy.types.Scene,
    parts: Sequence[str] = tuple(PARTS),
    tell: Callable[[str], None] = lambda _: None,
) -> Iterator[str]:
    """Build parts step by step, each named before it is taken.

    Between two steps people may rename the scene or undo something else: it is looked up for each of them.

    Parameters
    ----------
    tell
        Is given every sentence that people should read: what could not be built as it should be.
    """
    uid, grown, shape = scene.session_uid, None, None

    def stage() -> owned.Stage:
        return owned.stage(owned.scene(uid))

    yield "surveying the ground"
    _ = shot.paths
    clock.build(shot, stage())
    temperature.build(shot, stage())
    infrared.build(shot, stage())
    if set(parts) == set(PARTS):
        clock.frames(shot, stage())
    if shot.settings.forest.trees and _WITH_STAND & set(parts):
        yield "growing the forest"
        if "terrain" in parts:
            grown, shape = _grown_and_shaped(shot)
        else:
            grown = stand.grow(shot)
    builders = {
        "terrain": lambda: ground.build(shot, stage(), grown, shape),
        "forest": lambda: forest.build(shot, stage(), grown),
        "fire": lambda: fire.build(shot, stage(), grown),
        "smoke": lambda: smoke.build(shot.full, stage()),
        "light": lambda: [tell(text) for text in light.build(shot.full, stage())],
        "cameras": lambda: camera.build(shot, stage()),
        "labels": lambda: labels.build(shot, stage()),
    }
    for part, text in PARTS.items():
        if part in parts:
            yield text
            builders[part]()


def _grown_and_shaped(shot: Shot) -> tuple[stand.Stand, ground.Shape]:
    """The stand and the ground's mesh at once: each has much to do that keeps one core busy.

    Neither asks Blender for anything, nor does the exposure, which is remembered; all are there before it
    goes on.
    """
    shot.visibility.distance([(0.0, 0.0, 0.0)])  # what they need of them is made now
    with ThreadPoolExecutor(1) as beside:
        shaping = beside.submit(ground.shape, shot)
        metering = beside.submit(exposure.at, shot, np.ones(1))
        grown = stand.grow(shot)
        metering.result()
        return grown, shaping.result()


def remove(scene: bpy.types.Scene) -> None:
    """Take away all that was built into a scene, and no more."""
    clock.remove(scene)
    owned.remove(scene)
