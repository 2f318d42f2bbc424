"""Air, clouds and lamps in the scene of a sample: each sample sets its own, and leaves none to the next."""

import dataclasses

import bpy
import numpy as np
import pytest
import small_plan
from firetwin.blender import owned
from firetwin.dataset import clouds, night_lamps, places, scene_air
from firetwin.dataset.draws import Drawer
from firetwin.run import sun
from firetwin.scene import haze
from firetwin.scene.light import build as light


@pytest.fixture
def sample(tmp_path):
    """Return the draw of a daylight sample, its shot, and an empty stage."""
    small_plan.write_run(tmp_path / "a")
    plan = small_plan.plan(folder=tmp_path, moments=1, count=4)
    draw = Drawer(plan).draw(1)
    draw = dataclasses.replace(draw, sun_elevation=40.0, kind="fire", cloud_cover=0.6)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    shared = places.shot_of_visit(plan, places.Visit((draw,)))
    with sun.fixed(draw.sun_azimuth, draw.sun_elevation):
        yield draw, places.shot_of_sample(shared, draw), owned.adopt(bpy.context.scene)


def _sun(stage):
    (lamp,) = (obj.data for obj in stage.objects_of("Light") if obj.type == "LIGHT")
    return lamp


def test_fog_takes_sunlight_and_colour_and_the_next_sample_has_both_again(sample):
    draw, shot, stage = sample
    energy, colours = [], []
    for kind in ("fire", "fog", "fire"):
        light.build(shot, stage)
        scene_air.apply(stage, dataclasses.replace(draw, kind=kind))
        energy.append(_sun(stage).energy)
        colours.append(np.array(haze.colours(stage)[0].default_value[:3]))
    assert energy[1] < 0.2 * energy[0]
    assert np.ptp(colours[1]) < 1e-6 < np.ptp(colours[0])
    assert energy[2] == energy[0]
    assert np.array_equal(colours[2], colours[0])


def test_clouds_are_in_the_visible_sky_alone(sample):
    draw, shot, stage = sample
    light.build(shot, stage)
    before = {node.name for node in stage.scene.world.node_tree.nodes}
    clouds.build(shot, stage, dataclasses.replace(draw, cloud_cover=0.0))
    assert {node.name for node in stage.scene.world.node_tree.nodes} == before
    clouds.build(shot, stage, draw)
    tree = stage.scene.world.node_tree
    linked = [
        node
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeBackground" and node.inputs["Color"].is_linked
    ]
    (background,) = linked
    assert background.inputs["Color"].links[0].from_node.name not in before
    light.build(shot, stage)
    assert {node.name for node in stage.scene.world.node_tree.nodes} == before


def test_lamps_are_in_the_view_and_those_of_another_sample_are_gone(sample):
    draw, shot, stage = sample
    with sun.fixed(0.0, -30.0):
        night_lamps.build(shot, stage, dataclasses.replace(draw, lamps=7))
        (lamps,) = stage.objects_of("Labels")
    corners = np.array([vertex.co for vertex in lamps.data.vertices])
    centre = corners.reshape(-1, 6, 3).mean(axis=1)
    assert 1 <= len(centre) <= 7
    (view,) = shot.paths
    seen = (centre - view.position[0]) @ view.rotation[0]
    assert (np.abs(seen[:, 0] / -seen[:, 2]) < view.half[0]).all()
    widths = np.ptp(corners.reshape(-1, 6, 3)[..., 0], axis=1)
    pixels = 2.0 * view.half[0] / shot.settings.render.resolution[0] * np.linalg.norm(seen, axis=1)
    assert (widths >= 1.99 * pixels).all()
    night_lamps.build(shot, stage, draw)
    assert not stage.objects_of("Labels")
