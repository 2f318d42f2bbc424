"""The other engine, in a separate process and without a display."""

import json
import subprocess
import sys

import numpy as np
import pytest
from firetwin.jobs import worker
from firetwin_core import sensor
from scene_text import DRONE, NO_PLANTS, NO_SMOKE

SCENE = (
    """\
run = "{run}"
[time]
frames = 2
"""
    + NO_PLANTS
    + NO_SMOKE
    + """\
[render]
engine = "eevee"
resolution = [64, 36]
samples = 1
passes = ["rgb", "thermal"]
"""
    + DRONE
)

# Black bodies side by side, 300, 1200 and 1000 K, in pixels of a metre; one of these is half and half.
PLATES = """\
import json, sys
import bpy
import numpy as np
from firetwin.blender import compat, nodes, owned
from firetwin.scene import infrared
from firetwin.run import opening
from firetwin.shot.settings import scene_file as file
from firetwin.shot.shot import Shot
from firetwin_core import sensor

settings = file.read(sys.argv[1])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
stage, shot = owned.adopt(scene), Shot(settings, opening.open(settings.run))
for kelvin, left, right in ((300.0, -12.0, 0.5), (1200.0, 0.5, 5.5), (1000.0, 5.5, 12.0)):
    mesh = bpy.data.meshes.new("plate")
    mesh.from_pydata([(left, -3, 0), (right, -3, 0), (right, 3, 0), (left, 3, 0)], [], [(0, 1, 2, 3)])
    material, tree = nodes.material("plate")
    radiance = infrared.surface_radiance(tree, shot, stage, kelvin)
    tree.surface(nodes.thermal_switch(tree, tree.emission((0, 0, 0)), radiance))
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("plate", mesh))
camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
camera.data.type, camera.data.ortho_scale, camera.location = "ORTHO", 18.0, (0.0, 0.0, 2.0)
scene.collection.objects.link(camera)
scene.camera = camera
scene.view_layers[0][nodes.THERMAL] = 1.0
scene.render.engine, scene.eevee.taa_render_samples = compat.eevee_id(), 64
scene.render.resolution_x, scene.render.resolution_y = 18, 4
compat.still_settings(scene.render)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = sys.argv[2]
bpy.ops.render.render(write_still=True)
radiance = np.asarray(sensor.read_image(sys.argv[2]))[2, :, 0]
print(json.dumps([radiance.tolist(), sensor.PlanckTable().brightness_temperature(radiance).tolist()]))
"""

# Rows and columns of the bright pixels of a live label, seen from two sides at different distances.
LABELS = """\
import json, sys
import bpy
import numpy as np
from mathutils import Vector
from firetwin.blender import compat, owned
from firetwin.scene.live import labels
from firetwin.run import opening
from firetwin.shot.settings import scene_file as file
from firetwin.shot.shot import Shot
from firetwin_core import sensor

settings = file.read(sys.argv[1])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
stage, shot = owned.adopt(scene), Shot(settings, opening.open(settings.run))
labels.build(shot, stage, stage.part("Live"))
place = Vector(shot.ground.point(38.840, -120.555).ravel().tolist())
camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
camera.data.lens, camera.data.clip_end = 16.0, 1.0e5
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine, scene.eevee.taa_render_samples = compat.eevee_id(), 4
scene.render.resolution_x, scene.render.resolution_y = 128, 72
compat.still_settings(scene.render)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.filepath = sys.argv[2]
found = []
for way in ((0.0, -5000.0, 0.0), (2000.0, 0.0, 0.0)):
    camera.location = place + Vector(way)
    camera.rotation_euler = (-Vector(way)).to_track_quat("-Z", "Y").to_euler()
    bpy.ops.render.render(write_still=True)
    bright = np.asarray(sensor.read_image(sys.argv[2]))[..., 0] > 0.3
    found.append([np.flatnonzero(bright.any(axis=axis)).tolist() for axis in (1, 0)])
print(json.dumps(found))
"""


def rendered(code, folder):
    """Run a program that renders with EEVEE the scene of a folder; return what it prints last, as JSON."""
    result = subprocess.run(
        [sys.executable, "-c", code, str(folder / "scene.toml"), str(folder / "picture.exr")],
        env=worker._environment(eevee=True),
        capture_output=True,
        text=True,
    )
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout.strip().splitlines()[-1])


@pytest.mark.slow
def test_live_labels_turn_to_each_eye_and_have_one_angle(run_folder, tmp_path):
    (tmp_path / "places.csv").write_text("name,latitude,longitude\nHILL,38.840,-120.555\n")
    places = '[labels]\nenabled = true\nfile = "places.csv"\nsize = 0.2\n'
    (tmp_path / "scene.toml").write_text(SCENE.format(run=run_folder) + places)
    first, second = rendered(LABELS, tmp_path)
    for one, other in zip(first, second, strict=True):
        assert len(one) > 5
        assert abs(one[0] - other[0]) <= 1
        assert abs(one[-1] - other[-1]) <= 1


@pytest.mark.slow
def test_eevee_gives_black_bodies_back_and_a_pixel_of_two_as_the_mean_of_radiance(run_folder, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE.format(run=run_folder))
    radiance, kelvin = map(np.array, rendered(PLATES, tmp_path))
    print(radiance, kelvin)
    expected = [float(sensor.radiance(each)) for each in (300.0, 1200.0, 1000.0)]
    # EEVEE's pixels are half floats, cut off after 11 bits: radiance is off by 1/1024 of itself at most.
    assert radiance[[3, 11, 16]] == pytest.approx(expected, rel=2.0**-10)
    assert kelvin[[3, 11, 16]] == pytest.approx([300.0, 1200.0, 1000.0], abs=0.5)
    assert radiance[9] == pytest.approx(0.5 * (expected[0] + expected[1]), rel=0.02)
    assert kelvin[9] == pytest.approx(840.0, abs=10.0)  # the mean of kelvin would be 750


@pytest.mark.slow
def test_eevee_renders_the_ground_under_the_sky_and_their_temperatures(run_folder, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE.format(run=run_folder))
    line = ["render", tmp_path / "scene.toml", "--out", tmp_path / "out", "--frames", "2"]
    result = subprocess.run(
        [sys.executable, "-m", "firetwin", *map(str, line)], capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr

    def image(name):
        return np.asarray(sensor.read_image(tmp_path / "out" / "drone" / name))

    picture = image("rgb/drone_rgb_000002.png")[..., :3]
    sky, ground = picture[:4].reshape(-1, 3), picture[-4:].reshape(-1, 3)
    assert sky.mean() > ground.mean() + 0.1
    assert sky.mean(0)[2] > sky.mean(0)[0]
    kelvin = image("thermal/drone_thermal_000002.exr")[..., 0]
    np.testing.assert_allclose(kelvin[:4], 250.0, atol=0.2)  # the sky, in half floats
    assert 285.0 < np.quantile(kelvin[-12:], 0.02) < 400.0  # unburned, or the warm scar
    assert kelvin.max() < 1600.0
