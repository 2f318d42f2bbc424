"""Cells that plants may count in: all that hold such a plant, found in blocks as they are one by one."""

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.scene.forest import visibility, visible_cells
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.sections import TerrainSettings
from firetwin.shot.settings import Camera, Settings
from firetwin.shot.shot import Shot
from firetwin_core.terrain import bilinear

TALL, REACH = 40.0, 9_000.0
ROWS, COLUMNS = 61, 83


@pytest.fixture
def film(make_run):
    """Cells of a camera over rugged land that looks to the north."""
    run = runs.open(make_run())
    place = float(np.mean(run.fuel_latitude)), float(np.mean(run.fuel_longitude))
    key = CameraKey(0.0, *place, 1500.0, "point", place[0] + 0.02, place[1], 0.0)
    cameras = (Camera("a", Drone(keys=(key,))),)
    return Shot(Settings(terrain=TerrainSettings(near_radius=0.0, apron=0.0), cameras=cameras), run)


def grid(film, seed=0, rise=400.0):
    """Rugged land of cells of about 110 m round the run: latitude, longitude and elevation."""
    run = film.run
    latitude = np.mean(run.fuel_latitude) + 0.001 * (np.arange(ROWS) - ROWS // 2)
    longitude = np.mean(run.fuel_longitude) + 0.0013 * (np.arange(COLUMNS) - COLUMNS // 2)
    height = np.random.default_rng(seed).uniform(0.0, rise, (ROWS, COLUMNS))
    return latitude, longitude, (float(np.mean(run.fuel_elevation)) + height).astype(np.float32)


@pytest.mark.parametrize(("seed", "rise"), [(0, 400.0), (1, 400.0), (2, 20.0), (3, 20.0)])
def test_no_cell_of_a_tree_that_counts_is_left_out(film, seed, rise):
    latitude, longitude, elevation = grid(film, seed, rise)
    row, column = np.random.default_rng(seed + 100).uniform(0.0, [[ROWS - 1.0], [COLUMNS - 1.0]], (2, 40_000))
    place = film.local_frame.forward(
        np.interp(row, np.arange(ROWS), latitude),
        np.interp(column, np.arange(COLUMNS), longitude),
        bilinear(elevation.astype(np.float64), row, column),
    )
    counts = visibility.visible(film, place, 1.0, REACH)
    found = visible_cells.visible_cells(film, 1.0, REACH, latitude, longitude, elevation)
    assert 0.1 * found.size < found.sum() < 0.9 * found.size
    assert np.all(found[np.round(row).astype(int), np.round(column).astype(int)][counts])


def test_only_cells_among_the_given_are_found(film):
    among = np.random.default_rng(2).uniform(size=(ROWS, COLUMNS)) < 0.3
    whole = visible_cells.visible_cells(film, TALL, REACH, *grid(film))
    assert np.array_equal(visible_cells.visible_cells(film, TALL, REACH, *grid(film), among), whole & among)


def test_cells_without_ground_hold_nothing_and_hide_no_others(film):
    latitude, longitude, elevation = grid(film)
    holes = elevation.copy()
    holes[:, ::3] = np.nan
    whole, found = (
        visible_cells.visible_cells(film, TALL, REACH, latitude, longitude, each)
        for each in (elevation, holes)
    )
    assert not found[:, ::3].any()
    assert found.sum() > 0.5 * whole[:, 1::3].sum()
