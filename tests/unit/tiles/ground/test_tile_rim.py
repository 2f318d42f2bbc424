"""Ground that meets the border of tiles."""

import numpy as np
from firetwin.shot.terrain import rim

Y, X = np.meshgrid(np.arange(80.0), np.arange(90.0), indexing="ij")
GROUND = 5.0 * np.sin(X / 9) * np.cos(Y / 7) + 0.8 * X
INSIDE = (X > 30) & (X < 60) & (Y > 25) & (Y < 55)
TILES = np.where(INSIDE, GROUND + 7.0 + 0.05 * X, np.nan)


def largest_step(heights):
    """Largest difference between the offsets of neighbours across the border of the tiles."""
    off = heights - GROUND
    return max(np.abs(np.diff(off, axis=axis))[np.diff(INSIDE, axis=axis)].max() for axis in (0, 1))


def test_the_step_at_the_border_is_gone():
    plain = np.where(INSIDE, TILES, GROUND)
    met = rim.meet(TILES, GROUND, 20)
    assert largest_step(plain) > 8.0
    assert largest_step(met) < 0.2
    assert np.array_equal(met[INSIDE], TILES[INSIDE].astype(np.float32))
    far = (X < 8) | (X > 82) | (Y < 4) | (Y > 76)
    np.testing.assert_allclose(met[far], GROUND[far], atol=1e-4)
    off = met - GROUND
    assert max(np.abs(np.diff(off, axis=axis)).max() for axis in (0, 1)) < 1.2  # 8.5 m over 20 points


def test_values_go_on_beyond_where_they_are_known():
    found = rim.continued(np.where(INSIDE, 3.0, np.nan), 4)
    expected = (X > 26) & (X < 64) & (Y > 21) & (Y < 59)
    assert np.array_equal(np.isfinite(found), expected)
    assert (found[expected] == 3.0).all()


def test_unknown_ground_stays_unknown():
    hole = np.where((X < 10) | (X == 45), np.nan, GROUND)
    met = rim.meet(TILES, hole, 10)
    assert np.isnan(met[X < 10]).all()
    assert np.isfinite(met[(X >= 10) & ((X != 45) | INSIDE)]).all()
