"""Writes the smoke of single frames as OpenVDB files."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import firetwin_core
import numpy as np
from firetwin_core import lod, volume
from numpy.typing import NDArray

from .. import files
from ..errors import Error, writing
from ..shot import sun
from ..shot.fire import burning, heat_release
from ..shot.fire.fire import Cells, Fire
from ..shot.light import exposure
from ..shot.shot import Shot
from ..shot.smoke_scale import Scale
from . import cache, close_up, flow_frames, snapshots, stability
from .flow import Flow
from .view import resolution

Made = TypeVar("Made")
SHOWN = ("density", "dilution", "shade", "size", "glow")  # grids that the material asks for
_GLOW_BLOCK = 300.0  # m; flames this near each other light the smoke as one
_GLOW_COUNT = 400
_BLOCK, _INTERVAL = 400.0, 60.0  # m and s in which fuel that burns becomes one puff, at a fire of 15 km
_FLAME_HEIGHT = 20.0  # m over the ground, where their light comes from


class Baker:
    """Writes the smoke of single frames, several at once if need be."""

    def __init__(self, shot: Shot) -> None:
        self.shot = shot
        self.resolution = resolution(shot)
        whole = shot.settings.smoke.complete
        self.grids = None if whole else SHOWN
        self.sights = None if whole else shot.sights
        self.flow = Flow(shot) if solved(shot) else None
        self.times = shot.frames.times
        self._close_painter: flow_frames.Painter | None = None

    @functools.cached_property
    def cells(self) -> Cells:
        """What burns and makes puffs; cells of the interval that goes on at the last frame belong to its."""
        first = self.times[0] - self.shot.settings.smoke.max_age - burning.BURN_TIME
        return self.shot.fire.cells(first, self.times[-1] + 600.0)

    @functools.cached_property
    def painters(self) -> list[flow_frames.Painter]:
        """One for each layer of a solved flow."""
        found = flow_frames.layers(self.shot, self.flow)
        inner = found[-1].part.box if len(found) > 1 else None
        return [flow_frames.Painter(self.shot, layer, None if layer.fine else inner) for layer in found]

    def puffs(self, frame: int) -> volume.Puffs:
        """Smoke of a frame."""
        cells, time, scale = self.cells, float(self.times[frame - 1]), self.shot.scale
        return volume.puffs(
            time,
            cells.arrival,
            cells.fuel,
            cells.position,
            cells.wind,
            cells.area,
            max_age=self.shot.settings.smoke.max_age,
            burn_time=burning.BURN_TIME,
            smoke_fraction=self.shot.fire.smoke.per_heat * burning.HEAT,
            stability=stability.under(sun.at(self.shot.run, time)[1]),
            interval=scale.time(_INTERVAL),
            block=scale.length(_BLOCK),
            merge_radius=scale.length(stability.MERGE),
            seed=self.shot.settings.seed,
            smallest=1.2 * self.resolution.voxel,
        )

    def write(self, path: Path, frame: int) -> volume.Frame:
        """Write the volume of a frame: from the model's own smoke where the run has it, else as settings say.

        The file is there when it is complete, also where several threads or processes write it at once.
        """
        time = float(self.times[frame - 1])
        position, power = lights(self.shot.fire, time, self.shot.scale)
        if self.flow:
            return self._write_flow(path, frame, (position, power))
        own = self.shot.run.has("smoke_3d")
        more: dict[str, Any] = {
            "grids": self.grids,
            "sight": self._sight(frame),
            "metadata": self._metadata(
                time, "of the model, smoke_3d" if own else "puffs from burned fuel, heat and wind"
            ),
        }
        if len(power):
            more |= {"flame_position": position, "flame_power": power}
        mine = files.part_of(path)
        with writing(path):
            if own:
                written = self._write_levels(mine, time, more)
            else:
                written = volume.write_smoke(mine, self.puffs(frame), self.resolution.voxel, **more)
        _put(mine, path, written.bytes)
        return written

    def _metadata(self, time: float, smoke: str) -> dict[str, str]:
        return {
            "run": self.shot.run.name,
            "smoke": smoke,
            "model_time_s": f"{time:.3f}",
            "origin": "centre of the model grid, height 0; x east, y north, z up, metres",
            "firetwin_core": firetwin_core.__version__,
        }

    def _write_flow(self, path: Path, frame: int, lit: tuple[NDArray, NDArray]) -> volume.Frame:
        """Write the volumes of a frame of the flow, which is solved up to there; that of this path last."""
        self.flow.ready(frame)
        time = float(self.times[frame - 1])
        metadata = self._metadata(time, "a flow of the air, solved from the model's heat")
        lights = lit if self._dark(time) else None
        eyes = self.sights.eyes(frame) if self.sights else None
        beyond: flow_frames.Beyond | None = None
        for painter in self.painters:
            place = painter.layer.file(path.parent, frame)
            mine = files.part_of(place)
            what = mine, frame, lights, self._sight(frame), metadata, eyes, beyond
            with writing(place):
                written, beyond = self._unbroken(frame, functools.partial(painter.write, *what))
            _put(mine, place, written.bytes)
        if not self.painters:
            mine = files.part_of(path)
            with writing(path):
                nothing = {name: np.zeros((1, 1, 1)) for name in flow_frames.GRIDS}
                written = volume.write(mine, nothing, 100.0, metadata=metadata)
            _put(mine, path, written.bytes)
        return written

    def bricks(self, frame: int) -> list[volume.Bricks]:
        """The smoke of a frame of the flow for rays to be marched through, and no file."""
        self.flow.ready(frame)
        time = float(self.times[frame - 1])
        what = (
            frame,
            lights(self.shot.fire, time, self.shot.scale) if self._dark(time) else None,
            self._sight(frame),
        )
        found: list[volume.Bricks] = []
        beyond: flow_frames.Beyond | None = None
        painters = list(self.painters)
        window = close_up.window(self.shot, frame, painters[-1].layer.voxel) if painters else None
        if window is not None and painters[-1].layer.fine:
            painters.append(self._close(painters[-1].layer, window))
        for painter in painters:
            fine = window if painter.layer.fine else None
            paint = functools.partial(painter.bricks, *what, beyond, fine)
            made, beyond = self._unbroken(frame, paint)
            found.append(made)
        return found

    def _close(self, layer: flow_frames.Layer, window: close_up.Window) -> flow_frames.Painter:
        """What paints a layer's part in a window."""
        if self._close_painter is None:
            close = replace(layer, voxel=window.voxel, close=True)
            self._close_painter = flow_frames.Painter(self.shot, close, None)
        return self._close_painter

    def _dark(self, time: float) -> bool:
        """Whether it is so dark at a model time (s) that smoke shows the flames' light."""
        return bool(exposure.darkness(self.shot, time) > 0.0)

    def _unbroken(self, frame: int, paint: Callable[[], Made]) -> Made:
        """What `paint` makes of a frame's moments, which are solved anew where they turn out broken."""
        try:
            return paint()
        except snapshots.BrokenError:
            self.flow.renew(frame)
            return paint()

    def _sight(self, frame: int) -> lod.Sight | None:
        """What the cameras see in a frame, if only that is wanted."""
        return self.sights.at(frame) if self.sights else None

    def _write_levels(self, path: Path, time: float, more: dict[str, Any]) -> volume.Frame:
        """Write the model's own smoke; outside of its times there is none."""
        run = self.shot.run
        known = float(np.clip(time, run.times[0], run.times[-1]))
        smoke = run.smoke_3d_at(known)
        if known != time:
            smoke[:] = 0.0
        if run.has("temperature_3d"):
            more["temperature"] = run.temperature_3d_at(known)
        return volume.write_levels(
            path,
            self.shot.local_frame,
            run.air_latitude,
            run.air_longitude,
            self.shot.relief.air,
            run.height_3d_at(known),
            smoke,
            self.resolution.voxel,
            **more,
        )


