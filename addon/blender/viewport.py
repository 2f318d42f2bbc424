"""Viewport settings of 3D views for a scene a hundred kilometres wide: clipping and colours."""

from __future__ import annotations

import bpy
import numpy as np

# m. Blender's default of 1000 m is too short for such a scene; below 20 m, depth precision is too low to
# separate distant smoke from the ground.
NEAR, FAR = 20.0, 500_000.0


def default_clip_range() -> tuple[float, float]:
    """Return the default clipping range (m) of Blender's views."""
    known = bpy.types.SpaceView3D.bl_rna.properties
    return known["clip_start"].default, known["clip_end"].default


def clip(space: bpy.types.SpaceView3D, before: tuple[float, float], after: tuple[float, float]) -> None:
    """Change the clipping range of a view from `before` to `after`; a range set by the artist stays."""
    if np.allclose((space.clip_start, space.clip_end), before, rtol=1.0e-6, atol=0.0):
        space.clip_start, space.clip_end = after


def show_colours(space: bpy.types.SpaceView3D) -> None:
    """Show colour attributes in solid views that show material colours."""
    if space.shading.color_type == "MATERIAL":
        space.shading.color_type = "VERTEX"


def prepare_file() -> None:
    """Set every view of the open file, as it will be saved, to show its scene through the camera."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == "VIEW_3D":
                    clip(space, default_clip_range(), (NEAR, FAR))
                    show_colours(space)
                    if space.region_3d is not None:
                        space.region_3d.view_perspective = "CAMERA"
