"""Polygons and lines as pixels."""

import numpy as np
import pytest
from firetwin.shot.terrain import rasterize

SHAPE = (60, 80)


def picture(found):
    """The complete picture of covered pixels."""
    whole = np.zeros(SHAPE)
    window, cover = found
    whole[window] = cover
    return whole


def ring(radius, corners=90, middle=(40.0, 30.0)):
    turn = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return np.column_stack([middle[0] + radius * np.cos(turn), middle[1] + radius * np.sin(turn)])


def test_a_polygon_covers_its_area_and_not_its_holes():
    whole = picture(rasterize.filled([ring(20.0), ring(8.0)], SHAPE))
    assert whole.sum() == pytest.approx(np.pi * (20.0**2 - 8.0**2), rel=0.02)
    assert whole[30, 40] == 0.0
    assert whole[30, 55] == 1.0


def test_what_lies_beyond_the_picture_is_cut_off():
    whole = picture(rasterize.filled([ring(20.0, middle=(0.0, 30.0))], SHAPE))
    assert whole.sum() == pytest.approx(0.5 * np.pi * 400.0, rel=0.03)
    assert rasterize.filled([ring(5.0, middle=(-40.0, 30.0))], SHAPE) is None
    assert rasterize.stroked(np.array([[-50.0, -50.0], [-40.0, -50.0]]), 3.0, SHAPE) is None


@pytest.mark.parametrize("width", [0.4, 1.0, 3.0, 7.0])
def test_a_line_covers_as_much_as_it_is_wide(width):
    """Also for less than a pixel."""
    line = np.array([[10.0, 10.3], [40.0, 31.0], [70.0, 40.2]])
    length = np.hypot(*np.diff(line, axis=0).T).sum()
    whole = picture(rasterize.stroked(line, width, SHAPE))
    assert whole.sum() == pytest.approx(width * length, rel=0.15 if width > 1.0 else 0.35)
    assert whole.max() <= 1.0
