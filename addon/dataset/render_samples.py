"""Samples of a plan, rendered: one scene for each visit, in which each sample moves camera, sun and air.

Each sample sets the whole state of the scene that it needs, so no sample depends on those before it.
"""

from __future__ import annotations

import tempfile
from collections.abc import Collection, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..progress import MessageCallback, no_message
from ..render.frame_cost import FrameCost
from ..run import sun, times
from ..shot.shot import Shot
from . import air, places
from .draw import Draw
from .places import Visit
from .plan import Plan
from .rendered import Rendered, SampleCamera

if TYPE_CHECKING:
    from ..blender.owned import Stage
    from ..smoke.sources import Source
    from .sample_renderer import SampleRenderer

_SKY_MAP = 64
"""Columns of Cycles' importance map of the sky; Blender's default takes 2.8 processor seconds a sample."""
_MOVED = "fire", "smoke", "light", "cameras"
"""Parts of the scene that are built for each sample; terrain and forest are the visit's."""


def render(
    plan: Plan, visit: Visit, wanted: Collection[int], tell: MessageCallback = no_message
) -> Iterator[tuple[Draw, Rendered]]:
    """Build the scene of a visit in an otherwise empty Blender, and yield its wanted samples, rendered.

    Parameters
    ----------
    wanted
        Numbers of samples.
    """
    chosen = [each for each in visit.draws if each.index in wanted]
    if not chosen:
        return
    scene = _VisitScene(plan, visit, tell)
    for drawn in chosen:
        yield drawn, scene.render(drawn)


class _VisitScene:
    """Built scene of a visit."""

    def __init__(self, plan: Plan, visit: Visit, tell: MessageCallback) -> None:
        from ..jobs import worker_scene
        from ..render import engine
        from ..scene.forest import stand
        from ..scene.forest.frame_culling import FrameCulling
        from ..smoke import sources
        from .sample_renderer import SampleRenderer

        self.visit, self.tell, self.cost = visit, tell, FrameCost()
        with self.cost.part("smoke solved"):
            self.shot = places.shot_of_visit(plan, visit)
            self.source = sources.select(self.shot) if visit.has_fire else None
            if self.source:
                self.source.prepare([1])
        with self.cost.part("scene built"):
            self.grown = stand.grow(self.shot, in_film=False) if self.shot.settings.forest.trees else None
            self.stage: Stage = worker_scene.build_scene(self.shot, lambda *_: None, tell, self.grown)
            engine.check_working_space()
            self.renderer: SampleRenderer = SampleRenderer(self.shot, self.stage)
            self.culling = FrameCulling(self.shot, self.stage)

    def render(self, drawn: Draw) -> Rendered:
        """Render a sample."""
        light = sun.fixed(drawn.sun_azimuth, drawn.sun_elevation, air.moon(drawn))
        with light, tempfile.TemporaryDirectory() as folder:
            return self._render(drawn, Path(folder))

    def _render(self, drawn: Draw, folder: Path) -> Rendered:
        from .. import memory

        cost = FrameCost()
        with cost.part("scene moved"):
            shot = places.shot_of_sample(self.shot, drawn)
            self._move(shot, drawn)
        with cost.part("smoke painted"):
            smoke = self._smoke(shot).bricks(1) if self.source else []
        maps = self.renderer.maps(shot, smoke, folder, cost, drawn.values["exposure"])
        if not drawn.has_fire:  # lamps count as flames in the layers
            maps |= {name: np.zeros_like(maps[name]) for name in ("fire", "twin_fire")}
        memory.release_freed()
        return Rendered(
            **maps,
            camera=_camera(shot),
            time=times.utc(shot.run, drawn.time),
            model_time=drawn.time,
            facts=self._facts(cost) | {"moon": asdict(air.moon(drawn)), "haze": shot.settings.light.haze},
        )

    def _move(self, shot: Shot, drawn: Draw) -> None:
        """Move camera, sun, time and air of the scene for a sample."""
        from ..render import layers
        from ..scene import build
        from . import clouds, night_lamps, scene_air

        stage = self.stage
        for _ in build.steps(shot, stage.scene, _MOVED, self.tell, self.grown):
            pass
        scene_air.apply(stage, drawn)
        clouds.build(shot, stage, drawn)
        night_lamps.build(shot, stage, drawn)
        layers.complete(shot.settings, stage, (*_MOVED, "labels"))
        stage.scene.cycles.denoising_quality = "FAST"  # the sensor adds noise and blur afterwards
        sampled = stage.scene.world.cycles
        sampled.sampling_method, sampled.sample_map_resolution = "MANUAL", _SKY_MAP
        stage.scene.cycles.seed = shot.settings.render.seed
        stage.scene.camera = stage.camera(drawn.name)
        stage.scene.frame_set(1)
        self.culling.shot = shot
        self.culling.apply(1)
        self.renderer.hide_volumes()

    def _smoke(self, shot: Shot) -> Source:
        """Return the source of a sample's smoke: the visit's flow, painted for the sample's view."""
        from ..smoke import sources
        from ..smoke.sources.flow import FlowSource

        source = sources.select(shot)
        if isinstance(source, FlowSource) and isinstance(self.source, FlowSource):
            source.flow = self.source.flow
        return source

    def _facts(self, cost: FrameCost) -> dict[str, Any]:
        """Return the processor seconds of a sample's parts, and its share of the visit's."""
        share = {name: value / len(self.visit.draws) for name, value in self.cost.seconds.items()}
        parts = share | cost.seconds
        return {"processor_seconds": {name: round(value, 2) for name, value in parts.items()}}


def _camera(shot: Shot) -> SampleCamera:
    """Describe the camera of a sample's shot."""
    (view,) = shot.paths
    width, height = shot.settings.render.resolution
    to_world = np.eye(4)
    to_world[:3, :3], to_world[:3, 3] = view.rotation[0], view.position[0]
    return SampleCamera(
        to_world=to_world,
        fx=0.5 * width / view.half[0],
        fy=0.5 * height / view.half[1],
        cx=0.5 * width,
        cy=0.5 * height,
        width=width,
        height=height,
    )
