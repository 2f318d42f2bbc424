"""Smoke is lost nowhere: not to the step, and not in blocks with straight edges to layers or instances."""

import itertools
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.render import engine
from firetwin.scene import haze
from firetwin.scene.smoke import build as smoke
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.shot.sections import SmokeSettings
from firetwin.shot.shot import Shot
from firetwin.smoke import bake, sources

VOXEL = 40.0
SHAPE = (96, 48, 224)
EYE = (200.0, 900.0, 400.0)  # m, in clear smoke
WALL, AIR = np.s_[56:88, 8:40, 0:24], 0.0015  # thick smoke; a dilution that is there but cannot be seen
LAYERS = 12
BLOCK = 6  # pixels


def write(path, density, dilution):
    """Write the grids of a smoke frame from its clipped distance and its dilution, of one shape."""
    bpy.utils.expose_bundled_modules()
    import openvdb

    size = np.where(dilution > 0.0, 1.0, 0.0)
    values = {"density": density, "dilution": dilution, "shade": dilution, "size": size, "glow": 0.0 * size}
    grids = []
    for name, array in values.items():
        grid = openvdb.FloatGrid()
        grid.copyFromArray(np.asarray(array, np.float32))
        grid.name, grid.transform = name, openvdb.createLinearTransform(voxelSize=VOXEL)
        grids.append(grid)
    path.parent.mkdir(parents=True, exist_ok=True)
    openvdb.write(str(path), grids=grids)


def layered(layers):
    """A wall of thick smoke, clear smoke from the camera to it, and layers of clear smoke overhead."""
    thin = np.zeros(SHAPE, bool)
    thin[:, :, :24] = True
    for k in range(layers):
        thin[:, :, 32 + 16 * k : 40 + 16 * k] = True
    density, dilution = thin.astype(float), thin * AIR
    dilution[WALL] = 1.0
    return density, dilution


def puffy():
    """Puffs of 120 to 260 m, some before others, with sky between them."""
    rng = np.random.default_rng(4)
    place = np.stack(np.meshgrid(*(VOXEL * np.arange(n) for n in (96, 48, 32)), indexing="ij"), axis=-1)
    distance = np.full(place.shape[:3], -300.0)
    for centre, radius in zip(
        rng.uniform((1500, 200, 100), (3500, 1700, 900), (60, 3)), rng.uniform(120, 260, 60), strict=True
    ):
        distance = np.maximum(distance, radius - np.linalg.norm(place - centre, axis=-1))
    density = np.clip((distance + 300.0) / 600.0, 0.0, 1.0)
    return density, np.where(density > 0.0, 0.05, 0.0)


@pytest.fixture
def look(settings, run, stage, scene, shoot, tmp_path, monkeypatch):
    """Brightness of a view from within clear smoke: (blocks up, blocks across)."""
    monkeypatch.setattr(Shot, "scale", Scale())
    monkeypatch.setattr(sources, "choose", lambda *_: sources.known()["model"])
    smoky = replace(settings, smoke=SmokeSettings(voxel_size=VOXEL), time=replace(settings.time, frames=1))

    count = itertools.count()

    def picture(grids, instances=0, step=1.0, sun=False):
        taken = replace(smoky, cache=tmp_path / str(next(count)))  # Blender caches the content of a file
        shot = Shot(taken, run)
        write(bake.file(shot, 1), *grids)
        smoke.build(shot, stage).data.render.step_size *= step
        haze.set_amount(stage, 0.0)
        engine.apply(taken, scene)
        surroundings(scene, sun)
        if instances:
            plant(scene, instances)
        pixels = shoot(scene).mean(-1)[: 36 // BLOCK * BLOCK, : 64 // BLOCK * BLOCK]
        return pixels.reshape(36 // BLOCK, BLOCK, -1, BLOCK).mean((1, 3))

    return picture


def surroundings(scene, sun):
    """A camera, and a bright sky or the sun overhead."""
    for thing in [thing for thing in scene.objects if thing.type in ("CAMERA", "LIGHT")]:
        bpy.data.objects.remove(thing)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0 if sun else 1.0
    scene.world = world
    camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    camera.location, camera.rotation_euler = EYE, (np.pi / 2.0, 0.0, -np.pi / 2.0)
    camera.data.clip_end, camera.data.lens = 1.0e5, 24.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    if sun:
        light = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
        light.data.energy = 40.0
        scene.collection.objects.link(light)


def plant(scene, count):
    """Place instances below the smoke, outside of the view."""
    rng = np.random.default_rng(1)
    place = rng.uniform((-4000.0, -4000.0, -400.0), (60.0, 6000.0, -300.0), (count, 3))
    points, tree = bpy.data.meshes.new("points"), bpy.data.meshes.new("tree")
    points.from_pydata(place, [], [])
    tree.from_pydata([(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 12)], [], [(0, 2, 1), (0, 1, 3), (1, 2, 3)])
    wood, model = bpy.data.objects.new("wood", points), bpy.data.objects.new("tree", tree)
    wood.instance_type, model.parent = "VERTS", wood
    for thing in (wood, model):
        scene.collection.objects.link(thing)


def test_tens_of_thousands_of_instances_take_no_smoke(look):
    alone = look(layered(LAYERS))
    assert alone.min() < 0.15 < 0.9 < alone.max()  # smoke occludes the sky; next to it is sky
    assert look(layered(LAYERS), instances=30_000) == pytest.approx(alone, abs=0.02)


def test_layers_over_a_camera_take_no_smoke(look):
    assert look(layered(LAYERS)) == pytest.approx(look(layered(0)), abs=0.03)


def test_layers_between_smoke_and_sun_take_no_light(look):
    clear = look(layered(0), sun=True)
    assert clear.max() > 0.1
    assert look(layered(LAYERS), sun=True) == pytest.approx(clear, abs=0.15 * float(clear.max()))


def test_the_step_takes_no_smoke(look):
    """Sky through the smoke, beyond that through smoke drawn at a quarter of the step, in the worst block."""
    finest = look(puffy(), step=0.25)
    lost = {step: float((look(puffy(), step=step) - finest).max()) for step in (1.0, 4.0)}
    assert lost[1.0] < 0.05
    assert lost[4.0] > 0.07
