"""Scene clock: frame range, and model time as a driver of shaders and geometry nodes."""

from __future__ import annotations

import bpy

from ..blender import compat, nodes, owned
from ..blender.owned import Stage
from ..shot.shot import Shot


def build(shot: Shot, stage: Stage) -> None:
    """Keyframe the scene property that provides the model time to shaders."""
    scene, frames = stage.scene, shot.frames
    scene[nodes.TIME] = frames.first
    if scene.animation_data is None or scene.animation_data.action is None or _has_own_action(scene):
        _add_curve(shot, scene)
    else:  # an artist's action stays unchanged
        _add_driver(shot, scene)


def set_frame_range(shot: Shot, stage: Stage) -> None:
    """Set the frame range of Firetwin's scene, and go to its first frame."""
    if stage.is_own:
        scene = stage.scene
        scene.frame_start, scene.frame_end = 1, shot.frames.count
        compat.set_frame_rate(scene.render, shot.settings.time.rate)
        scene.frame_set(1)


def remove(scene: bpy.types.Scene) -> None:
    """Remove the property and its F-curve; other curves that an artist added to Firetwin's action stay."""
    data = scene.animation_data
    if data is not None:
        for driver in [driver for driver in data.drivers if driver.data_path == _PATH]:
            data.drivers.remove(driver)
        if _has_own_action(scene):
            _remove_curves(scene, (_PATH, *(_OF_OUR_OWN if owned.is_ours(scene) else ())))
        if data.action is None and not data.drivers and not data.nla_tracks:
            scene.animation_data_clear()
    scene.pop(nodes.TIME, None)


_PATH = f'["{nodes.TIME}"]'
_OF_OUR_OWN = ("view_settings.exposure",)  # other curves in Firetwin's scene


def _remove_curves(scene: bpy.types.Scene, paths: tuple[str, ...]) -> None:
    """Remove these F-curves from Firetwin's action, and the action itself if it is then empty."""
    action = scene.animation_data.action
    compat.remove_fcurves(scene, paths)
    if compat.fcurves(scene):
        owned.unmark(action)
    else:
        bpy.data.actions.remove(action)


def _has_own_action(scene: bpy.types.Scene) -> bool:
    data = scene.animation_data
    return data is not None and data.action is not None and owned.is_ours(data.action)


def _add_curve(shot: Shot, scene: bpy.types.Scene) -> None:
    curve = compat.new_fcurve(scene, _PATH)
    curve.keyframe_points.add(2)
    step = max(shot.frames.step, 0.0)
    ends = (1.0, 1.0 + max(shot.frames.count - 1, 1))
    for point, frame in zip(curve.keyframe_points, ends, strict=True):
        point.co = (frame, shot.frames.first + step * (frame - 1.0))
        point.interpolation = "LINEAR"
    curve.extrapolation = "LINEAR"
    curve.update()


def _add_driver(shot: Shot, scene: bpy.types.Scene) -> None:
    scene.driver_remove(_PATH)
    driver = scene.driver_add(_PATH).driver
    driver.expression = f"{shot.frames.first!r} + {shot.frames.step!r} * (frame - 1)"


def geometry_time(tree: nodes.Tree, shot: Shot) -> nodes.Value:
    """Return the model time (s) in a geometry node tree, from the evaluated frame."""
    frame = tree.output("GeometryNodeInputSceneTime", name="Frame")
    return (frame - 1.0) * shot.frames.step + shot.frames.first
