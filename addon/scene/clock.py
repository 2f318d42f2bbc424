"""Model time and Blender frames.

Frame f of 1..frames shows t(f) = t_start + (f - 1) * (t_end - t_start) / (frames - 1), seconds since the run
began.
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import bpy
import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import compat, nodes
from ..project import Project


def run_start(run: Run) -> datetime:
    """Start of the run, UTC."""
    start = datetime.fromisoformat(run.start.replace("Z", "+00:00"))
    return start if start.tzinfo else start.replace(tzinfo=UTC)


def seconds(run: Run, moment: datetime) -> float:
    """Model time of a moment; one without a time zone is UTC."""
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    return (moment - run_start(run)).total_seconds()


def moment(run: Run, time: float) -> datetime:
    """UTC of a model time (s)."""
    return run_start(run) + timedelta(seconds=time)


def window(project: Project, run: Run) -> tuple[float, float]:
    """Model time (s) of the first and the last frame."""
    start, end = project.time.start, project.time.end
    first = float(run.times[0]) if start is None else seconds(run, start)
    last = float(run.times[-1]) if end is None else seconds(run, end)
    return first, last


def step(project: Project, run: Run) -> float:
    """Model seconds per frame."""
    first, last = window(project, run)
    return (last - first) / max(project.time.frames - 1, 1)


def model_time(project: Project, run: Run, frame: float) -> float:
    """Model time (s) that a Blender frame shows."""
    return window(project, run)[0] + (frame - 1.0) * step(project, run)


def frame_times(project: Project, run: Run) -> NDArray[np.float64]:
    """Model times (frames,) in seconds of all frames."""
    return window(project, run)[0] + np.arange(project.time.frames) * step(project, run)


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
