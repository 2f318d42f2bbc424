"""Clipping and orientation of 3D views, in a scene a hundred kilometres wide."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy
import numpy as np
from mathutils import Euler
from numpy.typing import NDArray

from ..blender import viewport
from . import panel_state, working

_TILT = 0.9  # rad from straight down


def scene_views(scene: bpy.types.Scene) -> Iterator[bpy.types.SpaceView3D]:
    """Return the 3D views of the windows that show a scene."""
    for window in bpy.context.window_manager.windows:
        if window.scene == scene:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    yield area.spaces.active


def extend_clipping(scene: bpy.types.Scene) -> None:
    """Extend the clipping range of a scene's views to its size, except where an artist has set it."""
    for space in scene_views(scene):
        viewport.clip(space, viewport.default_clip_range(), (viewport.NEAR, viewport.FAR))
        viewport.show_colours(space)


def restore_clipping(scene: bpy.types.Scene) -> None:
    """Restore the clipping range of views that `extend_clipping` changed."""
    for space in scene_views(scene):
        viewport.clip(space, (viewport.NEAR, viewport.FAR), viewport.default_clip_range())


def align_views(scene: bpy.types.Scene, whole: bool = False) -> None:
    """Align the views of a scene with its camera, or show the entire run from the south."""
    extend_clipping(scene)
    for space in scene_views(scene):
        region = space.region_3d
        if region is None:
            continue
        if scene.camera is not None and not whole:
            region.view_perspective = "CAMERA"
            region.view_camera_zoom, region.view_camera_offset = 10.0, (0.1, 0.0)  # next to the sidebar
            continue
        _overlook(region, (0.0, 0.0, scene.firetwin.height), scene.firetwin.extent)


def look_at_points(scene: bpy.types.Scene, points: NDArray[np.float64]) -> None:
    """Show points (n, 3) from the south in the views of a scene."""
    extend_clipping(scene)
    low, high = points.min(axis=0), points.max(axis=0)
    for space in scene_views(scene):
        if space.region_3d is not None:
            _overlook(space.region_3d, (0.5 * (low + high)).tolist(), float((high - low)[:2].max()))


def _overlook(region: bpy.types.RegionView3D, middle: Sequence[float], extent: float) -> None:
    region.view_perspective = "PERSP"
    region.view_location = middle
    region.view_distance = 1.8 * extent
    region.view_rotation = Euler((_TILT, 0.0, 0.0)).to_quaternion()


class FIRETWIN_OT_view(bpy.types.Operator):
    """View the scene and adapt the clipping distance to it"""

    bl_idname = "firetwin.view"
    bl_label = "View scene"
    bl_options = {"INTERNAL"}

    whole: bpy.props.BoolProperty(
        name="Whole run",
        description="View from above, from the south; off: through the camera",
        default=False,
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip."""
        if properties.whole:
            return "View the entire run from the south and above; the clipping distance includes all terrain"
        return "View through the scene's camera; the clipping distance includes all terrain"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return panel_state.require(cls, context)

    @working.report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        align_views(context.scene, self.whole)
        return {"FINISHED"}


classes = (FIRETWIN_OT_view,)
