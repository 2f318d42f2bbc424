"""The 3D views of Blender's window: what they must be set to for a world of a hundred kilometres to show."""

from __future__ import annotations

import bpy
import numpy as np

# m. Blender's own 1000 m show nothing of such a world; nearer than 20 m, depths are too coarse to tell far
# smoke from the ground.
NEAR, FAR = 20.0, 500_000.0


def usual() -> tuple[float, float]:
    """Between which distances (m) Blender's views show things, unless they are set."""
    known = bpy.types.SpaceView3D.bl_rna.properties
    return known["clip_start"].default, known["clip_end"].default


def clip(space: bpy.types.SpaceView3D, before: tuple[float, float], after: tuple[float, float]) -> None:
    """Change the clipping of a view, where it is `before`: one that an artist has set stays."""
    if np.allclose((space.clip_start, space.clip_end), before, rtol=1.0e-6, atol=0.0):
        space.clip_start, space.clip_end = after


def coloured(space: bpy.types.SpaceView3D) -> None:
    """Have the solid view show colours of the meshes, where it shows one colour for each material."""
    if space.shading.color_type == "MATERIAL":
        space.shading.color_type = "VERTEX"


def prepare_file() -> None:
    """Set every view of the file that is open, as it will be saved, to show its scene through the camera."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            for space in area.spaces:
                if space.type == "VIEW_3D":
                    clip(space, usual(), (NEAR, FAR))
                    coloured(space)
                    if space.region_3d is not None:
                        space.region_3d.view_perspective = "CAMERA"
