"""Control line: closed forms for circles and bays, and distances against all pairs."""

import numpy as np
import pytest
from fires import EAST, LATITUDE, LONGITUDE, NORTH
from firetwin.allocation import control_line, divisions
from firetwin.allocation.control_line import LineOptions
from firetwin.run.arrival_grid import ArrivalGrid
from firetwin.run.front import Reach

CELL = 50.0
CENTRE = (LATITUDE, LONGITUDE)


def grid_of(burned):
    """A grid of cells of 50 m around the place that burn at 0 s."""
    ny, nx = burned.shape
    latitude = LATITUDE + (np.arange(ny) - 0.5 * (ny - 1)) * CELL / NORTH
    longitude = LONGITUDE + (np.arange(nx) - 0.5 * (nx - 1)) * CELL / EAST
    return ArrivalGrid(latitude, longitude, np.where(burned, 0.0, np.nan))


def length(burned, options):
    grid = grid_of(burned)
    line = control_line.trace(grid, Reach(grid), 0.0, options)
    return divisions.front_lengths(*line, CENTRE, 1)[0][0], line


def disc(radius, size=61):
    y, x = np.mgrid[:size, :size] - size // 2
    return np.hypot(x, y) * CELL <= radius


def test_distances_are_those_of_all_pairs():
    rng = np.random.default_rng(3)
    mask = rng.random((13, 17)) < 0.06
    y, x = np.nonzero(mask)
    rows, columns = np.mgrid[:13, :17]
    every = np.hypot((rows[..., None] - y) * 30.0, (columns[..., None] - x) * 20.0).min(-1)
    found = control_line.distance(mask, (20.0, 30.0), 90.0)
    near = every <= 90.0
    np.testing.assert_allclose(found[near], every[near])
    assert (found[~near] > 90.0).all()


@pytest.mark.parametrize(("radius", "indirect"), [(300.0, 0.0), (300.0, 100.0), (300.0, 300.0), (0.0, 300.0)])
def test_the_line_of_a_circle_is_a_circle_outside(radius, indirect):
    found, _ = length(disc(800.0), LineOptions(radius, indirect))
    assert found == pytest.approx(2.0 * np.pi * (800.0 + indirect), rel=0.06)


def test_bays_and_gaps_are_closed_and_wide_ones_stay():
    comb = disc(1000.0)
    comb[30:, 26:35:4] = False  # bays of 50 m
    plain, _ = length(disc(1000.0), LineOptions(200.0, 0.0))
    detailed, _ = length(comb, LineOptions(0.0, 0.0))
    closed, _ = length(comb, LineOptions(200.0, 0.0))
    assert detailed > 1.5 * plain
    assert closed == pytest.approx(plain, rel=0.02)
    two = np.zeros((61, 61), bool)
    two[20:40, 10:25] = two[20:40, 29:44] = True  # two squares with a gap of 200 m
    joined, _ = length(two, LineOptions(200.0, 0.0))
    apart, _ = length(two, LineOptions(50.0, 0.0))
    assert joined < apart - 1000.0


def test_a_line_is_split_at_the_divisions():
    grid = grid_of(disc(800.0))
    line = control_line.trace(grid, Reach(grid), 0.0)
    parts = divisions.split_line(line, CENTRE, 4)
    assert [len(each) for each in parts] == [1, 1, 1, 1]
    lengths = [np.hypot(*(np.diff(each[0], axis=0) * (EAST, NORTH)).T).sum() for each in parts]
    own, _ = divisions.front_lengths(*line, CENTRE, 4)
    np.testing.assert_allclose(lengths, own, rtol=1e-3)
    assert (parts[0][0].mean(axis=0) > CENTRE[::-1]).all()  # the north-east is first


def test_fire_at_the_edge_of_the_grid_has_a_closed_line():
    burned = np.zeros((20, 20), bool)
    burned[:5, :5] = True
    found, line = length(burned, LineOptions(100.0, 100.0))
    assert found > 4 * 250.0
    assert sorted(line[2].tolist()) == list(range(len(line[2])))
    assert control_line.trace(grid_of(~burned), Reach(grid_of(~burned)), -1.0)[0].size == 0
