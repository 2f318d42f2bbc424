"""Air of a sample: its haze has the drawn visibility, and fog and dust dim the sun."""

import dataclasses

import numpy as np
import pytest
import small_plan
from firetwin.dataset import air
from firetwin.dataset.draws import Drawer
from firetwin.shot.light import sky


@pytest.fixture(scope="module")
def draw(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    small_plan.write_run(folder / "a")
    return Drawer(small_plan.plan(folder=folder, moments=2)).draw(1)


@pytest.mark.parametrize("visibility", [0.2, 3.0, 30.0, 150.0])
@pytest.mark.parametrize("height", [0.0, 900.0])
def test_contrast_falls_to_2_percent_at_the_visibility(draw, visibility, height):
    camera = dataclasses.replace(draw.camera, position=(0.0, 0.0, height + 40.0))
    here = dataclasses.replace(draw, visibility=visibility, camera=camera, target=(0.0, 0.0, height))
    shares = np.exp(-height / sky.HAZE_HEIGHT) + sky.LOW_HAZE * np.exp(-height / sky.LOW_HEIGHT)
    depth = air.haze_amount(here) * sky.HAZE * shares * 1000.0 * visibility
    assert np.exp(-depth) == pytest.approx(0.02, abs=2e-4)


def test_fog_and_dust_dim_the_sun_and_clear_air_does_not(draw):
    sunlight = {kind: air.look(dataclasses.replace(draw, kind=kind)).sun for kind in ("fire", "fog", "dust")}
    assert sunlight["fire"] == 1.0
    assert sunlight["fog"] < sunlight["dust"] < 1.0


def test_only_clouds_that_the_kind_asks_for_dim_the_sun(draw):
    covered = dataclasses.replace(draw, cloud_cover=0.9)
    assert air.look(dataclasses.replace(covered, kind="cloud")).sun < 0.5
    assert air.look(dataclasses.replace(covered, kind="fire")).sun == 1.0


def test_the_moon_depends_on_the_sample_alone(draw):
    assert air.moon(draw) == air.moon(draw)
    assert air.moon(draw) != air.moon(dataclasses.replace(draw, index=draw.index + 1))
    assert air.moon(draw).height > 0.0
