"""Model time and Blender frames.

Frame f of 1..frames shows t(f) = t_start + (f - 1) * (t_end - t_start) / (frames - 1), seconds since the run
began.
"""

from __future__ import annotations

import bpy
from firetwin_core.run import Run

from .. import compat, nodes
from ..project import Project
from ..times import frame_times, model_time, moment, run_start, seconds, step, window

__all__ = [
    "build",
    "frame_times",
    "geometry_time",
    "model_time",
    "moment",
    "run_start",
    "seconds",
    "step",
    "window",
]


def build(project: Project, run: Run, scene: bpy.types.Scene) -> bpy.types.Scene:
    """Set the frame range and animate the scene property that shaders read the model time from."""
    scene.frame_start, scene.frame_end = 1, project.time.frames
    scene.render.fps, scene.render.fps_base = project.time.fps, 1.0
    first = window(project, run)[0]
    scene[nodes.TIME] = first
    curve = compat.new_fcurve(scene, f'["{nodes.TIME}"]')
    curve.keyframe_points.add(2)
    delta = max(step(project, run), 0.0)
    for point, frame in zip(curve.keyframe_points, (1.0, 1.0 + max(project.time.frames - 1, 1)), strict=True):
        point.co = (frame, first + delta * (frame - 1.0))
        point.interpolation = "LINEAR"
    curve.extrapolation = "LINEAR"
    curve.update()
    scene.frame_set(1)
    return scene


def geometry_time(tree: nodes.Tree, project: Project, run: Run) -> nodes.Value:
    """Current model time (s) in a geometry node tree, from the frame that it is evaluated at."""
    frame = tree.output("GeometryNodeInputSceneTime", name="Frame")
    return (frame - 1.0) * step(project, run) + window(project, run)[0]
