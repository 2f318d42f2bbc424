"""Height difference between tiles and terrain: percentiles and messages."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.run.frame import local_frame
from firetwin.run.opening import open as open_run
from firetwin.shot.settings import Settings
from firetwin.shot.terrain.tile_heights import Surface, TileHeights
from firetwin.shot.tiles import tile_difference


def tiles_at(run, low, height):
    height = height.astype(np.float32)
    surface = Surface(np.asarray(low, float), 20.0, height, height, np.zeros(height.shape, np.uint8))
    return TileHeights(local_frame(run), surface)


def test_percentiles_are_those_of_the_fuel_grid(make_run):
    run = open_run(folder := make_run())
    frame, own = local_frame(run), run.fuel_elevation
    place = frame.forward_grid(run.fuel_latitude, run.fuel_longitude, own)
    low = place[..., :2].reshape(-1, 2).min(axis=0) - 100.0
    settings = replace(Settings(), run=folder)
    count = 150
    height = np.full((count, count), np.nan)
    assert tile_difference.measure(tiles_at(run, low, height), settings, run) is None
    height[:] = float(own.mean())
    found = tile_difference.measure(tiles_at(run, low, height), settings, run)
    expected = np.percentile(own.mean() - own, (5, 50, 95))
    np.testing.assert_allclose(found, expected, atol=1.0)  # the Earth's curvature below a level surface


@pytest.mark.parametrize(
    ("median", "undulation", "end"),
    [
        (0.04, -24.9, "is 0.0 m above the scene's own (median; -1.0 to 2.0 m in 90 % of places)"),
        (-2.9, -24.9, "is 2.9 m below the scene's own (median; -1.0 to 2.0 m in 90 % of places)"),
        (-3.1, -24.9, "write tiles.geoid = -28.0"),
        (25.0, None, "above the ellipsoid"),
    ],
)
def test_the_remedy_is_the_geoid_s_height(median, undulation, end):
    assert tile_difference.sentence((-1.0, median, 2.0), undulation).endswith(end)


def test_tiles_of_another_place_are_told():
    assert "do not overlap" in tile_difference.sentence(None, 0.0)
