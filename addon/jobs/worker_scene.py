"""Worker scene: an otherwise empty Blender with a shot's scene, for build, bake and render jobs."""

from __future__ import annotations

from ..blender import devices, owned
from ..blender.owned import Stage
from ..progress import MessageCallback, Progress
from ..render import credits, engine, layers
from ..scene import build
from ..scene.forest.stand import Stand
from ..shot.shot import Shot

KEPT = 512  # MB, Blender's volume cache limit: the smoke of one or two frames, for all of their pictures


def empty() -> Stage:
    """Create an empty scene in a Blender without any other data."""
    import bpy

    # Not read_factory_settings: its preferences enable no extension, and Blender then deletes their wheels.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # A film reads each frame's smoke once; Blender's default limit lets the cache grow to 4 GB.
    bpy.context.preferences.system.memory_cache_limit = KEPT
    return owned.adopt(bpy.context.scene)


def build_scene(shot: Shot, progress: Progress, tell: MessageCallback, grown: Stand | None = None) -> Stage:
    """Build the scene of a shot, with view layers and engine, in a Blender without any other data.

    Parameters
    ----------
    grown
        The forest's trees, if they are already known.
    """
    stage = empty()
    total = len(build.PARTS) + 2
    for done, _ in enumerate(build.steps(shot, stage.scene, tell=tell, grown=grown)):
        progress(done, total, "building the scene")
    layers.build(shot.settings, stage)
    engine.apply(shot.settings, stage.scene)
    engine.set_metadata(shot.run, stage.scene)
    credits.stamp(stage)
    devices.follow_preferences(shot.settings.render.device, stage.scene)
    progress(total, total, "building the scene")
    return stage
