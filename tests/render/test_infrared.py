"""Infrared radiance in shaders: temperatures of the run, sun, pixels of two temperatures, air."""

import shutil
from dataclasses import replace

import bpy
import numpy as np
import pytest
import rendered
import whole_run
from firetwin.blender import nodes
from firetwin.render import engine
from firetwin.run import opening as runs
from firetwin.scene import build, clock, infrared, temperature
from firetwin.scene.smoke import flow_material
from firetwin.shot.fire import air_temperature as airs
from firetwin.shot.sections import Thermal
from firetwin.shot.shot import Shot
from firetwin_core import sensor, volume

TWO_CELLS = """\
run = "run"
time = { start = 2020-07-01T20:08:33Z, frames = 1 }
forest = { trees = false, grass = false }
smoke = { enabled = false }
terrain = { near_radius = 0.0, apron = 2000.0 }
[render]
resolution = [32, 24]
samples = 1
denoise = false
passes = ["thermal"]
[[cameras]]
name = "drone"
over_ridges = false
keys = [{ latitude = 38.899, longitude = -120.6, height = 300.0, target = "fire" }]
"""


@pytest.fixture
def plates(scene, shot, stage):
    """Show radiances, functions of (tree, shot, stage), side by side in 5 by 5 pixels."""

    def show(*radiances, by=shot):
        for index, radiance in enumerate(radiances):
            edges = np.linspace(-2.5, 2.5, len(radiances) + 1)[index : index + 2]
            mesh = bpy.data.meshes.new(f"plate {index}")
            corners = [(edges[0], -3, 0), (edges[1], -3, 0), (edges[1], 3, 0), (edges[0], 3, 0)]
            mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
            material, tree = nodes.material(f"plate {index}")
            tree.surface(nodes.thermal_switch(tree, tree.emission((0, 0, 0)), radiance(tree, by, stage)))
            mesh.materials.append(material)
            scene.collection.objects.link(bpy.data.objects.new(mesh.name, mesh))
        data = bpy.data.cameras.new("above")
        data.type, data.ortho_scale = "ORTHO", 5.0
        camera = bpy.data.objects.new("above", data)
        camera.location = (0.0, 0.0, 2.0)
        scene.collection.objects.link(camera)
        scene.camera = camera
        scene.render.resolution_x = scene.render.resolution_y = 5

    return show


def own(kelvin, emissivity=1.0):
    return lambda tree, shot, stage: infrared.surface_radiance(tree, shot, stage, kelvin, emissivity)


@pytest.mark.parametrize("kelvin", [200.0, 300.0, 1000.0, 1500.0])
def test_a_black_body_comes_back_within_a_millikelvin(plates, scene, shoot, kelvin):
    plates(own(kelvin))
    assert shoot(scene, "thermal") == pytest.approx(kelvin, abs=1e-3)


def test_a_pixel_half_and_half_is_the_mean_of_radiance(plates, scene, shoot):
    plates(own(300.0), own(1200.0))
    kelvin = shoot(scene, "thermal")[2, :, 0]
    assert kelvin[[0, 4]] == pytest.approx([300.0, 1200.0], abs=2e-3)
    assert kelvin[2] == pytest.approx(840.0, abs=3.0)


def test_what_is_not_black_mirrors_the_sky(plates, scene, shoot, shot):
    plates(own(300.0, 0.9))
    expected = 0.9 * sensor.radiance(300.0) + 0.1 * infrared.sky_radiance(shot)
    assert sensor.radiance(shoot(scene, "thermal")) == pytest.approx(float(expected), rel=1e-4)


def test_the_middle_infrared_is_another_band(plates, scene, shoot, settings, run, stage):
    other = Shot(replace(settings, thermal=Thermal(band="mwir")), run)
    plates(own(1000.0), by=other)
    infrared.build(other, stage)
    found = sensor.radiance(shoot(scene, "thermal"))
    assert found == pytest.approx(float(sensor.radiance(1000.0, (3.4, 4.1))), rel=1e-4)


def test_air_lets_through_what_its_vapour_says(plates, scene, shoot, settings, run, stage):
    wet = Shot(replace(settings, thermal=Thermal(vapour=7.0)), run)

    def far(tree, shot, stage):
        return infrared.radiance_at_camera(tree, shot, stage, tree.math("ADD", 2000.0, 0.0))

    plates(far, by=wet)
    scene.camera.location.z = 1000.0
    scene.camera.data.clip_end = 2000.0
    infrared.build(wet, stage)
    found = float(sensor.radiance(shoot(scene, "thermal")).mean())
    mean = 2.0 * (1.0 - np.exp(-0.5))  # of the vapour between 0 and 1 km
    through = np.exp(-0.21 * mean**0.75)
    air = sensor.radiance(airs.at(run, 0.0).max())
    assert found == pytest.approx(through * 2000.0 + (1.0 - through) * float(air), rel=0.01)


