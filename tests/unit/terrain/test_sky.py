"""Light of the sky and of haze by the height of the sun."""

import numpy as np
import pytest
from firetwin.shot.light import sky


@pytest.mark.parametrize("height", [3.0, 10.0, 34.0, 60.0])
def test_thick_haze_by_day_is_brighter_and_warmer_than_thin_haze(height):
    light = sky.State(180.0, height)
    near, far = np.array(light.haze), np.array(light.horizon)
    assert far.mean() > 1.3 * near.mean()
    assert far[2] / far[0] < near[2] / near[0]


def test_thick_haze_at_night_is_as_dark_as_thin_haze():
    light = sky.State(180.0, -30.0)
    assert light.horizon == pytest.approx(light.haze, rel=0.3)
