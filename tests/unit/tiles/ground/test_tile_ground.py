"""Terrain on and next to tiles: heights of the tiles, and a border without a step."""

from dataclasses import replace

import numpy as np
import pytest
from firetwin.run.frame import local_frame
from firetwin.run.opening import open as open_run
from firetwin.shot.sections import TerrainSettings
from firetwin.shot.settings import Settings
from firetwin.shot.terrain.elevation import Elevation, _Stacked
from firetwin.shot.terrain.terrain import Terrain
from firetwin.shot.terrain.tile_heights import Surface, TileHeights

STEP, SIDE, OFF = 4.0, 120, 6.0  # m, points, m


class Model:
    """An elevation model with relief that the run does not know."""

    unit, resolution = "m", 8.0

    def overlaps(self, latitude, longitude):
        return True

    def on_grid(self, latitude, longitude):
        wave = np.sin(latitude[:, None] * 4000.0) * np.cos(longitude * 3000.0)
        return (1200.0 + 8.0 * wave).astype(np.float32)[None]


def on_tiles(run, model, middle):
    """The run's ground with tiles on its middle, `OFF` above it and with additional detail."""
    beside = Terrain(SETTINGS, run, np.full((8, 10), np.nan), Elevation(run, model)).seen_from(
        [[*middle, 100.0]]
    )
    axis = STEP * (np.arange(SIDE) - SIDE / 2)
    low = middle + axis[0]
    east, north = np.meshgrid(middle[0] + axis, middle[1] + axis)
    height = beside.up(east.ravel(), north.ravel()).reshape(east.shape) + OFF + 0.5 * np.sin(east / 9.0)
    surface = Surface(
        low, STEP, height.astype(np.float32), height.astype(np.float32), np.zeros(east.shape, np.uint8)
    )
    tiles = TileHeights(local_frame(run), surface)
    relief = Elevation(run, _Stacked(tiles, model))
    ground = Terrain(SETTINGS, run, np.full((8, 10), np.nan), relief).seen_from([[*middle, 100.0]])
    return ground, beside, tiles


SETTINGS = replace(Settings(), terrain=TerrainSettings(near_radius=3000.0, apron=0.0))


@pytest.mark.parametrize("model", [None, Model()])
def test_no_step_at_the_border(make_run, model):
    run = open_run(make_run())
    place = local_frame(run).forward(run.fuel_latitude[[3]], run.fuel_longitude[[4]], [1200.0])[0, :2]
    ground, beside, tiles = on_tiles(run, model, place)
    half = STEP * SIDE / 2
    along = np.linspace(-0.95 * half, 0.9 * half, 300)
    inside, outside = -half + 1.0, -half - 4.0
    for swap in (False, True):
        ways = [
            np.column_stack([np.full(300, at), along])[:, :: -1 if swap else 1] for at in (inside, outside)
        ]
        near, far = (way + place for way in ways)
        slope = beside.up(*near.T) - beside.up(*far.T)
        assert np.abs(tiles.up(*near.T) - beside.up(*far.T) - slope).min() > OFF - 1.0
        assert np.abs(tiles.up(*near.T) - ground.up(*far.T) - slope).max() < 1.6  # found: 1.4; 0.5 is detail
    inner = np.column_stack([along, along])[30:-30] * 0.8 + place
    np.testing.assert_allclose(ground.up(*inner.T), tiles.up(*inner.T), atol=0.3)
