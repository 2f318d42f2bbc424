"""Operators of Blender that write files for their user: a cheap press of each (see `doors`)."""

import contextlib
import os
from pathlib import Path

import bpy
import doors
import firetwin
from doors import Call, Door
from firetwin.shot.settings import scene_file as file
from firetwin.ui import asset_library, scene_file


def _press(name, **paths):
    def pressed(*more):
        bpy.context.scene.firetwin.export_overwrite = "--overwrite" in more
        options = {option: str(Path(path).absolute()) for option, path in paths.items()}
        try:
            getattr(bpy.ops.firetwin, name)(**options)
        except RuntimeError as error:
            return Call(1, str(error).strip())
        return Call(0, "")

    return pressed


def _panel(_):
    scene_file.fill(bpy.context.scene, file.read(Path("scene.toml").absolute()), inspect=False)


def _export(patch):
    doors._export(patch)
    _panel(patch)


def _scene(patch):
    doors._scene(patch)
    _panel(patch)


def _assets(patch):
    doors._no_work(patch, Path("library/firetwin_assets.blend").absolute())
    patch.setattr(asset_library, "add", lambda _: None)
    _panel(patch)


DOORS = {
    "export": Door(_press("export", filepath="out/scene.toml"), ("out/scene.toml",), _scene),
    "export_to": Door(
        _press("export_to", directory="there"), ("there/maps/fuel.tif", "there/georeference.json"), _export
    ),
    "assets": Door(_press("assets", directory="library"), ("library/firetwin_assets.blend",), _assets),
}
NO_DOORS = {
    "build": "the open file",
    "convert": "a folder with a free name",
    "f12_files": "pictures at F12, as Blender writes them",
    "farm_cancel": "nothing",
    "farm_resume": "nothing",
    "farm_status": "nothing",
    "farm_submit": "a folder and a scene file, as farm_write",
    "farm_write": "the folder of `farm plan`, and a scene file (test_farm)",
    "help": "the manual, in Firetwin's own folder",
    "preset": "a preset, as Blender writes it",
    "render": "a film, as the command",
    "render_background": "a film, as the command, and a copy of the file in a temporary folder",
    "sample": "a folder that does not exist or is empty",
    "solve": "the cache, by hashes",
    "smoke_volumes": "the cache, by hashes",
    "story_edit": "the storyboard that its user edits",
    "story_make": "a scene file and the files of `story`",
    "story_move": "the storyboard that its user edits",
    "story_render": "the files of `story`",
    "tiles_preview": "the cache, by hashes",
}
"""Operators that write other files, and which."""
SILENT = [
    *("allocate", "camera_add", "camera_aim", "camera_copy", "camera_key", "camera_lens", "camera_path"),
    *("camera_remove", "copy", "fly", "go", "inspect", "jump", "live", "open", "output_preset", "quality"),
    *("queue", "queue_esc", "regrade", "remove", "reset", "run_add", "run_remove", "show_live"),
    *(
        "station_map",
        "station_pick",
        "stop",
        "story_open",
        "tiles_clear",
        "view",
        "viewport_measure",
        "vr_landmark",
    ),
    *("vr_landmarks", "vr_play", "vr_session", "vr_start_at", "vr_teleport", "vr_time", "vr_turn", "window"),
]
"""Operators that write no files."""


def print_table():
    """Print a line for each file of each operator, without the messages that Blender prints."""
    firetwin.register()
    with os.fdopen(os.dup(1), "w") as out, contextlib.redirect_stdout(out):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        doors.print_table(DOORS)
    firetwin.unregister()
