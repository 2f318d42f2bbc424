"""Light of flames in smoke: it is smooth between the cells in which it is computed."""

import numpy as np
import pytest
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.smoke import flame_light

LIGHTS = np.array([[1010.0, 990.0, 40.0]]), np.array([2e9])


def glow(every, monkeypatch):
    monkeypatch.setattr(flame_light, "_EVERY", every)
    heights = np.broadcast_to((np.arange(12) + 0.5)[:, None, None] * 60.0, (12, 31, 31))
    return flame_light.glow(LIGHTS, heights, 67.0, (0.0, 0.0), Scale())


def test_it_has_no_kinks_between_the_cells_in_which_it_is_computed(monkeypatch):
    exact, found = glow(1, monkeypatch), glow(3, monkeypatch)
    assert found == pytest.approx(exact, abs=0.2 * float(exact.max()))  # straight lines: 0.29
    for axis in range(3):
        bend = [np.abs(np.diff(each, 2, axis=axis)).max() for each in (found, exact)]
        assert bend[0] < 1.1 * bend[1]
