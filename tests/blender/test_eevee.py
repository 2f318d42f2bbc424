"""The other engine, in a process of its own and without a display."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from firetwin.render import engine
from firetwin_core import sensor

SCENE = """\
run = "{run}"
[time]
frames = 2
[ground]
near_radius = 0.0
apron = 20000.0
[forest]
trees = false
grass = false
[smoke]
enabled = false
[render]
engine = "eevee"
resolution = [64, 36]
samples = 1
passes = ["rgb", "thermal"]
[[cameras]]
name = "drone"
keys = [{{latitude = 38.825, longitude = -120.56, height = 400, target = "fire"}}]
"""


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


@pytest.mark.parametrize(
    ("resolution", "tile"),
    [((640, 360), "2"), ((1920, 1080), "4"), ((3840, 2160), "8"), ((16384, 16384), "16")],
)
def test_larger_pictures_have_larger_boxes_of_smoke(settings, scene, resolution, tile):
    wanted = replace(settings.render, engine="eevee", resolution=resolution)
    engine.apply(replace(settings, render=wanted), scene)
    assert scene.eevee.volumetric_tile_size == tile
