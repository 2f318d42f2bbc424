"""Preview source: smoke of the flow on wider cells, solved in seconds."""

from __future__ import annotations

import functools

from .. import coarse, flow_frames
from ..flow import Flow
from .flow import FlowSource

METHOD = "coarse, in seconds"


class PreviewSource(FlowSource):
    """Smoke of a coarse flow, without close-ups."""

    name = "preview"
    preview_of = "flow"
    detailed = False

    def _flow_type(self) -> type[Flow]:
        return coarse.LapseFlow if self.exposure else coarse.CoarseFlow

    @functools.cached_property
    def _layers(self) -> list[flow_frames.Layer]:
        return coarse.layers(self.flow.domains, self.shot.settings.smoke.voxel_size)


SOURCE = PreviewSource
