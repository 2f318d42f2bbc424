"""Frame culling: a render instances only the trees that its frame shows.

A forest is planted for all frames of a build chunk. In the example a frame shows two thirds of its trees, and
Cycles spends about 20 us of CPU time on each instance. Trees outside of a frame's views remain in the mesh;
they are not instanced where the attribute `IN_VIEW` is false. It is true in .blend files.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core import lod
from numpy.typing import NDArray

from ...blender.owned import Stage
from ...shot.shot import Shot
from . import visibility

IN_VIEW = "in_view"
"""Boolean attribute of points with plants."""


class FrameCulling:
    """Frame culling of a scene's trees, in a process that only renders the scene."""

    def __init__(self, shot: Shot, stage: Stage) -> None:
        self.shot = shot
        meshes = [obj.data for obj in stage.objects_of("Forest") if isinstance(obj.data, bpy.types.Mesh)]
        planted = [data for data in meshes if len(data.vertices) and IN_VIEW in data.attributes]
        self.plants = [(data, *_bounds(data)) for data in planted]

    def apply(self, frame: int) -> None:
        """Set `IN_VIEW` for a frame; without culling no tree is hidden.

        Trees that shade visible ground, or are near the view, are retained (see `visibility.visible`). Trees
        are planted up to the draw distance of the nearest frame; a frame from far above hides them one by one
        where the ground's colour takes their place.
        """
        views = self.shot.visibility.view_set(frame)
        if views is None:
            return
        eyes = [view.position[frame - 1] for view in self.shot.paths if view.perspective]
        reach = self.shot.settings.forest.draw_distance
        eyes = eyes if len(eyes) == len(self.shot.paths) else []
        for data, middle, radius in self.plants:
            seen = lod.visible_mask(middle, radius, views, margin=visibility.AROUND, shadows=True)
            seen = np.asarray(seen, bool) & visibility.is_drawn(middle, eyes, reach)
            data.attributes[IN_VIEW].data.foreach_set("value", seen)
            data.update()


def _bounds(data: bpy.types.Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the bounding spheres of trees: centres (n, 3) and radii (n,), m."""
    foot, height, width = (_values(data, name) for name in ("position", "scale", "width"))
    return visibility.bounds(foot.reshape(-1, 3), height, width)


def _values(data: bpy.types.Mesh, name: str) -> NDArray[np.float64]:
    """Read a float or vector attribute of points."""
    key, size = ("vector", 3) if name == "position" else ("value", 1)
    values = np.empty(size * len(data.vertices), np.float32)
    data.attributes[name].data.foreach_get(key, values)
    return values.astype(np.float64)
