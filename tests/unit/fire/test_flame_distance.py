"""Distance of flames along rays."""

import numpy as np
import pytest
from firetwin.render import flame_distance
from firetwin.render.rays import Rays
from firetwin_core import volume
from flame_field import flames
from march_light import NO_LIGHT

LIGHT = volume.Illumination(**NO_LIGHT)


def line(away, depth=8.0, length=6.0):
    """Flames on level ground at y from `away` to `away` + `depth`, m."""
    y = np.arange(-10.0, 90.0, 0.5)
    lengths = np.where((y >= away) & (y <= away + depth), length, 0.0)[:, None] * np.ones(len(y))
    square = lengths.astype(np.float32), np.zeros(lengths.shape, np.float32), (-50.0, -10.0), 0.5
    return flames([square])


@pytest.mark.parametrize("away", [15.0, 60.0])
def test_half_of_the_light_is_emitted_within_the_depth_of_a_front(away):
    ahead = np.zeros((1, 30, 3))
    ahead[..., 0], ahead[..., 1] = np.linspace(-0.2, 0.2, 30), 1.0
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    rays = Rays(np.array([0.0, 0.0, 0.8]), ahead, np.zeros((1, 30)), None)
    found = flame_distance.measure(line(away), rays, LIGHT, 200.0, 1.0) * ahead[..., 1]
    assert np.all((found > 0.9 * away - 1.0) & (found < 1.1 * away + 8.0))
    assert flame_distance.measure(line(away), rays, LIGHT, 200.0, 1.0e6).max() == 0.0


def test_a_cell_is_repeated_for_the_pixels_of_an_odd_picture():
    cells = np.arange(4, dtype=np.float32).reshape(2, 2)
    assert flame_distance.of_pixels(cells, 3, 3).tolist() == [[0, 0, 1], [0, 0, 1], [2, 2, 3]]