def solved(shot: Shot) -> bool:
    """Whether smoke is a solved flow: chosen, and the run has none of its own."""
    return shot.settings.smoke.method == "flow" and not shot.run.has("smoke_3d")


def integrated(shot: Shot) -> bool:
    """Whether frames of a shot are drawn without smoke in Cycles: it is marched, or there is none."""
    smoke, marched = shot.settings.smoke, solved(shot) and shot.settings.smoke.lighting == "solved"
    cycles = shot.settings.render.engine == "cycles"
    return cycles and smoke.draw == "integrated" and (marched or not smoke.enabled)


def _put(mine: Path, path: Path, size: int) -> None:
    """Give a complete file its name; who comes second replaces the same by the same."""
    try:
        cache.check(mine, size)
        files.publish(mine, path)
    except Error:  # Windows replaces no file that is being read
        mine.unlink(missing_ok=True)
        if not path.exists():
            raise


def lights(model: Fire, time: float, scale: Scale) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What lights the smoke from within: positions (n, 3) m and powers (n,) W of luminous heat."""
    found = heat_release.lights(model.sources(time).luminous(), scale.length(_GLOW_BLOCK), _GLOW_COUNT)
    return found.position + np.array([0.0, 0.0, scale.length(_FLAME_HEIGHT)]), found.power
