"""Smoke next to a front: clear upwind, denser downwind, and the same mass."""

import numpy as np
import pytest
from firetwin.smoke import windward
from firetwin_core import flow, volume
from flow_moments import VOXEL, N, moment

STEP, CELL, COUNT = 7.0, 67.0, 160


def front():
    """A line of flames from south to north, in the middle."""
    source = np.zeros((COUNT, COUNT))
    source[COUNT // 2, 30:-30] = 100.0
    return source


def gain(wind=(5.0, 0.0)):
    return windward.redistribution(front(), STEP, CELL, wind)[:, COUNT // 2]


def test_air_upwind_is_clear_and_air_downwind_is_not():
    found, middle = gain(), COUNT // 2
    assert found[middle - int(40.0 / STEP)] < -2.0
    assert found[middle + 2] > 0.2


def test_it_turns_with_the_wind():
    assert gain((-5.0, 0.0)) == pytest.approx(np.roll(gain()[::-1], 1), abs=0.05)


def test_far_from_flames_and_without_any_nothing_changes():
    assert np.abs(gain()[:10]).max() < 0.05
    assert not windward.redistribution(np.zeros((20, 20)), STEP, CELL, (5.0, 0.0)).any()


def test_smoke_spread_by_the_cells_keeps_its_mass():
    """Coarse smoke of the same sources, changed by the factor, has the same mass."""
    x = (np.arange(COUNT) - COUNT // 2) * STEP
    trail = np.exp(-np.maximum(x, 0.0) / (0.75 * CELL)) * (x >= 0.0)
    spread = np.exp(-0.5 * (x / CELL) ** 2)
    coarse = np.convolve(trail, spread / spread.sum(), "same")
    assert (coarse * np.exp(gain())).sum() == pytest.approx(coarse.sum(), rel=0.1)


def test_air_is_clear_upwind_of_a_front_and_smoky_downwind():
    flames = np.zeros((COUNT, COUNT))
    flames[70:74] = 100.0
    emission = np.zeros((COUNT, COUNT))
    emission[68:74] = 1.0
    clear = windward.clear_air(windward.Sources(flames, emission), STEP, CELL, (5.0, 0.0))[:, COUNT // 2]
    assert clear[60] > 0.95
    assert clear[80] < 0.2
    assert clear[70:74].max() < 0.1  # smoke of the front itself
    assert clear[-1] < 0.05  # far from the front


def test_old_smoke_comes_from_elsewhere():
    assert windward.local_share(np.array([0.0, 1000.0]), 1.0).tolist() == [1.0, 0.0]


def painted(height=0.0, **options):
    """Smoke in a layer that begins at a height (m)."""
    z = (np.arange(N) + 0.5)[:, None, None] * 80.0 + height
    smoke, levels = np.full((N, N, N), 2e-6), z.ravel()
    heights = np.broadcast_to(z, (N, N, N))
    detail = flow.Detail(**moment(smoke=smoke, levels=levels, heights=heights))
    plane = np.ones((24, 24))
    box = (400.0, 400.0, height + 100.0), VOXEL, 0.0 * plane, plane, 6
    lit = volume.LitSmoke(detail.paint_sparse(*box, **options), (0.0, 0.0, 1.0), 0.2, 0.5)
    return float(lit.grids(plane, 0.0)["density"].sum())


def test_the_factor_thins_smoke_near_the_ground_alone():
    low, high = (painted(height, log_gain=np.full((24, 24), -4.0)) for height in (0.0, 2500.0))
    assert low < 0.5 * painted()
    assert high == pytest.approx(painted(2500.0), rel=1e-5)


def test_the_factor_leans():
    gain = np.zeros((24, 24))
    gain[:12] = -4.0
    upright, leaning = (
        painted(log_gain=gain, gain_height=5000.0, lean=lean) for lean in ((0.0, 0.0), (1.0, 0.0))
    )
    assert leaning < 0.97 * upright


def test_the_edge_of_clear_air_is_straight_at_the_ground_and_wavy_above():
    z = (np.arange(N) + 0.5)[:, None, None] * 80.0
    even = {"smoke": 2e-6, "age": 30.0, "rise": 4.0}
    fields = {name: np.full((N, N, N), value) for name, value in even.items()}
    detail = flow.Detail(**moment(levels=z.ravel(), heights=np.broadcast_to(z, (N, N, N)), **fields))
    plane, gain = np.ones((24, 24)), np.zeros((24, 24))
    gain[:12] = -4.0
    box = (400.0, 400.0, 0.0), VOXEL, 0.0 * plane, plane, 16
    density = [
        volume.LitSmoke(detail.paint_sparse(*box, **options), (0.0, 0.0, 1.0), 0.2, 0.5).grids(plane, 0.0)[
            "density"
        ]
        for options in ({"log_gain": gain, "gain_height": 2000.0}, {})
    ]
    spread = (density[0] / density[1])[11:13].std(axis=1).mean(axis=0)  # along the edge, by height
    assert spread[0] < 0.03
    assert spread[10:].mean() > 0.1
