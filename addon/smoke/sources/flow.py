"""Flow source: smoke of an air flow that is solved once per shot from the model's heat."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import numpy as np
from firetwin_core import volume

from ... import files
from ...errors import writing
from ...progress import Progress, silent
from ...shot.light import exposure
from ...shot.shot import Shot
from .. import cache, close_up, cost_estimate, flow_frames, shutter, snapshots, view
from ..domains import Domain
from ..flow import Flow
from ._source import Lights, Source, VolumeLayer, allows_ray_march

METHOD = "solved once per shot"
Made = TypeVar("Made")
_EMPTY = 100.0  # m, voxel of the volume without fire
_COARSER = 2.0  # voxel size of sub-frames over the voxel size of frames


class FlowSource(Source):
    """Smoke of a solved flow, painted with subgrid detail and with the light that reaches it.

    Attributes
    ----------
    detailed
        True if smoke near the camera has finer voxels.
    """

    name = "flow"
    marched = True
    detailed: ClassVar[bool] = True

    def __init__(self, shot: Shot) -> None:
        super().__init__(shot)
        self.exposure = shutter.exposure(shot) if allows_ray_march(shot) else 0.0
        self.parts = shutter.parts(self.exposure)
        self.flow = self._flow_type()(shot.with_sub_frames(self.parts), lambda *done: self.progress(*done))
        self.flow.elsewhere, self.flow.stop = lambda: self.elsewhere(), self.stop
        self._cached_close_up: flow_frames.Painter | None = None

    def _flow_type(self) -> type[Flow]:
        """Return the kind of the flow."""
        return Flow

    def inputs(self) -> dict[str, Any]:
        """Return the folders of its snapshots."""
        return {"flow": self.flow.key()}

    def voxels(self) -> list[Any]:
        """Return layers with their voxel sizes, and the flow's cell sizes, m."""
        return [[layer.name, layer.voxel, self.shot.scale.cell] for layer in self._layers]

    @property
    def domains(self) -> list[Domain]:
        """Return the flow domains."""
        return self.flow.domains

    def cost(self) -> cost_estimate.Cost | None:
        """Estimate the cost of the remaining solution."""
        return cost_estimate.estimate(self.flow)

    def is_prepared(self, frame: int) -> bool:
        """Return whether the frame's snapshots exist."""
        return all(self.flow.has(number) for _, number in self._sub_frames(frame))

    def solutions(self) -> frozenset[str]:
        """Return the folders of its snapshots."""
        return frozenset(self.flow.key())

    def prepare(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """Solve the flow up to the last of these frames."""
        super().prepare(frames, progress)
        numbers = {number for frame in frames for _, number in self._sub_frames(frame)}
        self.flow.solve(numbers, progress)

    def in_use(self) -> AbstractContextManager[None]:
        """Protect the snapshots from eviction while in use."""
        return self.flow.in_use()

    def layers(self) -> list[VolumeLayer]:
        """Return the volume layers of both domains; one empty volume without fire."""
        thickest = flow_frames.max_extinction(self.shot.scale)
        step = view.SOLVED_STEP_DEPTH / thickest
        result = [
            VolumeLayer(layer.name, layer.voxel, step * (1.0 if layer.fine else 2.0), thickest)
            for layer in self._layers
        ]
        return result or [VolumeLayer("smoke", _EMPTY, _EMPTY, thickest)]

    def painted_voxels(self) -> int:
        """Return the number of voxels of the largest layer's domain, with or without smoke."""
        return max((_voxels(layer) for layer in self._layers), default=0)

    def write(self, path: Path, frame: int) -> volume.VdbSummary:
        """Write the volumes of a solved frame; `path` is written last."""
        self.flow.ready(self.snapshot(frame))
        time = float(self.times[frame - 1])
        metadata = self.metadata(time, "a flow of the air, solved from the model's heat")
        eyes = self.visibility.eyes(frame) if self.visibility else None
        beyond: flow_frames.OuterLayer | None = None
        for painter in self.painters:
            place = painter.layer.file(path.parent, frame)
            mine = files.temporary_path(place)
            inputs = (
                mine,
                self.snapshot(frame),
                self._glow(time),
                self.view_set(frame),
                metadata,
                eyes,
                beyond,
            )
            paint = functools.partial(painter.write, *inputs)
            with writing(place):
                written, beyond = self._with_intact_snapshots(self.snapshot(frame), paint)
            cache.publish(mine, place, written.bytes)
        if not self.painters:
            mine = files.temporary_path(path)
            with writing(path):
                nothing = {name: np.zeros((1, 1, 1)) for name in flow_frames.GRIDS}
                written = volume.write(mine, nothing, _EMPTY, metadata=metadata)
            cache.publish(mine, path, written.bytes)
        return written

    def bricks(self, frame: int) -> list[volume.Bricks]:
        """Return the bricks of a frame and of its exposure, for ray marching without a file.

        Voxels of sub-frames are wider: their average shows no detail that is finer.
        """
        middle = self.snapshot(frame)
        own = self._bricks(frame, middle, self.painters)
        moments = self._sub_frames(frame)
        if len(moments) == 1:
            return own
        exposed = [
            (weight, own if number == middle else self._bricks(frame, number, self._coarse_painters))
            for weight, number in moments
        ]
        return shutter.ExposedSmoke(own, exposed)

    def snapshot(self, frame: int) -> int:
        """Return the number of a frame's snapshot."""
        return (frame - 1) * self.parts + 1

    def _sub_frames(self, frame: int) -> list[tuple[float, int]]:
        """List weights and snapshots of a frame's exposure."""
        return shutter.sub_frames(frame, self.exposure, self.shot.frames.count)

    def _bricks(self, frame: int, number: int, painters: list[flow_frames.Painter]) -> list[volume.Bricks]:
        """Return the bricks of a snapshot, culled for a frame."""
        self.flow.ready(number)
        time = float(self.flow.shot.frames.times[number - 1])
        inputs = (number, self._glow(time), self.view_set(frame))
        result: list[volume.Bricks] = []
        beyond: flow_frames.OuterLayer | None = None
        close = self.detailed and painters and painters[-1].layer.voxel == self._layers[-1].voxel
        window = close_up.window(self.shot, frame, painters[-1].layer.voxel) if close else None
        if window is not None and painters[-1].layer.fine:
            painters = [*painters, self._close_up_painter(painters[-1].layer, window)]
        for painter in painters:
            fine = window if painter.layer.fine else None
            paint = functools.partial(painter.bricks, *inputs, beyond, fine)
            made, beyond = self._with_intact_snapshots(number, paint)
            result.append(made)
        return result

    @functools.cached_property
    def _layers(self) -> list[flow_frames.Layer]:
        return flow_frames.layers(self.shot, self.flow)

    @functools.cached_property
    def painters(self) -> list[flow_frames.Painter]:
        """Return a painter for each layer."""
        return self._painters(self._layers)

    @functools.cached_property
    def _coarse_painters(self) -> list[flow_frames.Painter]:
        """Return the painters of sub-frames."""
        return self._painters([replace(layer, voxel=_COARSER * layer.voxel) for layer in self._layers])

    def _painters(self, layers: list[flow_frames.Layer]) -> list[flow_frames.Painter]:
        inner = layers[-1].domain.box if len(layers) > 1 else None
        shot = self.flow.shot
        return [flow_frames.Painter(shot, layer, None if layer.fine else inner) for layer in layers]

    def _close_up_painter(self, layer: flow_frames.Layer, window: close_up.Window) -> flow_frames.Painter:
        """Return the painter of a layer's part within a close-up window."""
        if self._cached_close_up is None:
            close = replace(layer, voxel=window.voxel, close=True)
            self._cached_close_up = flow_frames.Painter(self.flow.shot, close, None)
        return self._cached_close_up

    def _glow(self, time: float) -> Lights | None:
        """Return the lights of flames in smoke; None at a model time (s) of daylight that outshines them."""
        return self.lights(time) if exposure.darkness(self.shot, time) > 0.0 else None

    def _with_intact_snapshots(self, number: int, paint: Callable[[], Made]) -> Made:
        """Return the result of `paint` on a snapshot. A broken one is solved again."""
        try:
            return paint()
        except snapshots.BrokenError:
            self.flow.renew(number)
            return paint()


def _voxels(layer: flow_frames.Layer) -> int:
    """Return the number of voxels of a layer's domain, with or without smoke."""
    box = layer.domain.box
    sides = (*(count * box.spacing for count in box.shape), box.levels[-1])
    return math.prod(math.ceil(side / layer.voxel) for side in sides)


SOURCE = FlowSource
