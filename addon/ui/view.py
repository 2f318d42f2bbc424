"""The 3D views of a world of a hundred kilometres: how far they see, and where from."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
from firetwin_core.run import Run
from mathutils import Euler

from .. import areas

# m. Blender's own 1000 m show nothing of such a world; nearer than 20 m, depths are too coarse to tell far
# smoke from the ground.
NEAR, FAR = 20.0, 500_000.0
_TILT = 0.9  # rad from straight down


def spaces() -> Iterator[bpy.types.SpaceView3D]:
    """All 3D views of all windows."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                yield area.spaces.active


def look(context: bpy.types.Context, scene: bpy.types.Scene, whole: bool = False) -> None:
    """Let every view see the whole distance, through the scene's camera or the whole run from the south."""
    for space in spaces():
        space.clip_start, space.clip_end = NEAR, FAR
        region = space.region_3d
        if region is None:
            continue
        if scene.camera is not None and not whole:
            region.view_perspective = "CAMERA"
            region.view_camera_zoom, region.view_camera_offset = 10.0, (0.1, 0.0)  # beside the sidebar
            continue
        region.view_perspective = "PERSP"
        region.view_location = (0.0, 0.0, scene.firetwin.height)
        region.view_distance = 1.8 * scene.firetwin.extent
        region.view_rotation = Euler((_TILT, 0.0, 0.0)).to_quaternion()


def remember(settings: bpy.types.PropertyGroup, run: Run) -> None:
    """Keep how large the run is."""
    dx, dy = areas.spacing(run.latitude, run.longitude)
    settings.extent = max(dx * len(run.longitude), dy * len(run.latitude))
    settings.height = float(np.nanmean(run.elevation))


def clear_startup(scene: bpy.types.Scene) -> bool:
    """Remove the cube, light and camera that a new file begins with; whether there were just these."""
    names = {thing.name for thing in scene.objects}
    cube = scene.objects.get("Cube")
    untouched = (
        not bpy.data.filepath
        and names == {"Camera", "Cube", "Light"}
        and cube.type == "MESH"
        and len(cube.data.vertices) == 8
        and cube.matrix_world.is_identity
    )
    if untouched:
        bpy.data.batch_remove([scene.objects[name] for name in names])
    return untouched


class FIRETWIN_OT_view(bpy.types.Operator):
    """Look at the scene, as far as it reaches"""

    bl_idname = "firetwin.view"
    bl_label = "View scene"
    bl_options = {"INTERNAL"}

    whole: bpy.props.BoolProperty(
        name="Whole run", description="From above the south, instead of through the camera", default=False
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The tooltip."""
        if properties.whole:
            return "Look at the whole run from above the south, as far as the ground reaches"
        return "Look through the scene's camera, as far as the ground reaches"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.scene.firetwin.first_time:
            cls.poll_message_set("Build the scene first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        look(context, context.scene, self.whole)
        return {"FINISHED"}