def test_heat_comes_through_smoke_by_its_depth_in_long_steps_too(
    plates, scene, shoot, settings, run, stage, tmp_path
):
    """A hot plate under 2 km of smoke: exp(-0.008 x extinction x depth) of it is left, see `infrared`."""
    clear = replace(settings, thermal=Thermal(vapour=0.0))
    plates(own(900.0), by=Shot(clear, run))
    thick, voxel, origin = 0.03, 50.0, (-200.0, -200.0, 125.0)
    layers = thick * (1.0 + np.sin(np.arange(40) * np.pi / 10.0))
    grids = {"density": np.broadcast_to(layers, (9, 9, 40)).astype(np.float32)}
    volume.write(tmp_path / "slab.vdb", grids, voxel, origin)
    data = bpy.data.volumes.new("slab")
    data.filepath = str(tmp_path / "slab.vdb")
    data.render.space, data.render.step_size = "WORLD", 60.0
    data.materials.append(flow_material.build(Shot(clear, run), stage))
    scene.collection.objects.link(bpy.data.objects.new("slab", data))
    scene.camera.location.z, scene.camera.data.clip_end = 3000.0, 1e4
    depth = thick * 40 * voxel * infrared.SOOT * 2.0 * infrared.GREEN / (8.0 + 14.0)
    table = sensor.PlanckTable()
    radiance = {}
    for long in (False, True):
        with engine.long_steps(scene, long):
            radiance[long] = table.radiance(shoot(scene, "thermal")[2, 2, 0])
    assert scene.cycles.volume_step_rate == 1.0
    left = np.exp(-depth)
    expected = table.radiance(900.0) * left + table.radiance(300.0) * (1.0 - left)
    assert 0.3 < depth < 0.6
    assert radiance[False] == pytest.approx(expected, rel=0.01)
    assert radiance[True] == pytest.approx(radiance[False], rel=0.01)


def test_sunlit_ground_is_warmer_than_shaded_and_crowns_are_near_the_air(plates, scene, shoot, shot):
    towards = np.array(temperature.sun.direction(*temperature.sun.position(shot.run, shot.frames.first)))

    def surface(normal, bare):
        return lambda tree, shot, stage: infrared.surface_radiance(
            tree, shot, stage, temperature.unburned_temperature(tree, shot, stage, 0.0, tuple(normal), bare)
        )

    plates(surface(towards, 1.0), surface(-towards, 1.0), surface(towards, 0.0))
    scene.frame_set(1)
    lit, _, shade, _, crowns = shoot(scene, "thermal")[2, :, 0]
    light = temperature.sun.direct(temperature.sun.position(shot.run, shot.frames.first)[1])
    assert 700.0 < light < 1000.0
    assert lit - shade == pytest.approx(0.85 * light / 30.0, rel=0.01)
    assert crowns - shade == pytest.approx((0.85 * light - 70.0) / 80.0 + 70.0 / 30.0, rel=0.01)


def test_unburned_ground_follows_the_temperature_of_the_run(
    settings, run_folder, tmp_path, scene, stage, shoot
):
    pictures = []
    for name, kelvin in (("cold", 300.0), ("warm", 310.0)):
        folder = shutil.copytree(run_folder, tmp_path / name)
        np.save(folder / "temperature.npy", np.full((11, 24, 24), kelvin, np.float32))
        own = replace(settings, run=folder, thermal=Thermal(vapour=0.0))
        build.build(Shot(own, runs.open(folder)), scene)
        scene.frame_set(1)
        pictures.append(shoot(scene, "thermal")[..., 0])
    cold, warm = pictures
    unburned = (cold > 285.0) & (cold < 330.0)
    assert unburned.mean() > 0.3
    assert np.median((warm - cold)[unburned]) == pytest.approx(10.0, abs=0.5)


def test_the_air_changes_with_the_time_of_the_shot(
    settings, run_folder, tmp_path, scene, stage, plates, shoot
):
    folder = shutil.copytree(run_folder, tmp_path / "run")
    field = np.repeat(np.linspace(290.0, 310.0, 11, dtype=np.float32), 24 * 24).reshape(11, 24, 24)
    np.save(folder / "temperature.npy", field)
    shot = Shot(replace(settings, run=folder), runs.open(folder))
    clock.build(shot, stage)
    plates(lambda *all: infrared.surface_radiance(*all, temperature.air_temperature_node(*all)), by=shot)
    kelvin = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        kelvin.append(float(shoot(scene, "thermal").mean()))
    assert np.diff(kelvin) == pytest.approx([10.0, 10.0], abs=0.01)
    height = float(
        np.mean(shot.run.elevation[11:13, 11:13])
    )  # of the model's ground; the plates lie at sea level
    assert kelvin[0] == pytest.approx(290.0 + airs.LAPSE * height, abs=0.5)


def test_the_fire_of_a_run_of_two_by_two_cells_is_hot(tmp_path):
    """Its ground has no cell without an edge, and all of it burns within one time."""
    whole_run.write(
        tmp_path / "run", cells=2, speed=0.1, lasts=300.0, times=tuple(60.0 * k for k in range(16))
    )
    _, out = rendered.everything(tmp_path, TWO_CELLS)
    (path,) = out.rglob("*.exr")
    kelvin = np.asarray(sensor.read_image(path))[..., 0]
    assert np.median(kelvin) == pytest.approx(310.0, abs=20.0)
    assert 400.0 < kelvin.max() < 1500.0
