"""Equal pictures by F12, in the background, and by the command line."""

import subprocess
import sys
import time
from pathlib import Path

import bpy
import firetwin
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.shot.cameras.rigs.poses import Poses
from firetwin.shot.settings import scene_file as file
from firetwin.ui import queue, scene_file
from firetwin_core import sensor
from mathutils import Euler
from scene_text import BARE, DRONE, NO_SMOKE, THREE_FRAMES, TINY

# Only pictures drawn as volumes equal F12 to the pixel.
VOLUME = NO_SMOKE + 'draw = "volume"\n'
SCENE = THREE_FRAMES + BARE + VOLUME + TINY + 'passes = ["rgb", "thermal", "depth"]\n' + DRONE
FRAME = 2
ROUNDED = {"rgb": 0.002, "thermal": 0.0, "depth": 0.0}  # pixels at edges: cameras are exported rounded


@pytest.fixture
def panel(run_folder, tmp_path):
    """A built scene of the panel."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    (tmp_path / "scene.toml").write_text(SCENE.format(run=run_folder))
    settings = bpy.context.scene.firetwin
    settings.scene_file, settings.output = str(tmp_path / "scene.toml"), str(tmp_path / "background")
    bpy.ops.firetwin.build()
    yield settings
    firetwin.unregister()


def _fly(scene):
    thing = scene.camera
    thing.animation_data_clear()
    thing.rotation_mode = "XYZ"
    for frame, place, turn in (
        (1, (-900, -2500, 2300), (1.25, 0.0, -0.3)),
        (3, (-300, -1900, 2500), (1.2, 0.1, 0)),
    ):
        thing.location, thing.rotation_euler = place, Euler(turn)
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_euler", frame=frame)
    thing.data.lens = 20.0
    thing.name = "Mine"


def _until_done(item):
    end = time.monotonic() + 600.0
    while item.state in (queue.WAITING, queue.RENDERING) and time.monotonic() < end:
        queue.advance()
        time.sleep(0.2)
    assert (item.state, item.text) == (queue.DONE, item.text)


def _pixels(path):
    return np.asarray(sensor.read_image(path))


def _differing(first, second):
    """Share of the pixels of two pictures that differ."""
    return np.mean(np.any(_pixels(first) != _pixels(second), axis=-1))


def test_f12_the_queue_and_the_command_line_render_the_same(panel, tmp_path):
    scene = bpy.context.scene
    before = scene.camera
    _fly(scene)
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert (scene.camera, scene.camera.name) == (before, "Mine")
    scene_file.export(scene, tmp_path / "out.toml")
    (camera,) = file.read(tmp_path / "out.toml").cameras
    assert (camera.name, type(camera.rig)) == ("Mine", Poses)
    scene.frame_set(FRAME)
    panel.which = "frame"
    bpy.ops.firetwin.render_background()
    (item,) = queue.items
    panel.output = str(tmp_path / "f12")
    bpy.ops.firetwin.f12_files(on=True)
    scene.frame_start = scene.frame_end = FRAME
    bpy.ops.render.render(animation=True)
    _until_done(item)
    out = tmp_path / "commands"
    command = [sys.executable, "-m", "firetwin", "render", tmp_path / "out.toml", "--out", out]
    subprocess.run([*map(str, command), "--frames", str(FRAME)], check=True)
    name = f"Mine/rgb/Mine_rgb_{FRAME:06d}"
    for suffix in ("png", "exr"):
        for what in ("rgb", "thermal", "depth"):
            path = Path(f"Mine/{what}/Mine_{what}_{FRAME:06d}.{suffix}")
            if (out / path).exists():
                assert _differing(tmp_path / "background" / path, out / path) <= ROUNDED[what], path
    picture = _pixels(out / f"{name}.png")
    assert picture.std() > 0.1
    written = {path.relative_to(tmp_path / "f12") for path in (tmp_path / "f12").rglob("*.*")}
    assert written == {Path(f"{name}.png"), Path(f"{name}.exr")}
    for path in written:
        assert _differing(tmp_path / "f12" / path, out / path) <= ROUNDED["rgb"], path
    bpy.ops.firetwin.f12_files(on=False)
    item.poll()
    assert {path.name for path in item.finished} == {f"Mine_{w}_{FRAME:06d}.png" for w in ("rgb", "thermal")}
    assert not list((tmp_path / "background").rglob(".part-*"))
    queue.remove(item)
    assert not item.folder.exists()


def test_what_is_changed_by_hand_is_rendered_beside_the_window(panel, tmp_path):
    """A light turned off, which is not in the scene file; later changes do not matter."""
    scene = bpy.context.scene
    scene.frame_set(FRAME)
    sun = next(thing for thing in scene.objects if thing.type == "LIGHT" and owned.is_ours(thing))
    panel.which = "frame"
    sun.hide_render = True
    bpy.ops.firetwin.render_background()
    (item,) = queue.items
    sun.hide_render = False
    _until_done(item)
    dark = _pixels(tmp_path / f"background/drone/rgb/drone_rgb_{FRAME:06d}.exr")
    scene.render.filepath = str(tmp_path / "f12.png")
    bpy.ops.render.render(write_still=True)
    shown = _pixels(tmp_path / "f12.png")
    dull = _pixels(tmp_path / f"background/drone/rgb/drone_rgb_{FRAME:06d}.png")
    assert dark.mean() < 0.9 * shown.max()
    assert dull.mean() < 0.8 * shown.mean()
