"""The choice of tiles against brute force: every view, every frame, every tile by recursion."""

import numpy as np
import pytest
import tile_views
from firetwin_core import lod, tiles
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

R, U, C, P, B, S, H = (
    *(tiles.REPLACES, tiles.UNCONDITIONAL, tiles.CONTENT, tiles.PENDING),
    *(tiles.BROKEN, tiles.OUTSIDE_REQUEST_VOLUME, tiles.PASS_THROUGH),
)


def select(parent, flags, error, target, bytes=None, triangles=None, **budget):
    zero = np.zeros(len(parent), int)
    return tiles.select(
        parent,
        flags,
        error,
        zero if bytes is None else bytes,
        zero if triangles is None else triangles,
        target,
        **budget,
    )


def brute(parent, flags, error, target):
    """Tiles of the cut by recursion from each root, as the documentation of `select` says."""
    children = [[c for c in range(len(parent)) if parent[c] == i] for i in range(len(parent))]

    def visit(i, forced):
        """(tiles, failed) of requested tiles; None if a tile is omitted."""
        has = lambda flag: bool(flags[i] & flag)  # noqa: E731
        seen = error[i] >= 0
        if has(S) or not (seen or forced):
            return None
        below = []
        if has(U) or (seen and error[i] > target):
            force = forced if has(H) else has(R) or (has(U) and forced)
            below = [found for c in children[i] if (found := visit(c, force)) is not None]
        replaced = bool(below) and has(R) and not has(H)
        failed = any(each[1] for each in below)
        if failed and has(C) and not has(B):
            if has(R) and not has(H):
                return {i}, False
            failed = False
        shown = set().union(*(each[0] for each in below))
        if has(C) and not replaced:
            if has(B):
                failed = True
            else:
                shown = shown | {i}
        return shown, failed

    found = [visit(i, False) for i in range(len(parent)) if parent[i] < 0]
    return sorted(set().union(*(each[0] for each in found if each is not None)))


@st.composite
def trees(draw):
    n = draw(st.integers(1, 24))
    parent = [-1] + [draw(st.integers(0, i)) for i in range(n - 1)]
    flags = [
        sum(draw(st.lists(st.sampled_from([R, C, C, U, B, S, H, R]), max_size=4, unique=True)))
        for _ in range(n)
    ]
    error = [draw(st.one_of(st.just(-1.0), st.integers(0, 60).map(float))) for _ in range(n)]
    return np.array(parent), np.array(flags), np.array(error)


@settings(deadline=None, max_examples=examples(100))
@given(trees(), st.integers(0, 50).map(float))
def test_a_cut_is_what_recursion_finds(tree, target):
    assert select(*tree, target).tiles.tolist() == brute(*tree, target)


@settings(deadline=None, max_examples=examples(150))
@given(trees(), st.integers(0, 20).map(float), st.integers(0, 12))
def test_a_budget_raises_the_error_no_more_than_it_must(tree, target, most):
    parent, flags, error = tree
    cut = select(parent, flags, error, target, max_tiles=most)
    assert cut.error >= target
    assert cut.tiles.tolist() == brute(parent, flags, error, cut.error)
    assert cut.fits == (len(cut.tiles) <= most)
    steps = sorted({target, *(float(each) for each in error if each > target)})
    counts = [len(brute(parent, flags, error, step)) for step in steps]
    if counts == sorted(counts, reverse=True):  # content everywhere; otherwise bisection may stop later
        least = next((step for step, count in zip(steps, counts, strict=True) if count <= most), None)
        assert cut.error == (steps[-1] if least is None else least)


def test_a_holder_stands_for_its_child_even_where_no_view_sees_it():
    parent, error = [-1, 0, 0, 2], [50.0, 5.0, -1.0, -1.0]
    assert select(parent, [R | C, R | C, R | U | H, R | C], error, 16.0).tiles.tolist() == [1, 3]
    pending = select(parent[:3], [R | C, R | C, R | U | H | P], error[:3], 16.0)
    assert pending.expand.tolist() == [2]
    assert select(parent[:1], [R | C | P], [10.0], 16.0).expand.tolist() == []
    coarse = select(parent[:1], [R | C | P], [20.0], 16.0)
    assert (coarse.expand.tolist(), coarse.tiles.tolist()) == ([0], [0])


def test_the_nearest_ancestor_with_content_stands_in():
    parent, error = [-1, 0, 1, 1, 0], [50.0, 40.0, 5.0, 5.0, 5.0]
    flags = [R | C, R | C, R | C | B, R | C, R | C]
    cut = select(parent, flags, error, 16.0)
    assert (cut.tiles.tolist(), cut.stand_ins.tolist(), cut.missing.tolist()) == ([1, 4], [1], [])
    flags[1] = R
    assert select(parent, flags, error, 16.0).tiles.tolist() == [0]
    flags[0] = R
    alone = select(parent, flags, error, 16.0)
    assert (alone.tiles.tolist(), alone.missing.tolist()) == ([3, 4], [2])
    added = select([-1, 0, 0], [C, C | B, C], [50.0, 1.0, 1.0], 16.0)
    assert (added.tiles.tolist(), added.stand_ins.tolist(), added.missing.tolist()) == ([0, 2], [0], [1])


