import bpy
from firetwin.scene import build
from firetwin.scene.light import build as light

KINDS = ("objects", "meshes", "materials", "node_groups", "lights", "cameras", "worlds", "collections")
KINDS += ("actions", "volumes")


def _names():
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in KINDS}


def test_the_scene_is_grouped(built):
    scene = built.scene
    parts = {child.name for child in bpy.data.collections["Firetwin"].children}
    assert {f"Firetwin {part}" for part in ("Terrain", "Forest", "Cameras", "Light")} <= parts
    assert scene.camera.name == "Firetwin Camera drone"
    assert (scene.frame_start, scene.frame_end) == (1, 3)


def test_what_could_not_be_built_as_it_should_be_is_told(shot, stage, scene, monkeypatch):
    monkeypatch.setattr(light, "build", lambda _shot, _stage: ["no sun today"])
    told = []
    build.build(shot, scene, ["light"], told.append)
    assert told == ["no sun today"]


def test_a_scene_of_the_artist_is_as_before_when_ours_is_removed(near_shot, scene, plain_looks):
    scene.world = bpy.data.worlds.new("mine")
    scene.camera = bpy.data.objects.new("mine", bpy.data.cameras.new("mine"))
    scene.collection.objects.link(scene.camera)
    before = _names(), scene.frame_end, scene.view_settings.view_transform
    build.build(near_shot, scene)
    once = _names()
    build.build(near_shot, scene)
    assert _names() == once
    assert bpy.data.objects["Firetwin Ground"].users_scene == (scene,)
    build.remove(scene)
    assert (_names(), scene.frame_end, scene.view_settings.view_transform) == before
    assert (scene.world.name, scene.camera.name) == ("mine", "mine")
    assert not scene.keys()
