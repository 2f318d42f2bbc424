"""View layers and data passes, against what must come out exactly."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import compat, nodes, owned
from firetwin.imaging import colour_bar
from firetwin.passes import thermal
from firetwin.render import engine, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.scene import infrared
from firetwin.scene.build import PARTS
from firetwin.shot import passes
from firetwin.shot.fire import air_temperature
from firetwin_core import sensor

THERMAL = "drone/thermal/drone_thermal_000002.exr"
HEIGHT, PITCH = 120.0, np.radians(80.0)  # of the camera over the plane; 90 degrees looks at the horizon


@pytest.fixture
def plain(settings, stage, scene, shot):
    """A plane of 300 K under a 250 K sky, with a glowing card (800 K) and smoke before the camera."""
    parts = {name.title(): stage.part(name.title()) for name in PARTS}
    _quad(
        parts["Terrain"],
        "Ground",
        [(-9e4, -9e4, 0), (9e4, -9e4, 0), (9e4, 9e4, 0), (-9e4, 9e4, 0)],
        _surface("Ground", 300.0, shot, stage),
    )
    card = [(-8, 60, 60), (-2, 60, 60), (-2, 60, 100), (-8, 60, 100)]
    _quad(parts["Fire"], "Card", card, _surface("Card", 800.0, shot, stage))
    bpy.ops.mesh.primitive_cube_add(size=30, location=(20, 90, 90))
    smoke = bpy.context.object
    smoke.users_collection[0].objects.unlink(smoke)
    parts["Smoke"].objects.link(smoke)
    material, tree = nodes.material("Firetwin Smoke")
    black = tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": 1.0})
    tree.volume(infrared.select_smoke_shader(tree, shot, stage, black, tree.math("ADD", 1.0, 0.0)))
    smoke.data.materials.append(material)
    world = scene.world = bpy.data.worlds.new("Firetwin Sky")
    tree = nodes.Tree(compat.node_tree(world))
    seen = tree.output("ShaderNodeBackground", {"Color": (0.4, 0.5, 0.6), "Strength": 1.0})
    cold = tree.output(
        "ShaderNodeBackground", {"Color": (1.0, 1.0, 1.0), "Strength": infrared.sky_radiance(shot)}
    )
    tree.surface(nodes.switch(tree, nodes.THERMAL, seen, cold))
    data = bpy.data.cameras.new("Firetwin Camera drone")
    data.clip_end, data.lens = 3e5, 28.0
    camera = owned.add(parts["Cameras"], "Camera drone", data, "camera drone")
    camera.location, camera.rotation_euler = (0.0, 0.0, HEIGHT), (PITCH, 0.0, 0.0)
    layers.build(settings, stage)
    engine.apply(settings, scene)
    return scene


def _surface(name, kelvin, shot, stage):
    material, tree = nodes.material(f"Firetwin {name}")
    shader = tree.output("ShaderNodeBsdfDiffuse", {"Color": (0.2, 0.3, 0.1)})
    tree.surface(nodes.thermal_switch(tree, shader, infrared.surface_radiance(tree, shot, stage, kelvin)))
    return material


def _quad(part, name, corners, material):
    mesh = bpy.data.meshes.new(f"Firetwin {name}")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    return owned.add(part, name, mesh)


@pytest.fixture
def render(plain, shot, stage, tmp_path):
    """Render passes of frame 2 into a folder and return their images by suffix."""

    def shoot(*names):
        wanted = [Picture("drone", 2, name) for name in names]
        made_with = {("drone", name): {"pass": name} for name in passes.known()}
        with open_session(tmp_path / "out", made_with) as here:
            pictures.render(shot, stage, here, wanted)
        return {
            path: np.asarray(sensor.read_image(tmp_path / "out" / path))
            for picture in wanted
            for path in picture.files()
        }

    return shoot


def test_depth_is_that_of_an_analytic_plane_behind_flames_and_smoke(render, settings):
    (depth,) = render("depth").values()
    width, height = settings.render.resolution
    assert depth.shape == (height, width, 2)
    # A ray through the middle of row r falls by d = cos(pitch) - y sin(pitch) per metre along the axis,
    # y = (height / 2 - r - 1/2) / focal length in pixels; it meets the plane at depth HEIGHT / d.
    y = (height / 2 - np.arange(height) - 0.5) / (28.0 / 36.0 * width)
    fall = np.cos(PITCH) - y * np.sin(PITCH)
    expected = np.where(fall > 0, HEIGHT / np.where(fall > 0, fall, 1), 1e10)
    seen = expected < 2e4
    assert 10 < seen.sum() < height
    # Cycles' narrowest filter still moves rays by up to half a hundredth of a pixel.
    shift = 0.005 / (28.0 / 36.0 * width) * np.sin(PITCH) * expected**2 / HEIGHT
    error = np.abs(depth[..., 0] - expected[:, None])[seen]
    assert (error <= 1.1 * shift[seen, None] + 1e-5 * expected[seen, None]).all()
    assert (depth[..., 0][expected > 1e9] == 1e10).all()


def test_temperatures_come_through_the_whole_chain(render):
    kelvin, radiance = np.moveaxis(render("thermal")[THERMAL], -1, 0)
    assert kelvin.dtype == np.float32
    assert kelvin[-6:, :8] == pytest.approx(300.0, abs=2e-3)
    assert (kelvin[0] > 250.0).all()
    assert (kelvin[0] < 299.0).all()
    assert kelvin.max() == pytest.approx(800.0, abs=2e-3)
    assert radiance == pytest.approx(sensor.radiance(kelvin), rel=1e-5)


def test_smoke_dims_the_infrared_a_little_and_adds_its_own(render, shot):
    """30 m of smoke that is black in the visible picture: a depth of 0.24 between 8 and 14 um."""
    radiance = render("thermal")[THERMAL][..., 1]
    clear, behind = radiance[18:30, :4].mean(), radiance[20:26, 40:44].mean()
    air = sensor.radiance(300.0)
    through = np.exp(-30.0 * infrared.SOOT * infrared.GREEN / 11.0)
    assert 0.7 < through < 0.85
    assert clear == pytest.approx(float(air), rel=1e-3)
    assert abs(behind / clear - 1.0) < 0.1  # smoke as warm as the air, before ground as warm


def test_the_denoiser_leaves_temperatures_alone(render, settings, stage, plain):
    denoised = replace(settings, render=replace(settings.render, denoise=True))
    engine.apply(denoised, plain)
    layers.build(denoised, stage)
    kelvin = next(i for path, i in render("thermal").items() if path.endswith("exr"))
    assert kelvin[-6:, :8, 0] == pytest.approx(300.0, abs=2e-3)


def test_the_thermal_picture_shows_its_temperatures(render, settings, shot):
    images = render("thermal")
    kelvin = images[THERMAL][..., 0]
    low, high = thermal.scale(shot, 2)
    coldest = air_temperature.coldest_ground(shot.run, shot.frames.time(2), (8.0, 14.0))
    assert (low, high) == (coldest, settings.render.thermal_high)
    cold = thermal.cold_range(shot)
    expected = colour_bar.paint(kelvin, low, high, settings.thermal.palette, thermal.KNEE, cold)
    shown = images["drone/thermal/drone_thermal_000002.png"][..., :3]
    assert np.abs(shown - expected).max() <= 0.5 / 255 + 1e-6


def test_smoke_is_in_the_picture_and_the_picture_is_display_colour(render):
    images = render("rgb")
    linear = images["drone/rgb/drone_rgb_000002.exr"]
    shown = images["drone/rgb/drone_rgb_000002.png"]
    assert linear.shape == (*shown.shape[:2], 3)
    assert linear[18:30, 38:46].max() < 0.01 < linear[18:30, :8].min()  # the black smoke
    bright, dark = (
        np.unravel_index(linear[..., 2].argmax(), linear.shape[:2]),
        np.unravel_index(linear[..., 2].argmin(), linear.shape[:2]),
    )
    assert shown[bright][2] > shown[dark][2]
    assert not np.allclose(shown[..., :3], linear, atol=0.02)


def test_only_the_files_of_the_passes_asked_for_are_made(render, tmp_path):
    render("depth")
    files = {
        str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*") if path.is_file()
    }
    assert files == {"store.sqlite", "drone/depth/drone_depth_000002.exr"}


def test_a_scene_as_built_writes_no_stray_files(plain, tmp_path):
    plain.camera = bpy.data.objects["Firetwin Camera drone"]
    plain.render.filepath = str(tmp_path / "shown.png")
    before = set(tmp_path.rglob("*"))
    bpy.ops.render.render(write_still=True)
    assert {path.name for path in set(tmp_path.rglob("*")) - before} == {"shown.png"}


def test_layers_leave_out_what_their_sensor_does_not_see(plain):
    def left_out(layer):
        parts = plain.view_layers[layer].layer_collection.children["Firetwin"].children
        return {part.name for part in parts if part.exclude}

    assert left_out("rgb") == set()
    assert left_out("thermal") == {"Firetwin Labels", "Firetwin Stations"}
    written = {"Firetwin Labels", "Firetwin Stations"}
    assert left_out("depth") == {"Firetwin Smoke", "Firetwin Fire", *written}


def test_depth_is_drawn_without_materials_unless_one_is_an_artists(plain):
    depth, normal = (plain.view_layers[name] for name in ("depth", "normal"))
    with layers.black_materials(plain, ["depth", "normal"]):
        black = depth.material_override.name
        assert normal.material_override is None
    assert depth.material_override is None
    assert black not in bpy.data.materials
    bpy.data.objects["Firetwin Card"].data.materials.append(bpy.data.materials.new("Lace"))
    with layers.black_materials(plain, ["depth"]):
        assert depth.material_override is None
