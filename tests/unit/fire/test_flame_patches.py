"""Patches of the ground on which flames are drawn."""

import numpy as np
import pytest
from firetwin.shot.fire import flame_map, flame_nodes, flame_state, flame_view, flame_window
from firetwin.shot.fire.flame_nodes import DISTANCE, EAST, LENGTH, LOW, NORTH, SHARE, SIDE
from straight_front import PACE, N, shot_of

PIXEL, TIME = 0.002, 300.0
FRONT = -230.0 + PACE * (TIME - 1.0)  # m east of the middle; cell centres begin 230 m west of it
DEEP = 0.35  # depth of the burning fuel of the front, flame lengths


@pytest.fixture(params=[(0.3, 0.0), (2.0, 1.0)], ids=["grass", "crowns"])
def shot(request, make_run):
    return shot_of(make_run, 20.0, *request.param)


@pytest.fixture
def forest(make_run):
    return shot_of(make_run, 20.0, 2.0, canopy=1.0)


def seen(shot, time=TIME, eye=(0.0, 0.0, 3.0), limit=80.0, lens=None):
    return flame_map.patches(shot, np.array(eye), time, limit, PIXEL, lens)


def grid(shot, spacing, time=TIME, half=128.0):
    """Values of nodes (n, n, 8), `spacing` metres apart, in a square of twice `half` around the middle, m."""
    window = flame_window.find(shot, time)
    count = 2 * int(np.ceil(half / (SIDE * spacing)))
    axis = (np.arange(count) - count // 2) * SIDE * spacing
    corners = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    nodes = flame_nodes.values(shot, window, corners, spacing, flame_map.carrying_wind(shot))
    inner = nodes[:, :-1, :-1].reshape(count, count, SIDE, SIDE, 8)
    whole = inner.swapaxes(1, 2).reshape(count * SIDE, count * SIDE, 8)
    middle, cells = count * SIDE // 2, int(half / spacing)
    return whole[middle - cells : middle + cells, middle - cells : middle + cells]


def finer(values, parts):
    """Interpolate nodes (n, n) as the march does, at `parts` places along a cell."""
    at = np.arange((len(values) - 1) * parts) / parts
    low, rest = at.astype(int), (at % 1.0)[:, None]
    rows = values[low] * (1.0 - rest) + values[low + 1] * rest
    return (rows[:, low] * (1.0 - rest[:, 0]) + rows[:, low + 1] * rest[:, 0]).astype(np.float64)


def front_area(nodes, spacing):
    """Return the area (m2) in which the fuel of the front burns, and the mean flame length (m) there."""
    parts = max(int(spacing), 1)
    length, away, share = (finer(nodes[..., k], parts) for k in (LENGTH, DISTANCE, SHARE))
    burning = share * ((length > 0.0) & (away >= 0.0) & (away <= DEEP * length))
    return burning.sum() * (spacing / parts) ** 2, (burning * length).sum() / burning.sum()


def test_coarse_cells_hold_the_burning_area_and_the_length_of_fine_ones(forest):
    area, length = front_area(grid(forest, 1.0), 1.0)
    assert area > 1000.0
    for spacing, error in ((2.0, 0.02), (4.0, 0.04), (8.0, 0.06), (16.0, 0.12)):
        coarse = front_area(grid(forest, spacing), spacing)
        assert coarse == pytest.approx((area, length), rel=error), spacing


def test_low_flames_hold_their_mean_height_in_coarse_cells(forest):
    fine, coarse = (grid(forest, spacing)[..., LOW].mean() for spacing in (1.0, 8.0))
    assert fine > 0.05
    assert coarse == pytest.approx(fine, rel=0.1)


@pytest.mark.parametrize("spacing", [1.0, 8.0])
def test_the_front_is_where_the_distance_is_zero(shot, spacing):
    nodes = grid(shot, spacing)
    east = spacing * (np.arange(len(nodes)) - 0.5 * len(nodes))
    away = nodes[..., DISTANCE].mean(axis=0)
    near = np.abs(east - FRONT) < 8.0
    assert away[near] == pytest.approx(FRONT - east[near], abs=1.5)
    ahead = east > FRONT + 8.0
    assert nodes[:, ahead, LOW].max() == 0.0
    assert nodes[:, ahead, DISTANCE].max() < 0.0
    assert nodes[:, ahead, LENGTH].max() > 0.5  # flames lean over it


def test_low_flames_begin_behind_the_front_in_patches(forest):
    nodes = grid(forest, 1.0)
    length, away, low = (nodes[..., k] for k in (LENGTH, DISTANCE, LOW))
    assert low[away < 0.25 * length].max() == 0.0
    behind = (length > 5.0) & (away > 0.5 * length) & (away < 1.5 * length)
    assert 0.3 < (low[behind] > 0.0).mean() < 0.6
    assert (low[behind] < 0.5 * length[behind]).all()


def test_length_does_not_depend_on_age(forest):
    one, other = (grid(forest, 2.0, time) for time in (TIME, TIME + 10.0))
    both = (one[..., LENGTH] > 0.0) & (other[..., LENGTH] > 0.0)
    assert both.sum() > 1000
    assert one[both][:, LENGTH] == pytest.approx(other[both][:, LENGTH])
    behind = both & (one[..., DISTANCE] > -20.0)
    grown = other[behind][:, DISTANCE] - one[behind][:, DISTANCE]
    assert grown.mean() == pytest.approx(10.0 * PACE, rel=0.1)
    assert np.percentile(grown, (2, 98)) == pytest.approx(
        10.0 * PACE, rel=0.3
    )  # less where the edge is oblique


def test_the_front_moves_east(shot):
    nodes = grid(shot, 1.0)
    inner = nodes[(nodes[..., LENGTH] > 0.0) & (np.abs(nodes[..., DISTANCE]) < 8.0)]
    assert inner[:, EAST].mean() > 0.97
    assert abs(inner[:, NORTH].mean()) < 0.05


def test_distances_are_metric_and_along_the_direction(shot):
    """Otherwise solved flames, which are drawn across and along the front, would be sheared to combs."""
    nodes = grid(shot, 0.5, half=96.0)
    north, east = np.gradient(nodes[..., DISTANCE].astype(np.float64), 0.5)
    near = ((nodes[..., LENGTH] > 0.0) & (np.abs(nodes[..., DISTANCE]) < 1.0))[2:-2, 2:-2]
    rise = -(east * nodes[..., EAST] + north * nodes[..., NORTH])[2:-2, 2:-2][near]
    aside = np.abs(east * nodes[..., NORTH] - north * nodes[..., EAST])[2:-2, 2:-2][near]
    assert len(rise) > 100
    assert np.percentile(rise, (5, 95)) == pytest.approx((1.0, 1.0), abs=0.2)
    assert np.percentile(aside, 95) < 0.25


def test_lengths_vary_no_faster_than_flames_are_long(forest):
    fuel = forest.full.bare_ground.fields.canopy_fuel
    even = flame_state.mean_length(forest)
    fuel[fuel.shape[0] // 2, ::2] *= 20.0  # a row of spikes, 20 m apart
    vars(forest.full).pop("flame_length", None)
    spiked = flame_state.mean_length(forest)
    assert even.max() > 4.0
    for axis in (0, 1):
        assert np.abs(np.diff(spiked, axis=axis)).max() / 20.0 < 1.0


def test_patches_of_two_cameras_agree(shot):
    near, other = (
        {(*corner, spacing): nodes for nodes, corner, spacing in zip(*parts, strict=True)}
        for parts in (
            (patches.nodes, patches.corners, patches.spacings)
            for patches in (seen(shot), seen(shot, eye=(-60.0, 31.0, 8.0)))
        )
    )
    both = near.keys() & other.keys()
    assert len(both) > 5
    for key in both:
        assert np.array_equal(near[key], other[key])


def test_neighbours_share_their_nodes(shot):
    patches = seen(shot)
    places = {
        (*corner, spacing): k
        for k, (corner, spacing) in enumerate(zip(patches.corners, patches.spacings, strict=True))
    }
    pairs = 0
    for (x, y, spacing), k in places.items():
        right = places.get((x + SIDE * spacing, y, spacing))
        if right is not None:
            pairs += 1
            assert patches.nodes[k][:, -1] == pytest.approx(patches.nodes[right][:, 0], abs=0.02)
    assert pairs > 3


def test_a_place_has_one_patch_with_flames_in_reach(shot):
    patches = seen(shot, limit=120.0)
    assert np.all(patches.corners % (SIDE * patches.spacings[:, None]) == 0.0)
    width = SIDE * patches.spacings[:, None]
    middle = patches.corners + 0.5 * width
    over = np.abs(middle[:, None] - middle).max(axis=-1) < 0.5 * (width + width.T) - 0.01
    assert over.sum() == len(middle)
    nearest = np.hypot(*np.maximum(np.abs(middle) - 0.5 * width, 0.0).T)
    assert nearest.max() < flame_view.FADE[1] * 120.0
    assert flame_nodes.shows(patches.nodes, 8.0).any(axis=(1, 2)).all()


def test_cells_are_under_two_pixels_beyond_the_finest(shot):
    patches = seen(shot, eye=(800.0, 0.0, 3.0), limit=3000.0)
    width = SIDE * patches.spacings
    away = np.hypot(
        *np.maximum(
            np.abs(patches.corners + 0.5 * width[:, None] - (800.0, 0.0)) - 0.5 * width[:, None], 0.0
        ).T
    )
    assert (patches.spacings <= 2.0 * PIXEL * away + 1e-9).all()
    assert patches.spacings.max() >= 1.0


def test_near_cells_are_as_fine_as_flames_are_low(shot):
    """Noise of fronts with tall flames needs no cells finer than 1 m."""
    patches = seen(shot, eye=(-60.0, 0.0, 3.0), limit=40.0)
    window = flame_window.find(shot, TIME)
    row, column = shot.ground.indices(
        *shot.ground.geodetic(*(patches.corners + SIDE * patches.spacings[:, None] / 2.0).T)
    )
    length = window.typical_length(row, column)
    assert (patches.spacings <= np.maximum(0.25 * length, 0.25)).all()
    assert (patches.spacings > np.minimum(0.125 * length, 0.5)).all()


def test_nothing_is_computed_where_nothing_burns(shot):
    assert not len(seen(shot, time=1.0e5).spacings)
    assert not len(seen(shot, eye=(50_000.0, 0.0, 3.0)).spacings)
    ahead = np.column_stack([(0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)])  # looks east
    eye = (800.0, 0.0, 3.0)
    assert len(seen(shot, eye=eye, limit=3000.0).spacings)
    assert not len(seen(shot, eye=eye, limit=3000.0, lens=flame_view.ViewCone(ahead, (0.5, 0.3))).spacings)


def test_one_frame_is_as_in_a_film(shot):
    alone = seen(shot)
    for time in (TIME - 1.0, TIME + 1.0):
        seen(shot, time)
    again = seen(shot)
    assert np.array_equal(alone.nodes, again.nodes)
    assert np.array_equal(alone.corners, again.corners)


def test_flames_end_beyond_the_final_perimeter(forest):
    """Their length falls to 0 within half of it, and they are not cut by a wall."""
    forest.ground.burned[N // 2 + forest.ground.fields.margin :] = 0.0  # half-way between rows: in the middle
    nodes = grid(forest, 1.0)
    near = np.abs(nodes[..., DISTANCE]) < 3.0
    longest = np.where(near, nodes[..., LENGTH], 0.0).max(axis=1)
    north = np.arange(len(nodes)) - 0.5 * len(nodes)
    assert longest[(north > -60.0) & (north < -10.0)].min() > 4.0
    assert np.diff(longest[north > -6.0]).min() > -0.45 * longest[north > -6.0].max()
    assert longest[north > 16.0].max(initial=0.0) == 0.0
