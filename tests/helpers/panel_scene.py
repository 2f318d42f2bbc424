"""A small scene built by the panel, and the state of the open file that an artist could lose."""

import shutil

import bpy
import firetwin
import pytest
from few_cameras import try_few
from firetwin.blender import compat
from firetwin.errors import Error
from firetwin.shot.settings import scene_file as file
from firetwin.ui import queue, scene_file
from made_once import made_once
from scene_text import BARE, NO_SMOKE, THREE_FRAMES, TINY
from small_scene import simplify_looks

SCENE = (
    THREE_FRAMES
    + NO_SMOKE
    + BARE
    + "trees = false\n[fire]\nfirebrands = 0\n"
    + TINY
    + """\
[[cameras]]
name = "drone"
keys = [
    {{at = 0, latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}},
    {{at = 1, latitude = 38.830, longitude = -120.57, height = 500, target = "fire"}},
]
"""
)


def build(run, folder):
    """Build a scene by the panel from the run, and save it as `folder`/scene.blend; returns that path."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    (folder / "scene.toml").write_text(SCENE.format(run=run))
    settings = bpy.context.scene.firetwin
    settings.scene_file, settings.output = str(folder / "scene.toml"), str(folder / "out")
    bpy.ops.firetwin.build()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    firetwin.unregister()
    return folder / "scene.blend"


@pytest.fixture(scope="session")
def panel_blend(factory, run_folder, tmp_path_factory):
    """Such a scene with plain materials, for tests that open it or a copy of it."""

    def make(folder):
        with pytest.MonkeyPatch.context() as patch:
            simplify_looks(patch)
            try_few(patch)
            build(run_folder, folder)

    return made_once(tmp_path_factory, "panel_scene", make) / "scene.blend"


def copied(blend, folder):
    """Copy such a file into a folder, with its scene file and an output folder there; returns its path."""
    for suffix in (".blend", ".toml"):
        shutil.copy(blend.with_suffix(suffix), folder)
    for panel in opened(folder / blend.name):
        panel.scene_file, panel.output = str(folder / "scene.toml"), str(folder / "out")
        bpy.ops.wm.save_mainfile()
    return folder / blend.name


def build_with_run(run, folder):
    """Build it from a copy of the run in `folder`, which may vanish."""
    shutil.copytree(run, folder / "run")
    return build(folder / "run", folder)


def opened(blend):
    """Context: open such a file; yields its panel, and closes it afterwards."""
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    yield bpy.context.scene.firetwin
    queue.clear()
    firetwin.unregister()


def settings(scene):
    """Scene file text of a scene's panel, or its error."""
    try:
        return file.text(scene_file.read_settings(scene))
    except Error as error:
        return str(error)


def state():
    """State that an artist could lose: blocks, positions, curves, constraints, lenses, settings."""
    blocks = {
        (prop.identifier, block.name_full, block.session_uid)
        for prop in bpy.data.bl_rna.properties
        if prop.type == "COLLECTION" and prop.identifier not in ("screens", "window_managers")
        for block in getattr(bpy.data, prop.identifier)
    }
    objects = {
        obj.name: (
            *(value for row in obj.matrix_basis for value in row),
            *((constraint.name, getattr(constraint.target, "name", "")) for constraint in obj.constraints),
            *((curve.data_path, len(curve.keyframe_points)) for curve in compat.fcurves(obj)),
            (obj.data.lens, obj.data.sensor_width) if obj.type == "CAMERA" else None,
        )
        for obj in bpy.data.objects
    }
    scenes = {
        scene.name: (
            scene.camera.name if scene.camera else None,
            settings(scene),
            scene.firetwin.runs.keys(),
            scene.firetwin.first_time,
            [node.mute for node in tree.nodes] if (tree := compat.compositor(scene)) else [],
        )
        for scene in bpy.data.scenes
    }
    return blocks, objects, scenes
