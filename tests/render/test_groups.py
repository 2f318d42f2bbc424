"""Compositor node groups against the core on the same pictures: within 1e-5, one step of 8 bits."""

import bpy
import numpy as np
import pytest
from firetwin.blender import compat
from firetwin.render import groups
from firetwin.shot import sections
from firetwin.shot import settings as scene_settings
from firetwin.shot.sections.thermal import BANDS
from firetwin_core import sensor

HEIGHT, WIDTH = 24, 40
RANDOM = np.random.default_rng(5)


def colours():
    return RANDOM.uniform(0.0, 1.0, (HEIGHT, WIDTH, 3)).astype(np.float32)


def kelvin(low=200.0, high=1500.0):
    return np.geomspace(low, high, HEIGHT * WIDTH).astype(np.float32).reshape(HEIGHT, WIDTH)


@pytest.fixture
def composite(scene, stage, tmp_path):
    """Run a group on arrays and numbers by its inputs' names; an output as (h, w, channels)."""

    def run(name, band="lwir", output="Image", bits=32, **inputs):
        settings = scene_settings.Settings(thermal=sections.Thermal(band=band))
        groups.build(settings, stage)
        tree = compat.new_compositor(scene)
        node = tree.nodes.new("CompositorNodeGroup")
        node.node_tree = stage.root[f"group {name}"]
        for label, value in inputs.items():
            socket = compat.find_socket(node.inputs, label)
            if isinstance(value, np.ndarray):
                source = tree.nodes.new("CompositorNodeImage")
                source.image = _image(label, value)
                tree.links.new(source.outputs[0], socket)
            else:
                socket.default_value = value
        shown = compat.find_socket(node.outputs, output)
        compat.composite(tree, shown)
        scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
        scene.render.resolution_percentage = 100
        scene.view_settings.view_transform, scene.render.dither_intensity = "Raw", 0.0
        compat.still_settings(scene.render)
        if bits == 8:
            path = tmp_path / "made.png"
            scene.render.image_settings.color_depth = "8"
        else:
            path = tmp_path / "made000001.exr"
            compat.exr_output_path(compat.exr_output(tree, "EXR", shown, False, bits), str(tmp_path), "made")
        scene.render.filepath = str(tmp_path / "made.png")
        scene.render.engine = "CYCLES"
        bpy.ops.render.render(write_still=True)
        return sensor.read_image(path)[..., :3]

    return run


def _image(name, values):
    """An image of the numbers (h, w) or colours (h, w, 3) as they are."""
    pixels = np.ones((*values.shape[:2], 4), np.float32)
    pixels[..., :3] = values if values.ndim == 3 else values[..., None]
    image = bpy.data.images.new(name, values.shape[1], values.shape[0], float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels[::-1].ravel())
    image.pack()
    return image


def test_thermal_blend_is_the_papers_sum(composite):
    rgb, warm = colours() * 1.4 - 0.2, kelvin(280.0, 340.0)
    made = composite("Thermal Blend", Image=rgb, Kelvin=warm, Low=295.0, High=330.0, Strength=0.7)
    expected = sensor.thermal_composite(rgb, warm, 295.0, 330.0, 0.7)
    assert np.abs(made - expected).max() < 1e-5
    assert expected.std() > 0.1


@pytest.mark.parametrize("band", ["lwir", "mwir"])
def test_a_thermal_camera_reads_temperatures_off_radiance(composite, band):
    warm = kelvin(185.0, 1750.0)
    limits = BANDS[band]
    made = composite(
        "Thermal Camera", band, "Kelvin", Radiance=sensor.radiance(warm, limits).astype(np.float32)
    )
    assert np.abs(made[..., 0] / warm - 1.0).max() < 5e-6


@pytest.mark.parametrize(("number", "name"), list(enumerate(sensor.palettes(), 1)))
def test_a_thermal_camera_shows_the_palettes(composite, number, name):
    radiance = sensor.radiance(kelvin()).astype(np.float32)
    made = composite("Thermal Camera", Radiance=radiance, Low=290.0, High=900.0, Knee=8.0, Palette=number)
    seen = sensor.PlanckTable().brightness_temperature(radiance)
    assert np.abs(made - sensor.colour(seen, 290.0, 900.0, name, 8.0)).max() < 1e-5


@pytest.mark.parametrize("radius", [1, 3])
def test_eye_dome_darkens_what_is_behind_its_neighbours(composite, radius):
    rgb, depth = colours(), RANDOM.uniform(300.0, 3000.0, (HEIGHT, WIDTH)).astype(np.float32)
    depth[:6] = 1e10  # the sky
    made = composite("Eye Dome", Image=rgb, Depth=depth, Strength=2.5, Radius=radius)
    expected = rgb * sensor.eye_dome(depth, 2.5, radius)[..., None]
    assert np.abs(made - expected).max() < 1e-5
    assert expected[12:].mean() < 0.9 * rgb[12:].mean()


def test_overlay_lays_hot_spots_over_the_picture(composite):
    below, above, warm = colours(), colours(), kelvin(280.0, 600.0)
    inputs = {"From": 330.0, "To": 450.0, "Opacity": 0.8}
    made = composite("Overlay", Image=below, Thermal=above, Kelvin=warm, **inputs)
    expected = sensor.overlay(below, above, warm, 330.0, 450.0, 0.8)
    assert np.abs(made - expected).max() < 1e-5


def test_8_bit_pictures_differ_by_one_step_at_most(composite, tmp_path):
    below, above, warm = colours(), colours(), kelvin(280.0, 600.0)
    made = composite("Overlay", bits=8, Image=below, Thermal=above, Kelvin=warm)
    path = tmp_path / "file.png"
    sensor.write_image(path, sensor.overlay(below, above, warm, 350.0, 450.0, 0.9))
    assert np.abs(made - sensor.read_image(path)).max() < 1.01 / 255
