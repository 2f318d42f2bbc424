"""An otherwise empty Blender with a shot's scene in it: what the worker process builds, bakes and renders."""

from __future__ import annotations

from ..blender import devices, owned
from ..blender.owned import Stage
from ..progress import MessageCallback, Progress
from ..render import engine, layers
from ..scene import build
from ..shot.shot import Shot

KEPT = 512  # MB that Blender keeps of what it has read: smoke of a frame or two, for all of its pictures


def empty() -> Stage:
    """A scene with nothing in it, in a Blender that holds nothing else."""
    import bpy

    # Not read_factory_settings: its preferences enable no extension, and Blender then deletes their wheels.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # Smoke of a film is read frame by frame and not again; Blender's own limit lets it fill 4 GB.
    bpy.context.preferences.system.memory_cache_limit = KEPT
    return owned.adopt(bpy.context.scene)


def build_scene(shot: Shot, progress: Progress, tell: MessageCallback) -> Stage:
    """Build the scene of a shot, with view layers and engine, in a Blender that holds nothing else."""
    stage = empty()
    total = len(build.PARTS) + 2
    for done, _ in enumerate(build.steps(shot, stage.scene, tell=tell)):
        progress(done, total, "building the scene")
    layers.build(shot.settings, stage)
    engine.apply(shot.settings, stage.scene)
    engine.label(shot.run, stage.scene)
    devices.follow(shot.settings.render.device, stage.scene)
    progress(total, total, "building the scene")
    return stage
