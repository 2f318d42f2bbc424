"""Blocks of footprints in pictures: their class and numbers, their warmth, and the light on them."""

import json

import numpy as np
import pytest
import rendered
from firetwin.passes import masks
from firetwin.render.picture import Picture
from firetwin_core import sensor

SCENE = """\
run = "{run}"
[time]
start = 2014-09-17T21:30:00Z
frames = 1
[terrain]
near_radius = 0.0
apron = 20000.0
buildings = "footprints.geojson"
[forest]
trees = false
grass = false
understorey = 0
[smoke]
enabled = false
[render]
resolution = [64, 36]
samples = 4
denoise = false
passes = ["rgb", "masks", "thermal", "depth"]
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.825
longitude = -120.56
height = 150.0
target = "point"
target_latitude = 38.8275
target_longitude = -120.56
"""


def square(north, east, side):
    """A ring (5, 2), degrees, whose south-western corner is so many metres from the camera."""
    corners = np.array([(0, 0), (side, 0), (side, side), (0, side), (0, 0)], float)
    corners += (east, north)
    return (np.array([-120.56, 38.825]) + corners / (86_700.0, 111_000.0)).tolist()


@pytest.fixture(scope="module")
def frame(run_folder, tmp_path_factory):
    """Two blocks, west and east: image of a pass by name."""
    folder = tmp_path_factory.mktemp("frame")
    features = [
        {
            "type": "Feature",
            "properties": {"height": 30},
            "geometry": {"type": "Polygon", "coordinates": [square(240.0, east, 60.0)]},
        }
        for east in (-110.0, 50.0)
    ]
    (folder / "footprints.geojson").write_text(
        json.dumps({"type": "FeatureCollection", "features": features})
    )
    _, out = rendered.everything(folder, SCENE.format(run=run_folder))
    return lambda name: np.asarray(sensor.read_image(out / Picture("drone", 1, name).file("exr")))


def test_each_block_has_the_class_and_its_own_number(frame):
    kind, clear, instance, *_ = np.moveaxis(frame("masks"), -1, 0)
    built = kind == masks.BUILDING
    assert built.sum() > 40
    assert set(instance[built]) == {1.0, 2.0}
    assert set(instance[~built]) == {0.0}
    columns = np.broadcast_to(np.arange(64), kind.shape)
    assert columns[instance == 1].max() < columns[instance == 2].min()
    assert np.all(clear[built] == 1.0)
    assert masks.NAMES[masks.BUILDING] == "building"


def test_blocks_stand_before_the_ground_and_are_as_warm_as_stone(frame):
    kind, depth = frame("masks")[..., 0], frame("depth")
    built = kind == masks.BUILDING
    away = depth[..., 1][built]
    assert away.min() > 200.0
    assert away.max() < 500.0
    kelvin = frame("thermal")[..., 0][built]
    assert 280.0 < np.median(kelvin) < 340.0


def test_light_falls_on_roofs_and_walls_of_different_strength(frame):
    built = frame("masks")[..., 0] == masks.BUILDING
    light = frame("rgb")[..., :3].mean(axis=-1)[built]
    assert light.min() > 0.0
    assert np.percentile(light, 90) > 1.3 * np.percentile(light, 10)
