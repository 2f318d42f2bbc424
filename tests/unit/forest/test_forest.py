"""All trees and grass of a 720 x 720 forest against the plain transcription of Algorithm 2."""

import algorithms
import firetwin_core as core
import geodesy
import numpy as np
import pytest
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

ORIGIN = (38.93, -120.55, 0.0)
FRAME = LocalFrame(*ORIGIN)
SEED = 2014


def fuel_grid(rows, columns, seed=10):
    rng = np.random.default_rng(seed)
    return {
        "canopy": np.where(rng.random((rows, columns)) < 0.7, rng.gamma(2, 0.6, (rows, columns)), 0).astype(
            "f4"
        ),
        "surface": np.where(rng.random((rows, columns)) < 0.8, rng.random((rows, columns)), 0).astype("f4"),
        "latitude": 38.69 + 0.000667 * np.arange(rows),
        "longitude": -120.85 + 0.000855 * np.arange(columns),
        "elevation": rng.uniform(300, 2900, (rows, columns)).astype("f4"),
    }


def trees(grid, **options):
    place = (grid["latitude"], grid["longitude"], grid["elevation"])
    return forest.trees(grid["canopy"], *place, FRAME, **options)


def grass(grid, **options):
    place = (grid["latitude"], grid["longitude"], grid["elevation"])
    return forest.grass(grid["surface"], *place, FRAME, **options)


def column(plants, name, dtype=float):
    return np.array([getattr(p, name) for p in plants], dtype)


def positions(plants):
    place = (column(plants, name) for name in ("latitude", "longitude", "height"))
    return geodesy.enu(*place, ORIGIN)


def test_every_tree_and_clump_equals_the_transcription():
    grid = fuel_grid(240, 230)
    expected_trees, expected_grass = algorithms.algorithm2(**grid, seed=SEED)
    result = trees(grid, seed=SEED)
    assert len(result) == len(expected_trees) > 30_000
    for name in ("cell", "size_class", "model"):
        np.testing.assert_array_equal(getattr(result, name), column(expected_trees, name, int), name)
    for name in ("scale", "rotation"):
        np.testing.assert_array_equal(getattr(result, name), column(expected_trees, name, "f4"), name)
    np.testing.assert_allclose(result.position, positions(expected_trees), rtol=0, atol=1e-6)

    result = grass(grid, seed=SEED)
    assert len(result) == len(expected_grass) > 30_000
    np.testing.assert_array_equal(result.cell, column(expected_grass, "cell", int))
    np.testing.assert_array_equal(result.rotation, column(expected_grass, "rotation", "f4"))
    assert (result.scale == 1).all()
    np.testing.assert_allclose(result.position, positions(expected_grass) - [0, 0, 0.70], rtol=0, atol=1e-6)


@pytest.mark.parametrize("seed", [0, 1, 2**64 - 1, 0x123456789ABCDEF])
def test_random_numbers_against_numpy(seed):
    """numpy.random.Philox counts up before it draws; the transcription and NumPy share no code."""
    for cell, use in ((0, 0), (1, 2), (518_399, 1)):
        before = (cell + (use << 64) - 1) % 2**256
        words = [(before >> shift) & (2**64 - 1) for shift in (0, 64, 128, 192)]
        known = np.random.Philox(
            key=np.array([seed, 0], np.uint64), counter=np.array(words, np.uint64)
        ).random_raw(4)
        plain = algorithms.philox((cell, use, 0, 0), (seed, 0))
        assert plain == tuple(int(v) for v in known)
        fast = algorithms.uniform(seed, np.array([cell]), use)[0]
        assert fast.tolist() == [(v >> 11) * 2.0**-53 for v in plain]


@pytest.mark.parametrize(
    ("word", "answer"),
    [
        (0, "16554d9eca36314c db20fe9d672d0fdc d7e772cee186176b 7e68b68aec7ba23b"),
        (2**64 - 1, "87b092c3013fe90b 438c3c67be8d0224 9cc7d7c69cd777b6 a09caebf594f0ba0"),
    ],
)
def test_published_known_answers(word, answer):
    """philox4x64-10 in the known-answer file (kat_vectors) of the Random123 library."""
    assert " ".join(f"{v:016x}" for v in algorithms.philox((word,) * 4, (word,) * 2)) == answer


