import math

import bpy
import pytest
from firetwin.blender import nodes
from firetwin.scene import haze
from firetwin.shot.light import sky


def _red(stage, amount):
    group = haze.set_amount(stage, amount)
    for name in ("Colour", "Horizon"):
        group.nodes[name].outputs[0].default_value = (2.0, 0.0, 0.0, 1.0)


def _depth(height, distance, amount=1.0):
    """Optical depth of haze at `height` over a level distance, or of all air above it without one."""
    parts = ((sky.HAZE_HEIGHT, 1.0), (sky.LOW_HEIGHT, sky.LOW_HAZE))
    lengths = (part * math.exp(-height / scale) * (distance or scale) for scale, part in parts)
    return amount * sky.HAZE * sum(lengths)


def _look(stage, shoot, height, distance, **inputs):
    """Red of a black wall at `height` seen from `distance` above it (level if negative).

    Its material has these inputs other than they are.
    """
    material, tree = nodes.material("wall")
    tree.surface(haze.apply(tree, tree.emission((0.0, 0.0, 0.0)), stage))
    group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
    for name, value in inputs.items():
        group.inputs[name.replace("_", " ")].default_value = value
    scene, mesh = stage.scene, bpy.data.meshes.new("wall")
    size = 10.0 * abs(distance)
    if distance > 0.0:
        corners = [(-size, -size, height), (size, -size, height), (size, size, height), (-size, size, height)]
    else:
        corners = [
            (-size, -distance, -size),
            (size, -distance, -size),
            (size, -distance, size),
            (-size, -distance, size),
        ]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("wall", mesh))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.clip_end, camera.data.lens = 1.0e6, 5000.0  # nearly parallel rays
    camera.location = (0.0, 0.0, height + max(distance, 0.0))
    camera.rotation_euler = (0.0 if distance > 0.0 else math.pi / 2.0, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = 4
    return shoot(scene)[2, 2, 0]


def test_level_rays_fade_by_the_extinction_at_their_height(stage, shoot):
    _red(stage, 1.0)
    depth = _depth(2000.0, 30_000.0)
    assert _look(stage, shoot, 2000.0, -30_000.0) == pytest.approx(2.0 * (1.0 - math.exp(-depth)), rel=0.01)


def test_thick_haze_has_the_radiance_of_the_sky_at_the_horizon(stage, shoot):
    _red(stage, 1.0)
    haze.set_amount(stage, 1.0).nodes["Horizon"].outputs[0].default_value = (5.0, 0.0, 0.0, 1.0)
    assert _look(stage, shoot, 0.0, -90_000.0) == pytest.approx(
        5.0 * (1.0 - math.exp(-_depth(0.0, 90_000.0))), rel=0.01
    )


def test_from_above_each_layer_of_air_is_one_scale_height_deep(stage, shoot):
    _red(stage, 1.0)
    depth = _depth(0.0, None)
    assert _look(stage, shoot, 0.0, 60_000.0) == pytest.approx(2.0 * (1.0 - math.exp(-depth)), rel=0.01)


def test_one_material_may_have_more_haze_of_another_colour(stage, shoot):
    _red(stage, 1.0)
    depth = _depth(0.0, None, 3.0)
    seen = _look(stage, shoot, 0.0, 60_000.0, Haze=3.0, Haze_Tint=(0.5, 1.0, 1.0, 1.0))
    assert seen == pytest.approx(1.0 - math.exp(-depth), rel=0.01)


def test_no_haze_hides_nothing(stage, shoot):
    _red(stage, 0.0)
    assert _look(stage, shoot, 0.0, 60_000.0) == pytest.approx(0.0, abs=1e-6)


def test_a_layer_of_smoke_near_the_ground_has_its_own_height(stage, shoot):
    _red(stage, 1.0)
    haze.set_amount(stage, 1.0, (3.0e-4, 2000.0))
    depth = sky.HAZE * math.exp(-1500.0 / sky.HAZE_HEIGHT) + 3.0e-4 * math.exp(-1500.0 / 2000.0)
    seen = _look(stage, shoot, 1500.0, -5000.0)
    assert seen == pytest.approx(2.0 * (1.0 - math.exp(-depth * 5000.0)), rel=0.01)
    lit = haze.illumination(stage)
    assert lit["haze"] == pytest.approx((sky.HAZE, 3.0e-4))
    assert lit["haze_height"] == pytest.approx((sky.HAZE_HEIGHT, 2000.0))