def test_budgets_of_bytes_and_triangles():
    parent, error = [-1, 0, 0], [50.0, 5.0, 5.0]
    for name in ("bytes", "triangles"):
        cut = select(parent, [R | C] * 3, error, 16.0, **{name: [5, 4, 4]}, **{f"max_{name}": 6})
        assert (cut.tiles.tolist(), cut.error, cut.fits, getattr(cut, name)) == ([0], 50.0, True, 5)
        cut = select(parent, [R | C] * 3, error, 16.0, **{name: [9, 4, 4]}, **{f"max_{name}": 6})
        assert not cut.fits


@pytest.mark.parametrize(
    ("parent", "error", "target", "message"),
    [
        ([0], [1.0], 1.0, "earlier tile"),
        ([-2], [1.0], 1.0, "earlier tile"),
        ([-1, 5], [1.0, 1.0], 1.0, "earlier tile"),
        ([-1], [np.nan], 1.0, "NaN"),
        ([-1], [1.0], -1.0, "0 or more"),
        ([-1], [1.0], np.nan, "0 or more"),
        ([-1], [1.0, 2.0], 1.0, "shape"),
    ],
)
def test_impossible_trees(parent, error, target, message):
    with pytest.raises(ValueError, match=message):
        select(parent, [C] * len(parent), error, target)


def random_volumes(rng, n):
    axis = np.linalg.qr(rng.normal(size=(n, 3, 3)))[0]
    return rng.normal(0, 60, (n, 3)), axis, rng.uniform(0, 12, (n, 3)), rng.choice([0.0, 0.0, 5.0], n)


@settings(deadline=None, max_examples=examples(40))
@given(st.integers(0, 2**32 - 1), st.integers(1, 30))
def test_errors_are_those_of_every_view(seed, count):
    rng = np.random.default_rng(seed)
    views = tile_views.random_views(rng, count)
    volumes = random_volumes(rng, 60)
    error = rng.uniform(0, 10, 60)
    found = tiles.screen_error(*volumes, error, tile_views.view_set(views), views[-1])
    least, most = tile_views.errors(volumes, error, views)
    assert (found >= least - 1e-12 * np.abs(least)).all()
    assert (found <= most + 1e-12 * np.abs(most)).all()
    assert (least == most).mean() > 0.7


def test_an_eye_inside_refines_whatever_the_error():
    made = lod.ViewSet([[0, 0, 0]], np.eye(3), [0.5, 0.5])
    volume = ([[0, 0, 0]], [np.eye(3)], [[1, 1, 1]], [0])
    assert tiles.screen_error(*volume, [1e-3], made, [1000.0])[0] == 1e-3 * 1000.0 / 1e-7
    assert tiles.screen_error(*volume, [0.0], made, [1000.0])[0] == 0.0
    assert tiles.contains_any(*volume, [[5, 0, 0], [1, 1, 1]]).tolist() == [True]
    assert tiles.contains_any(*volume, [[5, 0, 0]]).tolist() == [False]
    assert tiles.contains_any(*volume, np.empty((0, 3))).tolist() == [False]


def test_no_view_sees_nothing():
    made = lod.ViewSet(np.empty((0, 3)), np.eye(3), [0.5, 0.5])
    volume = ([[0, 0, 0]], [np.eye(3)], [[1, 1, 1]], [0])
    assert tiles.screen_error(*volume, [1.0], made, np.empty(0)).tolist() == [-1.0]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"error": [-1.0]}, "error must be 0 or more"),
        ({"error": [np.nan]}, "error must be 0 or more"),
        ({"pixels": [-1.0]}, "pixels must be 0 or more"),
        ({"pixels": [1.0, 1.0]}, "one number for each view"),
        ({"half": [[-1, 0, 0]]}, "half must be 0 or more"),
        ({"padding": [-1.0]}, "padding must be 0 or more"),
        ({"margin": -1.0}, "margin"),
        ({"centre": [[0, 0]]}, "shape"),
    ],
)
def test_impossible_volumes(change, message):
    views = lod.ViewSet([[0, 0, 0]], np.eye(3), [0.5, 0.5])
    arguments = {
        "centre": [[0, 0, 0]],
        "axis": [np.eye(3)],
        "half": [[1, 1, 1]],
        "padding": [0],
        "error": [1.0],
        "views": views,
        "pixels": [1.0],
    }
    with pytest.raises(ValueError, match=message):
        tiles.screen_error(**(arguments | change))
