"""Builds by panels: equal to the exported scene file, part by part, with edits by hand preserved."""

import hashlib
import shutil
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.jobs import sample, worker_scene
from firetwin.shot.settings import scene_file as file
from firetwin.shot.source import ShotSource
from firetwin.ui import build, job, quality, scene_file, working
from firetwin.ui import time as model_time


@pytest.fixture
def opened(panel, settings, tmp_path):
    """The panel with the settings of a small shot."""
    panel.output = str(tmp_path / "out")
    scene_file.fill(panel.id_data, settings)
    assert not panel.problem
    return panel


def values(thing):
    """Properties of a node or socket that can be compared."""
    properties = {}
    for prop in thing.bl_rna.properties:
        if prop.type in ("POINTER", "COLLECTION") or prop.identifier in (
            "session_uid",
            "bl_icon",
            "is_active",
        ):
            continue
        value = getattr(thing, prop.identifier)
        properties[prop.identifier] = (
            value
            if isinstance(value, str | bool | int | float)
            else tuple(value)
            if prop.type != "ENUM"
            else str(value)
        )
    return properties


def tree(nodes):
    """A node tree as values."""
    return (
        [(values(node), [values(socket) for socket in node.inputs]) for node in nodes.nodes],
        [
            (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
            for link in nodes.links
        ],
    )


def mesh(data):
    """Attributes of a mesh, each as a digest of its array."""
    attributes = {}
    for attribute in data.attributes:
        name = (
            next((n for n in ("value", "vector", "color") if hasattr(attribute.data[0], n)), None)
            if len(attribute.data)
            else None
        )
        if name is None:
            continue
        width = np.size(getattr(attribute.data[0], name))
        array = np.empty(len(attribute.data) * width, np.float32)
        attribute.data.foreach_get(name, array)
        attributes[attribute.name] = (len(array), hashlib.sha256(array.tobytes()).hexdigest())
    return attributes


def everything(scene):
    """At the first frame: objects with their places and arrays, and our node trees."""
    scene.frame_set(1)
    objects = {
        thing.name: (
            np.round(np.array(thing.matrix_world), 6).tolist(),
            mesh(thing.data) if thing.type == "MESH" else None,
        )
        for thing in scene.objects
    }
    trees = {
        f"{kind} {block.name}": tree(block if kind == "group" else block.node_tree)
        for kind, blocks in (
            ("group", bpy.data.node_groups),
            ("material", bpy.data.materials),
            ("world", bpy.data.worlds),
        )
        for block in blocks
        if block.users and owned.is_ours(block) and (kind == "group" or block.node_tree)
    }
    return objects, trees


@pytest.mark.slow  # two whole builds
def test_panels_build_what_the_exported_scene_file_builds(opened, tmp_path):
    opened.light.haze, opened.fire.budget = 0.7, 500
    opened.terrain.error = 0.9
    bpy.ops.firetwin.build()
    objects, trees = everything(bpy.context.scene)
    scene_file.export(bpy.context.scene, tmp_path / "out.toml")
    shot = ShotSource(str(tmp_path / "out.toml")).shot()
    assert (shot.settings.light.haze, shot.settings.terrain.error) == (0.7, 0.9)
    stage = worker_scene.build_scene(shot, lambda *_: None, lambda _: None)
    again, trees_again = everything(stage.scene)
    assert again.keys() == objects.keys()
    assert {"Firetwin Ground", "Firetwin Trees"} <= objects.keys()
    assert again == objects
    assert trees_again.keys() == trees.keys()
    assert trees_again == trees


def test_a_part_built_again_keeps_what_was_changed_by_hand_elsewhere(opened, plain_looks):
    bpy.ops.firetwin.build()
    scene = bpy.context.scene
    trees, ground = scene.objects["Firetwin Trees"], scene.objects["Firetwin Ground"]
    trees.location.x += 100.0
    ground.data.materials[0].node_tree.nodes.new("ShaderNodeValue").name = "Mine"
    scene.camera.name = "My camera"
    scene.camera.animation_data_clear()
    scene.camera.location.z = 5000.0
    scene.frame_end, scene.render.resolution_x = 2, 100
    scene.view_layers["thermal"].samples = 7
    kept = [thing.session_uid for thing in (trees, ground, scene.camera)]
    opened.fire.budget, opened.light.haze = 100, 0.5
    assert opened.changed == "fire light"
    for part in ("fire", "smoke", "light"):
        assert bpy.ops.firetwin.build(part=part) == {"FINISHED"}
    assert opened.changed == "cameras"  # one has another name than when all was built
    assert [
        scene.objects[name].session_uid for name in ("Firetwin Trees", "Firetwin Ground", "My camera")
    ] == kept
    assert scene.objects["Firetwin Trees"].location.x == pytest.approx(100.0)
    assert "Mine" in scene.objects["Firetwin Ground"].data.materials[0].node_tree.nodes
    assert (scene.camera.name, scene.camera.location.z) == ("My camera", 5000.0)
    assert (scene.frame_end, scene.render.resolution_x) == (2, 100)
    assert scene.view_layers["thermal"].samples == 7
    assert working.last_messages(build.FIRETWIN_OT_build)[-1].text == "Built the light of Test"
    bpy.ops.firetwin.build(part="forest")
    assert scene.objects["Firetwin Trees"].session_uid != kept[0]
    bpy.ops.firetwin.build(part="cameras")
    assert (scene.camera.name, scene.camera.location.z) == ("My camera", pytest.approx(5000.0, abs=0.01))


def test_quality_moves_many_settings_and_is_known_again(opened):
    for name in quality.LEVELS:
        bpy.ops.firetwin.quality(level=name)
        assert quality.current_level(opened) == name
        found = scene_file.read_settings(bpy.context.scene)
        for (section, key), value in quality.LEVELS[name].items():
            assert getattr(getattr(found, section), key) == value
    opened.render.samples += 1
    assert quality.current_level(opened) == ""
    bpy.ops.firetwin.reset(section="render", key="samples")
    assert opened.render.samples == 6


def test_a_preset_brings_back_all_but_the_run(opened, tmp_path, monkeypatch):
    def resource(*_, path="", **__):
        (tmp_path / path).mkdir(parents=True, exist_ok=True)
        return str(tmp_path / path)

    monkeypatch.setattr(bpy.utils, "user_resource", resource)
    monkeypatch.setattr(quality.FIRETWIN_MT_presets, "bl_label", "Presets")  # becomes the preset's name
    opened.light.use_exposure, opened.light.exposure, opened.render.passes = True, 1.5, {"rgb", "thermal"}
    opened.time.start = "2014-09-17 21:06"
    assert bpy.ops.firetwin.preset(name="Mine") == {"FINISHED"}
    (saved,) = tmp_path.rglob("Mine.py")
    opened.light.use_exposure, opened.render.passes, opened.time.start = False, {"depth"}, ""
    bpy.ops.script.execute_preset(filepath=str(saved), menu_idname="FIRETWIN_MT_presets")
    found = scene_file.read_settings(bpy.context.scene)
    assert (found.light.exposure, found.render.passes, found.time.start) == (1.5, ("rgb", "thermal"), None)


def test_a_run_and_a_scene_file_are_opened_by_their_file(panel, run_folder, settings, tmp_path):
    bpy.ops.firetwin.open(filepath=str(run_folder / "run.toml"))
    assert (panel.run, panel.cameras.keys()) == (str(run_folder), ["overview", "chase", "flank", "satellite"])
    (tmp_path / "shot.toml").write_text(file.text(replace(settings, path=tmp_path / "shot.toml")))
    bpy.ops.firetwin.open(filepath=str(tmp_path / "shot.toml"))
    assert (panel.cameras.keys(), panel.time.frames) == (["drone"], 3)
    bpy.ops.firetwin.open(filepath=str(run_folder))
    assert panel.cameras.keys() == ["drone"]  # the same run
    shutil.copytree(run_folder, tmp_path / "other")
    bpy.ops.firetwin.open(filepath=str(tmp_path / "other"))
    assert (panel.cameras.keys(), panel.scene_file) == (["overview", "chase", "flank", "satellite"], "")
    with pytest.raises(RuntimeError, match="no such scene file"):
        bpy.ops.firetwin.open(filepath=str(tmp_path / "none.toml"))
    assert panel.cameras.keys() == ["overview", "chase", "flank", "satellite"]


def test_the_king_fire_is_made_here_and_opened(panel, run_folder, tmp_path, monkeypatch):
    tasks = []

    def copy(work, *_, **__):
        tasks.append(work.func)
        shutil.copytree(run_folder, work.args[0], dirs_exist_ok=True)

    monkeypatch.setattr(sample.worker, "run", copy)
    for _ in range(2):
        assert bpy.ops.firetwin.sample(folder=str(tmp_path / "king")) == {"FINISHED"}
        assert panel.run == str(tmp_path / "king")
        assert panel.cameras.keys() == ["overview", "chase", "flank", "satellite"]
    assert tasks == [sample.in_blender]
    assert not list(tmp_path.glob(".*"))


def test_a_dated_moment_is_shown_and_bounds_the_window(opened):
    owned.stage(bpy.context.scene)
    opened.first_time, opened.seconds_per_frame, opened.frames = "2014-09-17T21:00:00+00:00", 1800.0, 3
    bpy.ops.firetwin.jump(moment="2014-09-17T21:29:00Z")
    assert bpy.context.scene.frame_current == 2
    bpy.ops.firetwin.jump(moment="2014-09-17T23:00:00Z")
    assert bpy.context.scene.frame_current == 3
    bpy.ops.firetwin.window(key="end", moment=model_time.dated_events(opened)[-1][0])
    assert opened.time.end == "2014-09-17 22:00"


def test_what_went_wrong_can_be_copied(opened, monkeypatch):
    opened.time.end = "2014-09-19 00:00"
    with pytest.raises(RuntimeError):
        bpy.ops.firetwin.build()
    (told,) = (each.text for each in job.Job.last.messages if each.level == "ERROR")
    assert told.startswith("Time.end lies outside of the run, which has 2014-09-17T21:00:00Z to")
    text = working.support_details(told)
    assert text.startswith(told)
    assert bpy.app.version_string in text
    job.describe_error(ValueError("nobody foresaw it"))
    assert "ValueError: nobody foresaw it" in working.support_details("x")
