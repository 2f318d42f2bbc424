"""Lamps in place of flames: few, steady, for ground and trees alone, at night alone."""

import bpy
import numpy as np
from firetwin.blender import mesh, nodes
from firetwin.render import layers
from firetwin.scene import build
from firetwin.scene.fire import build as fire
from firetwin.scene.fire import flames
from firetwin.shot.shot import Shot
from near_fire import moved


def built(settings, run, stage):
    """Build the whole scene with its view layers."""
    shot = Shot(settings, run)
    build.build(shot, stage.scene)
    layers.build(settings, stage)
    return shot


def lit():
    return [thing for thing in bpy.data.objects if thing.name.startswith("Firetwin Lamp")]


def alone(scene, lamps):
    """Leave these lamps the only light, in the second frame."""
    scene.frame_set(2)
    bpy.data.objects["Firetwin Sun"].hide_render = True
    bpy.data.objects["Firetwin Flames"].hide_render = True
    for node in scene.world.node_tree.nodes:
        if node.type == "BACKGROUND":
            node.inputs["Strength"].default_value = 0.0
    for tree in bpy.data.node_groups:
        for node in tree.nodes:
            if node.type == "EMISSION":
                strength = node.inputs["Strength"]
                for link in strength.links:
                    tree.links.remove(link)
                strength.default_value = 0.0
    assert lamps


def test_they_come_so_gradually_that_the_first_light_cannot_be_seen(near, run, stage, scene, sun_at, shoot):
    """A degree under the sun that ends them, no pixel gets a 255th of white from lamps; by night many do."""
    brightest = []
    for height in (5.0, -20.0):
        sun_at(height)
        built(near, run, stage)
        alone(scene, lit())
        brightest.append(np.max(shoot(scene, "rgb")))
    assert lit()
    assert brightest[0] < 1.0 / 255.0 < brightest[1]


def test_lamps_and_near_flames_light_the_ground_and_leave_temperatures_alone(
    near, run, stage, scene, sun_at, shoot
):
    sun_at(-20.0)
    built(near, run, stage)
    scene.frame_set(2)
    kelvin, light = shoot(scene, "thermal"), shoot(scene, "rgb")
    for thing in (*lit(), bpy.data.objects["Firetwin Flame Light"]):
        thing.hide_render = True
    assert np.array_equal(kelvin, shoot(scene, "thermal"))
    assert np.mean(light - shoot(scene, "rgb")) > 3.0e-4
    assert scene.view_layers["thermal"][nodes.THERMAL] == 1.0


def test_near_flames_light_the_side_towards_them_and_less_with_distance(close, run, stage, scene, shoot):
    shot = Shot(close, run)
    points = flames.front_flames(shot)
    burning = points.position[points.lit(float(shot.frames.first))]
    x, y, z = burning[np.argmax(burning[:, 0])]  # all flames are to the west of the plates
    latitude, longitude = (float(each[0]) for each in shot.ground.geodetic(np.array([x]), np.array([y])))
    shot = Shot(moved(close, latitude=latitude, longitude=longitude, height=60.0), run)
    fire.build(shot, stage)
    for thing in list(stage.root.all_objects):
        thing.hide_render = thing.name != "Firetwin Flame Light"
    for number, east in enumerate((20.0, 200.0)):
        south = y + 10.0 * number
        corners = [(x + east, south + a, z + b) for a, b in ((0, 0), (10, 0), (10, 10), (0, 10))]
        plate = mesh.create_mesh(f"plate {number}", corners, [(0, 1, 2, 3)])
        scene.collection.objects.link(bpy.data.objects.new("plate", plate))
    camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", 20.0, 1000.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = 32, 16
    seen = []
    for east, turn in ((10.0, -0.5), (210.0, 0.5)):
        camera.location, camera.rotation_euler = (x + east, y + 10.0, z + 5.0), (np.pi / 2, 0, turn * np.pi)
        picture = shoot(scene).mean(axis=(0, 2))
        seen.append([picture[:16].mean(), picture[16:].mean()])
    (far, close), behind = seen
    assert close > 1.5 * far > 0.0
    assert max(behind) < 0.05 * far
