"""Scene builder: builds all parts of a shot's scene, or selected parts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np

from ..blender import node_updates, owned
from ..progress import MessageCallback
from ..shot.light import exposure
from ..shot.shot import Shot, cached_in_film
from ..shot.surface import footprints
from ..shot.tiles import tile_cut
from . import clock, curved_air, infrared, temperature
from .camera import build as camera
from .fire import build as fire
from .forest import biomes, stand
from .forest import build as forest
from .labels import build as labels
from .light import build as light
from .smoke import build as smoke
from .stations import build as stations
from .terrain import build as ground
from .tiles import build as tiles
from .tiles import preview

PARTS = {
    "terrain": "building the ground",
    "forest": "planting the forest",
    "fire": "lighting the fire",
    "smoke": "building the smoke",
    "light": "setting the sun",
    "cameras": "setting the cameras",
    "labels": "naming the places",
    "stations": "placing station signs",
}
"""Parts that can be built separately, each with its progress message."""

_WITH_STAND = {"terrain", "forest", "fire"}  # parts that depend on the positions of individual trees


def build(
    shot: Shot,
    scene: bpy.types.Scene | None = None,
    parts: Sequence[str] = tuple(PARTS),
    tell: Callable[[str], None] = lambda _: None,
) -> bpy.types.Scene:
    """Build parts into `scene` (default: the current scene), replacing earlier objects of these parts.

    In a user's scene (see `owned.adopt`), engine, world, colour management, frame range, view layers and
    compositor are not changed.
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
    grown: stand.Stand | None = None,
) -> Iterator[str]:
    """Build parts step by step; each step yields its name before it runs.

    The user may rename the scene or undo an operation between two steps, so each step looks it up again.

    Parameters
    ----------
    tell
        Receives each warning for the user, such as a part that could not be built as requested.
    grown
        The forest's trees, if they are already known.
    """
    try:
        yield from _steps(shot, scene, parts, tell, grown)
    finally:
        node_updates.end_all()


def _steps(
    shot: Shot,
    scene: bpy.types.Scene,
    parts: Sequence[str],
    tell: Callable[[str], None],
    grown: stand.Stand | None,
) -> Iterator[str]:
    uid, shape = scene.session_uid, None

    def stage() -> owned.Stage:
        return owned.stage(owned.scene(uid))

    yield "surveying the ground"
    _ = shot.paths
    curved_air.set_frame(stage(), shot.local_frame if shot.beyond else None)
    clock.build(shot, stage())
    temperature.build(shot, stage())
    infrared.build(shot, stage())
    if set(parts) == set(PARTS):
        clock.set_frame_range(shot, stage())
    if grown is None and shot.settings.forest.trees and _WITH_STAND & set(parts):
        yield "growing the forest"
        if "terrain" in parts:
            name = f"forest of {' and '.join(each.name for each in shot.settings.cameras)}"
            grown, shape = cached_in_film(name, shot, lambda: _grow_and_shape(shot), biomes.choose(shot))
        else:
            grown = stand.grow(shot)

    def lit() -> None:
        for sentence in light.build(shot.full, stage()):
            tell(sentence)

    builders: dict[str, Callable[[], object]] = {
        "terrain": lambda: _build_terrain(shot, stage(), grown, shape, tell),
        "forest": lambda: forest.build(shot, stage(), grown),
        "fire": lambda: fire.build(shot, stage(), grown),
        "smoke": lambda: smoke.build(shot.full, stage()),
        "light": lit,
        "cameras": lambda: camera.build(shot, stage()),
        "labels": lambda: labels.build(shot, stage()),
        "stations": lambda: stations.build(shot, stage()),
    }
    for part, text in PARTS.items():
        if part in parts:
            yield text
            builders[part]()


def _build_terrain(
    shot: Shot,
    stage: owned.Stage,
    grown: stand.Stand | None,
    shape: ground.Shape | None,
    tell: MessageCallback,
) -> None:
    preview.remove(stage)
    ground.build(shot, stage, grown, shape)
    if sentence := footprints.summary(shot):
        tell(sentence)
    if cut := tile_cut.of_shot(shot):
        tiles.build(shot, stage, cut, grown)
    else:
        tiles.remove(stage)


def _grow_and_shape(shot: Shot) -> tuple[stand.Stand, ground.Shape]:
    """Generate the stand and the terrain mesh in parallel threads, each of which uses one core.

    Neither calls Blender. The exposure is computed in parallel and cached. All results are ready on return.
    """
    shot.visibility.distance([(0.0, 0.0, 0.0)])  # compute their shared inputs first
    with ThreadPoolExecutor(1) as beside:
        shaping = beside.submit(ground.make_shape, shot)
        metering = beside.submit(exposure.at, shot, np.ones(1))
        grown = stand.grow(shot)
        metering.result()
        return grown, shaping.result()


def remove(scene: bpy.types.Scene) -> None:
    """Remove all objects that Firetwin built in a scene, and nothing else."""
    clock.remove(scene)
    owned.remove(scene)
