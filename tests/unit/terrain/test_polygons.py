"""Areas of rings and points inside, against GEOS."""

import numpy as np
import pytest
from firetwin.geometry.polygons import area, inside

shapely = pytest.importorskip("shapely", reason="needs shapely")

SQUARE = np.array([(0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)])
HOLE = np.array([(5.0, 3.0), (5.0, 7.0), (9.0, 7.0), (9.0, 3.0)])
STAR = np.array([(12, 0), (16, 9), (27, 10), (19, 17), (22, 29), (12, 20), (1, 28)], float)


@pytest.mark.parametrize("polygon", [(SQUARE, HOLE), (STAR,), (STAR[::-1],), (np.vstack([STAR, STAR[:1]]),)])
def test_areas_and_insides_are_those_of_geos(polygon):
    points = np.random.default_rng(2).uniform(-2.0, 32.0, (5000, 2))
    wanted = shapely.Polygon(polygon[0], polygon[1:])
    assert np.array_equal(inside(polygon, points), shapely.contains_xy(wanted, *points.T))
    assert sum(area(ring) for ring in polygon) == pytest.approx(
        wanted.area if shapely.is_ccw(wanted.exterior) else -wanted.area
    )
