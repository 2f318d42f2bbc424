"""Preview source: smoke of the flow on wider cells, solved in seconds."""

from __future__ import annotations

import functools

from .. import coarse, flow_frames
from .flow import FlowSource

METHOD = "coarse, in seconds"


class PreviewSource(FlowSource):
    """Smoke of a coarse flow, without exposure and close-ups."""

    name = "preview"
    preview_of = "flow"
    flow_type = coarse.CoarseFlow
    detailed = False

    @functools.cached_property
    def _layers(self) -> list[flow_frames.Layer]:
        return coarse.layers(self.flow.domains, self.shot.settings.smoke.voxel_size)


SOURCE = PreviewSource
