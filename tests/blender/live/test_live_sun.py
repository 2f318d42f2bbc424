"""Live sun: as the film's, without shadows, and in its place in 3D views."""

import bpy
import pytest
from firetwin.scene.live import sun, switch
from live_scene import *  # noqa: F403


def test_it_moves_and_shines_as_the_films_without_shadows(live_stage):
    film, live = bpy.data.objects["Firetwin Sun"], bpy.data.objects["Firetwin Live Sun"]
    assert film.data.use_shadow
    assert not live.data.use_shadow
    scene = live_stage.scene
    for frame in (1, scene.frame_end):
        seen = []
        for on, lamp in ((False, film), (True, live)):
            switch.show_live(scene, on)
            scene.frame_set(frame)
            seen.append([lamp.data.energy, *lamp.matrix_world.to_quaternion()])
        assert seen[0] == pytest.approx(seen[1])
        assert seen[0][0] > 0.0


def test_3d_views_have_one_sun(live_stage):
    film = bpy.data.objects["Firetwin Sun"]
    for on in (True, False):
        switch.show_live(live_stage.scene, on)
        assert film.hide_viewport == on
        assert not film.hide_render


def test_none_without_the_films(live_stage):
    bpy.data.objects.remove(bpy.data.objects["Firetwin Sun"])
    assert sun.build(live_stage, switch.collection(live_stage.scene)) is None


def test_nothing_casts_shadows_which_eevee_draws_again_for_each_lamp(live_stage):
    meshes = [obj for obj in switch.collection(live_stage.scene).all_objects if obj.type == "MESH"]
    assert meshes
    assert not any(obj.visible_shadow for obj in meshes)
