"""Visits of places: samples of one run and moment, which share a built scene and its solved smoke.

The members of a visit depend on the plan alone, not on the samples that are rendered. A sample that is
rendered alone builds the scene of its complete visit, so it is the same as in a batch. All members are of one
block of consecutive samples, so the visits of a block need no draws of other blocks. Needs no Blender.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..run import times
from ..run.readers import open as open_run
from ..shot.cameras import path, rotation
from ..shot.cameras.path import Path
from ..shot.cameras.rigs import kinds
from ..shot.schema.frame_list import FrameList
from ..shot.sections import Time
from ..shot.settings import Camera
from ..shot.shot import Shot
from . import air
from .draw import Draw
from .plan import Plan
from .run_scene import settings_of

MEMBERS = 12
"""Samples of a visit at most; with more cameras, each has fewer of the trees."""
_TREES, _UNDERSTOREY, _TREE_DISTANCE = 60_000, 8_000, 6_000.0  # limits on plants, and m
_ERROR = 0.2  # pixels, tolerance of the terrain mesh
_CELLS = 0.25  # million flow cells per second of model time
_FIREBRANDS = 600
_LAMPS = 16
_RAYS = 2  # samples per pixel; with the denoiser close to a draft frame of a film
_SENSOR = 36.0  # mm
_AIM = 1000.0  # m, distance of a camera's target, which only sets its name


BLOCK = 1000
"""Least number of samples of a block."""


def blocks(plan: Plan) -> list[range]:
    """Divide the samples of a plan into blocks, which do not depend on its number of samples.

    A block is large enough for full visits of each run and moment.
    """
    size = max(BLOCK, MEMBERS * len(plan.runs) * (plan.moments + 2))
    return [range(first, min(first + size, plan.count + 1)) for first in range(1, plan.count + 1, size)]


@dataclass(frozen=True)
class Visit:
    """A visit: draws of one run and moment, by their number."""

    draws: tuple[Draw, ...]

    @property
    def has_fire(self) -> bool:
        """True if its samples show fire and smoke."""
        return self.draws[0].has_fire


def visits(draws: Iterable[Draw]) -> list[Visit]:
    """Group the draws of a block into visits, in the order of their first samples."""
    groups: dict[tuple[str, int], list[Draw]] = {}
    for each in sorted(draws, key=lambda drawn: drawn.index):
        groups.setdefault((each.run, each.moment), []).append(each)
    return [Visit(tuple(part)) for listed in groups.values() for part in _chunks(listed)]


def _chunks(listed: list[Draw]) -> Iterator[list[Draw]]:
    """Split samples into parts of almost equal size."""
    count = -(-len(listed) // MEMBERS)
    for k in range(count):
        yield listed[k * len(listed) // count : (k + 1) * len(listed) // count]


def shot_of_visit(plan: Plan, visit: Visit) -> Shot:
    """Resolve the shot of a visit: a still with a camera for each sample.

    The sun is the date's; `shot_of_sample` has the sample's.
    """
    given = settings_of(plan.run(visit.draws[0].run))
    run = open_run(given.run)
    time = max(each.time for each in visit.draws)
    settings = replace(
        given,
        time=Time(start=times.utc(run, time), frames=1, shutter=0.0, zone=given.time.zone),
        terrain=replace(given.terrain, error=_ERROR),
        forest=replace(given.forest, budget=_TREES, understorey=_UNDERSTOREY, draw_distance=_TREE_DISTANCE),
        fire=replace(given.fire, firebrands=_FIREBRANDS, flames=visit.has_fire),
        smoke=replace(given.smoke, enabled=visit.has_fire, cell_budget=_CELLS),
        light=replace(given.light, lamps=min(given.light.lamps, _LAMPS)),
        labels=replace(given.labels, enabled=False),
        stations=replace(given.stations, enabled=False),
        render=replace(
            given.render,
            engine="cycles",
            resolution=plan.resolution,
            samples=_RAYS,
            passes=("rgb", "thermal", "masks"),
            denoise=True,
            video=False,
        ),
        runs=(),
        cameras=tuple(_camera(each) for each in visit.draws),
    )
    shot = Shot(settings, run)
    return _with_paths(shot, [_path(shot, each) for each in visit.draws])


def shot_of_sample(visited: Shot, drawn: Draw) -> Shot:
    """Resolve the shot of one sample of a visit; it shares the ground and the fire of the visit's shot.

    Call it, and use it, with the sample's sun (see `run.sun.fixed`).
    """
    camera = _camera(drawn)
    light = replace(visited.settings.light, haze=air.haze_amount(drawn))
    time = replace(visited.settings.time, start=times.utc(visited.run, drawn.time))
    render = replace(visited.settings.render, seed=drawn.random_seed("render") % (2**31))
    settings = replace(visited.settings, cameras=(camera,), light=light, time=time, render=render)
    shot = visited.with_settings(settings)
    shot.ground, shot.front = visited.ground, visited.front
    shot.paths = [next(each for each in visited.paths if each.camera.name == camera.name)]
    return shot


def _camera(drawn: Draw) -> Camera:
    """Make the settings of a sample's camera; its path replaces its position."""
    return Camera(name=drawn.name, rig=kinds()["drone"](), frames=FrameList())


def _path(shot: Shot, drawn: Draw) -> Path:
    """Make the path of a sample's camera: one pose."""
    frame, camera = shot.local_frame, drawn.camera
    place = np.array(camera.position)
    turned = rotation.turned(frame, place, camera.heading, camera.tilt, camera.roll)
    width, height = shot.settings.render.resolution
    half = float(np.tan(np.radians(camera.field_of_view) / 2.0))
    return Path(
        camera=next(each for each in shot.settings.cameras if each.name == drawn.name),
        position=place[None],
        rotation=turned[None],
        target=(place - _AIM * turned[:, 2])[None],
        half=(half, half * height / width),
        sensor=_SENSOR,
        width=width,
    )


def _with_paths(shot: Shot, paths: list[Path]) -> Shot:
    """Set the camera paths of a shot, and the ground with detail near them."""
    radius = shot.settings.terrain.near_radius
    shot.ground = shot.bare_ground.seen_from(path.eyes([each.position for each in paths], radius))
    shot.paths = paths
    return shot
