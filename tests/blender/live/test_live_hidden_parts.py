"""Reasons why 3D views do not draw a part: each is true in the scene, and its remedy ends it."""

import bpy
import pytest
from firetwin.blender import owned
from firetwin.scene import build
from firetwin.scene.forest import preview
from firetwin.scene.live import hidden_parts, switch
from firetwin.scene.smoke import volume_files
from live_scene import *  # noqa: F403
from smoke_scene import write


def part(stage, name):
    """Collection of a part."""
    return next(child for child in stage.root.children if owned.is_ours(child, name))


def row(stage, name):
    """Row of that collection in the first view layer."""
    above = stage.scene.view_layers[0].layer_collection.children[stage.root.name]
    return above.children[part(stage, name).name]


def drawn(scene):
    """Names of objects and owners of instances in 3D views."""
    layer = scene.view_layers[0]
    layer.update()
    every = layer.depsgraph.object_instances
    owners = {(each.parent if each.is_instance else each.object).original for each in every}
    return {obj.name for obj in owners if obj.visible_get(view_layer=layer)}


def reasons(scene, start):
    """Reasons that begin with these words."""
    return [text for text in hidden_parts.why_not_drawn(scene) if text.startswith(start)]


def hide_collection(stage, name, on):
    part(stage, name).hide_viewport = on


def close_eye(stage, name, on):
    row(stage, name).hide_viewport = on


def exclude(stage, name, on):
    row(stage, name).exclude = on


HIDING = [
    (hide_collection, "disabled in viewports"),
    (close_eye, "the eye of its collection"),
    (exclude, "excluded from the view layer"),
]


@pytest.mark.parametrize(("hide", "word"), HIDING)
@pytest.mark.parametrize(("name", "thing"), [("Forest", "Firetwin Trees"), ("Terrain", "Firetwin Ground")])
def test_a_hidden_collection_is_not_drawn(live_stage, name, thing, hide, word):
    scene = live_stage.scene
    assert thing in drawn(scene)
    assert not reasons(scene, f"{name} is hidden")
    hide(live_stage, name, True)
    assert thing not in drawn(scene)
    (reason,) = reasons(scene, f"{name} is hidden")
    assert word in reason
    hide(live_stage, name, False)
    assert thing in drawn(scene)
    assert not reasons(scene, name)


def test_without_the_root_nothing_is_drawn(live_stage):
    scene = live_stage.scene
    live_stage.root.hide_viewport = True
    assert hidden_parts.why_not_drawn(scene) == [
        "Firetwin is hidden: its collection is disabled in viewports"
    ]
    assert not [name for name in drawn(scene) if name.startswith("Firetwin")]


@pytest.mark.parametrize(("attribute", "word"), [("hide_viewport", "disabled in viewports"), ("", "Alt H")])
def test_a_hidden_object_is_not_drawn(live_stage, attribute, word):
    scene, ground = live_stage.scene, bpy.data.objects["Firetwin Ground"]
    if attribute:
        ground.hide_viewport = True
    else:
        ground.hide_set(True, view_layer=scene.view_layers[0])
    assert ground.name not in drawn(scene)
    (reason,) = reasons(scene, ground.name)
    assert word in reason


def test_the_live_scene_replaces_four_parts_alone(live_stage):
    """Their objects are not drawn, and a hidden part of the others is still told."""
    scene = live_stage.scene
    switch.show_live(scene, True)
    assert hidden_parts.why_not_drawn(scene) == [hidden_parts.LIVE]
    replaced = {obj.name for name in switch.REPLACED for obj in live_stage.objects_of(name)}
    assert replaced
    assert not replaced & drawn(scene)
    assert {obj.name for obj in live_stage.objects_of("Live")} <= drawn(scene)
    part(live_stage, "Light").hide_viewport = True
    assert hidden_parts.why_not_drawn(scene) == [hidden_parts.LIVE, *reasons(scene, "Light is hidden")]
    assert len(hidden_parts.why_not_drawn(scene)) == 2


def test_a_large_forest_has_fewer_plants(near_shot, scene, plain_looks, monkeypatch):
    monkeypatch.setattr(preview, "MOST", 300)
    build.build(near_shot, scene)
    (reason,) = reasons(scene, "Firetwin Trees ")
    assert "replaced by fewer plants" in reason
    names = {name for name in drawn(scene) if "Trees" in name}
    assert names
    assert "Firetwin Trees" not in names


def test_lights_of_near_flames_are_in_renders_only(stage):
    """Their object is not a plant, and no camera sees it."""
    cards = owned.add(stage.part("Fire"), "Flame Light", bpy.data.meshes.new("cards"))
    cards.hide_viewport, cards.visible_camera = True, False
    assert hidden_parts.why_not_drawn(stage.scene) == [
        "Firetwin Flame Light lights renders only: 3D views would show its cards"
    ]


def test_smoke_without_a_volume_is_told(run_folder, tmp_path):
    write(tmp_path, run_folder)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    scene = bpy.context.scene
    (reason,) = reasons(scene, "Smoke of frame 1 has no volume")
    stage = owned.stage(scene)
    assert volume_files.missing(stage, [1]) == [1]
    scene.frame_set(2)
    assert reasons(scene, "Smoke of frame") == [reason.replace("frame 1", "frame 2")]
    path = volume_files.bake.volume_path(volume_files.folder(stage), 2)
    path.parent.mkdir(parents=True)
    path.touch()
    assert not reasons(scene, "Smoke of frame")


def test_without_a_scene_there_is_a_remedy(scene):
    assert hidden_parts.why_not_drawn(scene) == ["Nothing is built in this scene: press Build scene"]
