"""Air near the ground: smoke of a forecast as haze; exact at the ground and in its optical depth."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.shot import run_checks
from firetwin.shot.light import exposure_meter, sky, smoke_haze
from firetwin.shot.sections.light import Light


def test_without_smoke_the_air_is_that_of_a_dry_day():
    assert smoke_haze.near_ground(Light(), 1500.0) == (sky.HAZE * sky.LOW_HAZE, sky.LOW_HEIGHT)
    assert smoke_haze.smoke_depth(Light()) == 0.0


def test_a_tenth_of_a_milligram_is_seen_through_for_ten_kilometres():
    """Koschmieder: the visual range is 3.912 over the extinction; 4 m2/g times 100 ug/m3."""
    assert 3.912 / smoke_haze.extinction(100.0) == pytest.approx(9780.0)


@pytest.mark.parametrize("ground", [0.0, 1800.0])
def test_one_layer_has_the_extinction_at_the_ground_and_the_depth_of_both(ground):
    smoky = Light(smoke=85.0, smoke_height=2200.0)
    dry = smoke_haze.dry_day(smoky)[0] * np.exp(-ground / sky.LOW_HEIGHT)
    extinction, height = smoke_haze.near_ground(smoky, ground)
    at_ground = extinction * np.exp(-ground / height)
    assert at_ground == pytest.approx(dry + 85e-9 * 4000.0)
    assert at_ground * height == pytest.approx(dry * sky.LOW_HEIGHT + smoke_haze.smoke_depth(smoky))
    assert smoke_haze.smoke_depth(smoky) == pytest.approx(85e-9 * 4000.0 * 2200.0)


def test_the_meter_integrates_the_layer():
    layer, far = (3e-4, 1500.0), 20_000.0
    for height, up in ((500.0, 0.0), (100.0, 0.1), (3000.0, -0.1)):
        along = (np.arange(10_000) + 0.5) * far / 10_000
        exact = np.mean(layer[0] * np.exp(-(height + up * along) / layer[1])) * far
        found = exposure_meter._haze_depth(*(np.array([each]) for each in (height, up, far)), layer)
        assert found[0] == pytest.approx(exact, rel=1e-3)


def test_a_globe_camera_shows_no_smoke(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("[light]\nsmoke = 5.0\n")
    camera = SimpleNamespace(rig=SimpleNamespace(beyond=True))
    settings = SimpleNamespace(path=path, light=Light(smoke=5.0), cameras=[camera])
    with pytest.raises(InputError, match=r"scene.toml:2:1: light.smoke is not drawn in scenes with a globe"):
        run_checks._smoke(settings)