def test_the_same_forest_on_any_number_of_threads(all_threads):
    grid = fuel_grid(97, 130)
    results = []
    for threads in (1, 2, 4, 16):
        core.set_threads(threads)
        results.append((trees(grid, seed=5), grass(grid, seed=5)))
    for t, g in results[1:]:
        for name in ("cell", "position", "size_class", "model", "scale", "rotation"):
            np.testing.assert_array_equal(getattr(t, name), getattr(results[0][0], name))
        for name in ("cell", "position", "scale", "rotation"):
            np.testing.assert_array_equal(getattr(g, name), getattr(results[0][1], name))


def one_tree(fuel, **options):
    grid = fuel_grid(2, 2)
    grid["canopy"] = np.array([[fuel, 0], [0, 0]], "f4")
    return trees(grid, **options)


@pytest.mark.parametrize(
    ("fuel", "size"),
    [
        (0.0, None),
        (np.float32(0.01), None),
        (np.nextafter(np.float32(0.01), np.float32(1)), forest.SMALL),
        (np.nextafter(np.float32(0.8), np.float32(0)), forest.SMALL),
        (np.float32(0.8), forest.MEDIUM),
        (np.nextafter(np.float32(1.6), np.float32(0)), forest.MEDIUM),
        (np.float32(1.6), forest.LARGE),
        (1e30, forest.LARGE),
        (np.nan, None),
        (np.inf, None),
        (-1.0, None),
    ],
)
def test_classes_at_their_limits(fuel, size):
    assert one_tree(fuel, max_fuel=3.0).size_class.tolist() == ([] if size is None else [size])


def test_without_jitter_trees_stand_in_the_middle():
    grid = fuel_grid(5, 6)
    grid["canopy"][:] = 1
    centre = FRAME.forward_grid(grid["latitude"], grid["longitude"], grid["elevation"])
    np.testing.assert_allclose(trees(grid, jitter=0).position, centre.reshape(-1, 3), atol=1e-8)


def test_descending_axes_and_one_cell():
    grid = fuel_grid(6, 7)
    grid["latitude"] = grid["latitude"][::-1].copy()
    expected, _ = algorithms.algorithm2(**grid, seed=0)
    np.testing.assert_allclose(trees(grid).position, positions(expected), rtol=0, atol=1e-6)
    one = forest.trees([[2.0]], [38.9], [-120.5], [[1500.0]], FRAME)
    np.testing.assert_allclose(one.position, FRAME.forward([38.9], [-120.5], [1500.0]))


def test_nothing_stands_where_there_is_no_elevation():
    grid = fuel_grid(4, 4)
    grid["canopy"][:] = 1
    grid["elevation"][:] = np.nan
    assert len(trees(grid)) == 0
    assert len(grass(grid)) == 0


def test_no_fuel_at_all():
    grid = fuel_grid(4, 4)
    grid["canopy"][:] = 0
    grid["surface"][:] = -1
    assert len(trees(grid)) == 0
    assert trees(grid).position.shape == (0, 3)
    assert len(grass(grid)) == 0


@pytest.mark.parametrize(
    "options",
    [{"jitter": 1.1}, {"jitter": -0.1}, {"jitter": np.nan}, {"max_fuel": 0.0}, {"max_fuel": np.inf}],
)
def test_impossible_options(options):
    with pytest.raises(ValueError, match=next(iter(options))):
        trees(fuel_grid(3, 3), **options)


def test_wrong_shapes():
    with pytest.raises(ValueError, match=r"latitude must have shape \(1\)"):
        forest.trees([[1.0]], [1.0, 2.0], [1.0], [[1.0]], FRAME)
    with pytest.raises(ValueError, match=r"elevation must have shape \(1, 1\)"):
        forest.grass([[1.0]], [1.0], [1.0], [[1.0, 2.0]], FRAME)


@settings(deadline=None, max_examples=examples(60))
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.003, 0.05, 0.5, 1.0]), st.booleans())
def test_a_mask_leaves_out_cells_and_changes_no_other_plant(seed, share, blocks):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 70, 2))
    grid = fuel_grid(*shape)
    grid["elevation"][rng.random(shape) < 0.1] = np.nan
    mask = rng.random(shape) < share
    if blocks:
        mask[:] = False
        mask[: shape[0] // 2, shape[1] // 3 : shape[1] // 3 + 5] = True
    for grow, names in ((trees, ("size_class", "model")), (grass, ())):
        whole, part = grow(grid, seed=seed), grow(grid, seed=seed, mask=mask)
        kept = mask.ravel()[whole.cell]
        for name in ("cell", "position", "scale", "rotation", *names):
            np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[kept])


def test_a_mask_has_the_shape_of_the_fuel():
    with pytest.raises(ValueError, match=r"mask must have shape \(3, 3\)"):
        trees(fuel_grid(3, 3), mask=np.ones((3, 2), bool))
