"""The switch between film and live scene: nothing is built, and renders always show the film's scene."""

import bpy
import pytest
from firetwin.blender import owned
from firetwin.scene.camera import ground_raycast
from firetwin.scene.live import switch
from live_scene import *  # noqa: F403

LIVE = "Firetwin Live Ground"
FILM = {"Firetwin Ground", "Firetwin Trees"}


def shown(scene):
    """Names of the objects that 3D views draw."""
    scene.view_layers[0].update()
    return {each.object.name for each in scene.view_layers[0].depsgraph.object_instances}


def rendered(scene):
    """Names of objects that no collection excludes from renders."""

    def walk(collection):
        if not collection.hide_render:
            yield from (obj.name for obj in collection.objects if not obj.hide_render)
            for child in collection.children:
                yield from walk(child)

    return {*walk(scene.collection)}


def test_3d_views_show_one_of_both_and_nothing_is_built(live_stage):
    scene, blocks = live_stage.scene, len(bpy.data.meshes)
    assert switch.has_live(scene)
    assert not switch.is_live(scene)
    assert shown(scene) >= FILM
    assert LIVE not in shown(scene)
    switch.show_live(scene, True)
    assert switch.is_live(scene)
    assert LIVE in shown(scene)
    assert not FILM & shown(scene)
    switch.show_live(scene, False)
    assert shown(scene) >= FILM
    assert LIVE not in shown(scene)
    assert len(bpy.data.meshes) == blocks


@pytest.mark.parametrize("on", [False, True])
def test_renders_always_show_the_film(live_stage, on):
    before = rendered(live_stage.scene)
    switch.show_live(live_stage.scene, on)
    assert rendered(live_stage.scene) == before
    assert before >= FILM
    assert LIVE not in before


def test_a_scene_without_a_live_one_stays_as_it_is(built):
    switch.show_live(built.scene, True)
    assert not switch.is_live(built.scene)
    assert "Firetwin Ground" in shown(built.scene)


def test_emptying_it_shows_the_film_again(live_stage):
    switch.show_live(live_stage.scene, True)
    switch.empty(live_stage)
    assert not switch.has_live(live_stage.scene)
    assert shown(live_stage.scene) >= FILM
    assert owned.is_ours(switch.collection(live_stage.scene), switch.COLLECTION)


def test_heights_are_of_the_ground_that_3d_views_show(live_stage):
    """Viewers stand on what they see; without the live ground, nothing hidden could be met."""
    film = ground_raycast.terrain_height(live_stage, (300.0, 200.0))
    switch.show_live(live_stage.scene, True)
    live = ground_raycast.terrain_height(live_stage, (300.0, 200.0))
    assert live != film
    assert live == pytest.approx(film, abs=100.0)  # a coarse mesh
