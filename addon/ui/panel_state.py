"""State of the panels in a built scene: the facts and settings that the build stored with it.

They are shown after a build, after a file is opened, and when the add-on is enabled.
"""

from __future__ import annotations

from pathlib import Path

import bpy

from ..blender import owned
from ..scene import built
from ..scene.build import PARTS
from ..scene.smoke import volume_files
from ..shot.settings import scene_file as file
from ..shot.shot import Shot
from ..shot.stations.station_signs import MovingPoints
from . import changed_settings, job, scene_file

BUILD_FIRST = "Build the scene first"


def is_built(scene: bpy.types.Scene) -> bool:
    """Return whether a scene is built, and the panel knows the times of its frames."""
    return bool(scene.firetwin.first_time) and owned.find_stage(scene) is not None


def require(cls: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Return whether the scene is built; otherwise set the poll message."""
    if is_built(context.scene):
        return True
    cls.poll_message_set(BUILD_FIRST)
    return False


def store(scene: bpy.types.Scene, shot: Shot, moving: MovingPoints | None) -> None:
    """Store the facts of a build with the scene, and show them; former landmarks stay without `moving`."""
    text = scene.firetwin.landmarks if moving is None else built.landmarks_text(moving)
    built.store(owned.stage(scene), built.gather(shot, text))
    show(scene)


def show(scene: bpy.types.Scene) -> None:
    """Copy the facts that are stored with a scene to its panel, and the settings to a panel without a run."""
    stage = owned.find_stage(scene)
    if stage is None or (facts := built.read(stage)) is None:
        return
    for name in built.NAMES:
        setattr(scene.firetwin, name, getattr(facts, name))
    text, _ = volume_files.read_source(stage)
    if text and not scene.firetwin.run:
        _fill(scene, text)


def _fill(scene: bpy.types.Scene, text: str) -> None:
    """Fill the panel with the scene file of a build; the run is not read."""
    panel = scene.firetwin
    try:
        scene_file.fill(scene, file.parse(text, Path("scene.toml")), inspect=False)
    except Exception as error:  # another version wrote it
        panel.problem = job.describe_error(error)
    else:
        changed_settings.store_digests(panel, changed_settings.compute_digests(panel), tuple(PARTS))


def clear(scene: bpy.types.Scene) -> None:
    """Delete the facts, because nothing is built."""
    stage = owned.find_stage(scene)
    if stage is not None:
        built.clear(stage)
    for name in built.NAMES:
        scene.firetwin.property_unset(name)


@bpy.app.handlers.persistent
def show_all(*_: object) -> None:
    """Show the facts of all scenes of a file."""
    for scene in bpy.data.scenes:
        show(scene)


def register() -> None:
    """Show the facts of each file after it was opened, and of the open file.

    Blender hides its data while it enables add-ons. Without a window it runs no timers, and hangs at its end
    if it has one.
    """
    bpy.app.handlers.load_post.append(show_all)
    if not bpy.app.background:
        bpy.app.timers.register(show_all, first_interval=0.0)


def unregister() -> None:
    """Undo `register`."""
    bpy.app.handlers.load_post.remove(show_all)
    if bpy.app.timers.is_registered(show_all):
        bpy.app.timers.unregister(show_all)
