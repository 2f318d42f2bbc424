"""Slots that do not change while a cell is shown."""

import numpy as np
import pytest
from firetwin_core.lod import Pool
from hypothesis import given, settings
from hypothesis import strategies as st

frames = st.lists(st.lists(st.integers(0, 30), max_size=20, unique=True), max_size=12)


def test_by_hand():
    pool = Pool(3)
    assert pool.assign([10, 20]).tolist() == [0, 1]
    assert pool.assign([20, 30, 40]).tolist() == [1, 0, 2]
    assert pool.assign([50, 20, 60, 40]).tolist() == [0, 1, 2, -1]
    assert pool.cells.tolist() == [50, 20, 60]
    assert pool.assign([]).tolist() == []
    assert pool.cells.tolist() == [-1, -1, -1]


@settings(deadline=None)
@given(st.integers(0, 12), frames)
def test_nothing_pops(capacity, steps):
    pool, before = Pool(capacity), {}
    for cells in steps:
        slots = pool.assign(cells)
        now = {c: s for c, s in zip(cells, slots.tolist(), strict=True) if s >= 0}
        assert list(now) == cells[:capacity]
        assert len(set(now.values())) == len(now)
        assert all(now[c] == before[c] for c in now.keys() & before.keys())
        assert all(pool.cells[s] == c for c, s in now.items())
        assert (pool.cells >= 0).sum() == len(now)
        before = now


@settings(deadline=None)
@given(st.integers(0, 12), frames)
def test_the_same_frames_give_the_same_slots(capacity, steps):
    one, other = Pool(capacity, seed=1), Pool(capacity, seed=2)
    for cells in steps:
        np.testing.assert_array_equal(one.assign(cells), other.assign(cells))


def test_seeds_belong_to_cells():
    pool = Pool(2, seed=5)
    cells = np.arange(10_000).reshape(100, 100)
    seeds = pool.seeds(cells)
    assert seeds.shape == (100, 100)
    assert len(np.unique(seeds)) > 9_995
    pool.assign([3])
    np.testing.assert_array_equal(pool.seeds(cells), seeds)
    np.testing.assert_array_equal(Pool(7, seed=5).seeds([3]), seeds[0, 3])
    assert (Pool(2, seed=6).seeds(cells) != seeds).mean() > 0.99


def test_wrong_cells_change_nothing():
    pool = Pool(3)
    pool.assign([1, 2])
    with pytest.raises(ValueError, match="twice"):
        pool.assign([4, 4])
    for cells in ([1.5], [1.0], [1, 2.0]):
        with pytest.raises(ValueError, match="cell must hold integers"):
            pool.assign(cells)
    with pytest.raises(ValueError, match="negative"):
        pool.assign([-1])
    assert pool.cells.tolist() == [1, 2, -1]
