import math

import pytest
from firetwin.blender import nodes
from firetwin.scene import clock
from firetwin_core import sensor


def _show(plate, build):
    material, tree = nodes.material("test")
    tree.surface(build(tree))
    plate.materials.clear()
    plate.materials.append(material)


def test_arithmetic_on_sockets_is_what_it_says(scene, plate, shoot):
    def formula(tree):
        two = tree.math("ADD", 2.0, 0.0)
        red = (3.0 - two) / 4.0 + two * 0.5 - 0.25  # 1.0
        green = (-two).exp() + two.power(3.0)  # exp(-2) + 8
        blue = two.smoothstep(0.0, 4.0) + two.ramp(0.0, 4.0, 1.0, 3.0)  # 0.5 + 2
        return tree.emission(tree.combine(red, green, blue))

    _show(plate, formula)
    assert shoot(scene)[2, 2] == pytest.approx([1.0, math.exp(-2) + 8.0, 2.5], rel=1e-5)


def test_model_time_reaches_shaders_at_every_frame(scene, plate, shoot, shot, stage):
    clock.build(shot, stage)
    _show(plate, lambda tree: tree.emission((1.0, 1.0, 1.0), nodes.model_time(tree)))
    for frame, seconds in ((1, 0.0), (2, 1800.0), (3, 3600.0), (5, 7200.0)):
        scene.frame_set(frame)
        assert shoot(scene)[2, 2, 0] == pytest.approx(seconds, abs=1e-3)
        assert shot.frames.time(frame) == pytest.approx(seconds)


def test_thermal_layers_show_a_number_and_others_the_shader(scene, plate, shoot):
    _show(plate, lambda t: nodes.thermal_switch(t, t.emission((0.2, 0.3, 0.4)), t.math("ADD", 311.5, 0.0)))
    scene.view_layers[0].name = "rgb"
    scene.view_layers.new("thermal")[nodes.THERMAL] = 1.0
    assert shoot(scene, "rgb")[2, 2] == pytest.approx([0.2, 0.3, 0.4], abs=1e-5)
    assert shoot(scene, "thermal") == pytest.approx(float(sensor.brightness_temperature(311.5)), rel=1e-5)
