"""Air about a curved Earth against integrals along the true ray, and the sky of cameras that leave it."""

import math
from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene import curved_air, haze, space_sky
from firetwin.scene.light import build as light
from firetwin.shot.light import sky
from firetwin.shot.shot import Shot
from firetwin_core import geo
from mathutils import Vector
from scipy.integrate import quad

FRAME = geo.LocalFrame(38.8, -120.5, 0.0)


def integral(start, end):
    """Air (m at height 0) along a straight line, by heights over the ellipsoid."""
    start, end = np.array(start, float), np.array(end, float)
    length = float(np.linalg.norm(end - start))

    def thin(part):
        height = float(FRAME.reverse((start + part * (end - start))[None])[2][0])
        return math.exp(-height / sky.HAZE_HEIGHT)

    points = np.geomspace(1e-6, 0.999, 12).tolist()
    return length * quad(thin, 0.0, 1.0, epsrel=1e-6, points=points, limit=200)[0]


def facing(place, eye):
    """Corners of a plate at a place that faces an eye."""
    back = np.array(eye, float) - place
    back /= np.linalg.norm(back)
    right = np.cross(back, [0.3, 0.9, 0.2])
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    return [tuple(place + 2e4 * (a * right + b * up)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def camera_at(scene, eye, toward):
    """A narrow camera that looks from a place to another."""
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.clip_end, camera.data.lens, camera.data.sensor_width = 1.0e8, 5000.0, 1.0
    camera.location = eye
    camera.rotation_mode = "QUATERNION"
    camera.rotation_quaternion = Vector(np.array(toward, float) - eye).to_track_quat("-Z", "Y")
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = 4


@pytest.mark.parametrize(
    ("height", "bearing", "distance", "eye"),
    [
        (0.0, 0.0, 0.0, 2.0e6),  # straight down from space
        (0.0, 90.0, 0.0, 60_000.0),
        (2000.0, 0.0, 30_000.0, 2000.0),  # level
        (0.0, 45.0, 300_000.0, 20_000.0),  # grazing
        (1500.0, 200.0, 2_000_000.0, 1.0e6),  # a place far away, slanting, from orbit
        (0.0, 300.0, 1_500_000.0, 180_000.0),  # the horizon
        (2500.0, 10.0, 40_000.0, 300.0),  # from a valley to a summit
    ],
)
def test_haze_is_that_of_the_true_ray(stage, shoot, height, bearing, distance, eye):
    curved_air.set_frame(stage, FRAME)
    group = haze.set_amount(stage, 1.0)
    group.nodes["Colour"].outputs[0].default_value = (2.0, 2.0, 2.0, 1.0)
    angle = distance / 6.371e6
    sine = math.sin(math.radians(38.8)) * math.cos(angle)
    sine += math.cos(math.radians(38.8)) * math.sin(angle) * math.cos(math.radians(bearing))
    latitude = math.degrees(math.asin(sine))
    away = math.atan2(
        math.sin(math.radians(bearing)) * math.sin(angle) * math.cos(math.radians(38.8)),
        math.cos(angle) - math.sin(math.radians(38.8)) * sine,
    )
    place = FRAME.forward([latitude], [-120.5 + math.degrees(away)], [height])[0]
    start = np.array([0.0, 0.0, eye])
    material, tree = nodes.material("wall")
    tree.surface(haze.apply(tree, tree.emission((0.0, 0.0, 0.0)), stage))
    mesh = bpy.data.meshes.new("wall")
    mesh.from_pydata(facing(place, start), [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    stage.scene.collection.objects.link(bpy.data.objects.new("wall", mesh))
    camera_at(stage.scene, start, place)
    path = integral(place, start)
    red, _, blue = shoot(stage.scene)[2, 2]
    assert red == pytest.approx(2.0 * (1.0 - math.exp(-sky.HAZE * path)), rel=0.015)
    molecules = (space_sky.DEPTH[2] - space_sky.DEPTH[0]) * path / sky.HAZE_HEIGHT if eye > 15_000.0 else 0.0
    depth = sky.HAZE * path + molecules
    assert blue == pytest.approx(2.0 * (1.0 - math.exp(-depth)), rel=0.015), (
        "blue from above the atmosphere alone"
    )


def sky_at(shot, stage, shoot, height, elevation):
    """Luminance of the sky from a height (m) at an angle (degrees) over the horizontal, to the north."""
    if stage.scene.world is None:
        light.build(shot, stage)
        stage.scene.world.cycles.sampling_method = "NONE"  # nothing is lit; its map takes seconds
    up = math.radians(elevation)
    eye = np.array([0.0, 0.0, height])
    camera_at(stage.scene, eye, eye + np.array([0.0, math.cos(up), math.sin(up)]))
    return shoot(stage.scene)[2, 2]


@pytest.fixture
def noon(settings, run):
    return Shot(replace(settings, cameras=()), run)


def test_the_sky_darkens_with_height_and_is_that_of_the_ground_below(noon, stage, shoot):
    usual = [sky_at(noon, stage, shoot, 100.0, angle) for angle in (5.0, 40.0, 89.0)]
    stage.scene.world = None
    curved_air.set_frame(stage, FRAME)
    for angle, wanted in zip((5.0, 40.0, 89.0), usual, strict=True):
        assert sky_at(noon, stage, shoot, 100.0, angle) == pytest.approx(wanted, rel=0.03)
    heights = (100.0, 5000.0, 10_000.0, 20_000.0, 40_000.0, 100_000.0)
    zenith = [float(sky_at(noon, stage, shoot, each, 89.0).mean()) for each in heights]
    assert (np.diff(zenith) < 0.0).all()
    assert zenith[3] < 0.15 * zenith[0], "a tenth of the air is over 20 km"
    assert zenith[-1] < 1e-3


def test_the_limb_is_thin_and_blue_at_its_upper_end(noon, stage, shoot):
    """From 200 km the horizon is 14.2 degrees down; 1.5 degrees over it lie 40 km of height."""
    curved_air.set_frame(stage, FRAME)
    dip = math.degrees(math.acos(6371.0 / 6571.0))
    low, middle, high = (
        sky_at(noon, stage, shoot, 200_000.0, angle) for angle in (-dip + 0.1, -dip + 0.9, -dip + 4.0)
    )
    assert low.mean() > 0.1
    assert middle[2] > 2.0 * middle[0]
    assert high.mean() < 1e-3


def test_from_space_stars_are_in_the_night_sky_below_the_horizontal_too(noon, stage, shoot):
    curved_air.set_frame(stage, FRAME)
    time = replace(noon.settings.time, start=datetime(2014, 9, 24, 8, tzinfo=UTC), end=None, frames=1)
    night = Shot(replace(noon.settings, time=time), noon.run)
    for elevation in (30.0, -8.0):  # the Earth's limb is 14.2 degrees down
        assert sky_at(night, stage, shoot, 200_000.0, elevation).max() > 5e-9
    stage.scene.world = None
    assert sky_at(noon, stage, shoot, 200_000.0, 30.0).max() < 1e-9, "a film by day records none"
