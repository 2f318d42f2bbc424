"""Stands of trees: as many and as tall as their sources say, without a lattice, and the same whoever asks."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import forest
from firetwin_core.geo import LocalFrame
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from hypothesis_profiles import examples

FRAME = LocalFrame(38.93, -120.55, 0.0)
NAMES = ("cell", "position", "size_class", "model", "scale", "rotation", "width", "key")


def site(rows, columns, fuel=1.0):
    """Canopy fuel, latitude, longitude and elevation of a grid of 74 m cells on a slope."""
    latitude = 38.9 + 0.000667 * np.arange(rows)
    longitude = -120.58 + 0.000855 * np.arange(columns)
    elevation = 900.0 + 4.0 * np.arange(rows)[:, None] + 7.0 * np.arange(columns)
    return np.full((rows, columns), fuel, "f4"), latitude, longitude, elevation.astype("f4")


def stand(field, **options):
    return forest.stand(*field, FRAME, **options)


def area(rows, columns):
    """m2 of the grid."""
    middle = FRAME.forward([38.9, 38.9 + 0.000667], [-120.58, -120.58 + 0.000855], [900.0, 900.0])
    return rows * columns * abs(np.prod(middle[1, :2] - middle[0, :2]))


def test_stems_solve_the_published_equation():
    fuel = np.array([0.05, 0.3, 1.0, 2.0, 2.9])
    n = forest.stems(fuel) * 1e4
    diameter = 0.30 * fuel**0.25
    basal_area = n * np.pi / 4 * diameter**2
    assert -4.824 + 0.804 * np.log(basal_area) + 0.333 * np.log(n) == pytest.approx(np.log(fuel), abs=1e-9)
    assert np.all((n[2:] > 400) & (n[2:] < 900))  # hundreds a hectare in closed forest
    assert forest.stems([0.0, 0.01, np.nan, np.inf, -1.0]).tolist() == [0.0] * 5
    assert forest.stems(np.full((2, 3), 50.0)).tolist() == [[0.09] * 3] * 2


@pytest.mark.parametrize(("fuel", "kept"), [(1.0, 1.0), (3.5, 1.0), (0.05, 1.0), (1.0, 0.1), (2.0, 0.01)])
def test_as_many_trees_as_there_are_stems(fuel, kept):
    side = 8 if kept > 0.05 else 30
    field = site(side, side, fuel)
    wanted = kept * forest.stems(fuel) * area(side, side)
    found = len(stand(field, retained=np.full(field[0].shape, kept)))
    # a hard core scatters less than a Poisson process; 1 % for the omissions of reach and late births
    assert found == pytest.approx(wanted, abs=4.0 * np.sqrt(wanted) + 0.01 * wanted)


def _correlation(place, edges):
    """Pair correlation in rings, of trees far enough from the edge of a square."""
    low, high = place.min(0) + edges[-1], place.max(0) - edges[-1]
    inner = place[np.all((place > low) & (place < high), axis=1)]
    density = len(place) / np.prod(np.ptp(place, axis=0))
    counts = np.zeros(len(edges) - 1)
    inner = inner[:: len(inner) // 1500 + 1]
    for some in np.array_split(inner, 20):
        away = np.hypot(*(some[:, None] - place[None]).transpose(2, 0, 1))
        counts += np.histogram(away[away > 0], edges)[0]
    return counts / (len(inner) * density * np.pi * np.diff(edges**2))


@pytest.mark.parametrize("kept", [1.0, 0.3])
def test_trees_keep_their_distance_and_know_nothing_of_those_far_away(kept):
    side = int(8 / np.sqrt(kept))
    field = site(side, side)
    place = stand(field, retained=np.full(field[0].shape, kept)).position[:, :2]
    spacing = 1.0 / np.sqrt(kept * forest.stems(1.0))
    edges = spacing * np.concatenate([[0.0, 0.55], np.arange(0.6, 5.6, 0.25)])
    found = _correlation(place, edges)
    assert found[0] == 0.0
    assert np.all(found[2:] < 1.35)
    assert found[edges[:-1] > 2.0 * spacing] == pytest.approx(1.0, abs=0.1)
    assert np.mean(found[edges[:-1] > 2.0 * spacing]) == pytest.approx(1.0, abs=0.02)


def _wave(turns):
    """Return exp(2 pi i turns), without the complex exponential that Wine lacks."""
    return np.cos(2.0 * np.pi * turns) + 1j * np.sin(2.0 * np.pi * turns)


def _peak(place, step):
    """Largest structure factor at waves of 6 to 80 m along and across, in a square, without its own shape.

    Waves fit the square, so that it has no peak; for N trees on a lattice the largest is N.
    """
    side = np.ptp(place, axis=0)
    number = np.arange(1, int(side.min() / step)) * 1.0
    largest = 0.0
    for axis in (0, 1):
        waves = _wave(np.outer(number, place[:, axis] / side[axis]))
        across = _wave(place[:, 1 - axis] / side[1 - axis])
        for _ in range(6):  # waves across: 0 to 5
            largest = max(largest, float(np.max(np.abs(waves.sum(1)) ** 2 / len(place))))
            waves *= across
    return largest


def test_the_spectrum_has_no_peaks():
    place = stand(site(8, 8)).position[:, :2]
    # about 1200 waves of mean 1.2 or less: the largest of as many exponential numbers is near ln(1200)
    assert _peak(place, 4.0) < 16.0
    n = int(np.sqrt(len(place)))
    lattice = np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1).reshape(-1, 2).astype(float)
    jittered = lattice + 0.85 * np.random.default_rng(1).random(lattice.shape)
    jittered *= np.ptp(place, axis=0) / n
    assert _peak(jittered, 4.0) > 50.0  # the measure finds the lattice


FIELD = site(6, 7)
FIELD[0][:] = np.random.default_rng(4).gamma(2.0, 0.5, FIELD[0].shape)
FIELD[0][2, 3] = 0.0
ALL = stand(FIELD, seed=3)


@settings(max_examples=examples(40), deadline=None)
@given(arrays.arrays(bool, (6, 7)))
def test_a_cells_trees_do_not_hang_on_which_others_are_asked_for(mask):
    found = stand(FIELD, seed=3, mask=mask)
    chosen = mask.ravel()[ALL.cell]
    for name in NAMES:
        np.testing.assert_array_equal(getattr(found, name), getattr(ALL, name)[chosen], name)


@settings(max_examples=examples(30), deadline=None)
@given(
    arrays.arrays(float, (6, 7), elements=st.floats(0.0, 1.0)),
    arrays.arrays(float, (6, 7), elements=st.floats(0.0, 1.0)),
)
def test_what_is_kept_of_less_is_kept_of_more(more, part):
    many, few = (set(stand(FIELD, seed=3, retained=k).key.tolist()) for k in (more, more * part))
    assert few <= many <= set(ALL.key.tolist())
    assert len(set(ALL.key.tolist())) == len(ALL)


def test_a_changed_cell_changes_only_itself_and_its_neighbours():
    fuel = FIELD[0].copy()
    fuel[4, 1] += 0.7
    changed = stand((fuel, *FIELD[1:]), seed=3)
    y, x = np.divmod(ALL.cell, 7)
    far = (np.abs(y - 4) > 1) | (np.abs(x - 1) > 1)
    y, x = np.divmod(changed.cell, 7)
    np.testing.assert_array_equal(
        ALL.position[far], changed.position[(np.abs(y - 4) > 1) | (np.abs(x - 1) > 1)]
    )
    assert len(changed) > len(ALL)


def test_the_same_on_any_number_of_threads(all_threads):
    field = site(20, 20)
    results = []
    for threads in (1, 2, 4, 16):
        core.set_threads(threads)
        results.append(stand(field, seed=5))
    for found in results[1:]:
        for name in NAMES:
            np.testing.assert_array_equal(getattr(found, name), getattr(results[0], name))
    assert not np.array_equal(stand(field, seed=6).key[:50], results[0].key[:50])


def _cover(trees, low, high, step=0.5):
    """Part of the ground between two corners under crowns of a fifth of the height to each side."""
    east, north = (np.arange(a, b, step) for a, b in zip(low, high, strict=True))
    under = np.zeros((len(north), len(east)), bool)
    for (x, y), radius in zip(trees.position[:, :2], 0.2 * trees.scale * trees.width, strict=True):
        i, j = (
            np.searchsorted(east, (x - radius, x + radius)),
            np.searchsorted(north, (y - radius, y + radius)),
        )
        part = np.s_[j[0] : j[1], i[0] : i[1]]
        under[part] |= (east[None, i[0] : i[1]] - x) ** 2 + (north[j[0] : j[1], None] - y) ** 2 < radius**2
    return under.mean()


@pytest.mark.parametrize("fuel", [0.2, 1.0, 2.5])
def test_a_thinned_stand_covers_as_much_ground(fuel):
    field = site(12, 12, fuel)
    corners = np.array([[-200.0, -200.0], [200.0, 200.0]])
    middle = FRAME.forward([38.9 + 0.000667 * 5.5], [-120.58 + 0.000855 * 5.5], [900.0])[0, :2]
    low, high = corners + middle
    whole = _cover(stand(field), low, high)
    for kept in (0.3, 0.03):
        thinned = stand(field, retained=np.full(field[0].shape, kept))
        assert np.all(thinned.width >= 1.0)
        assert _cover(thinned, low, high) == pytest.approx(whole, abs=0.04), kept


def test_many_are_small_and_few_large_and_heights_follow_from_diameters():
    trees = stand(site(14, 14, 1.0))
    tall = np.sort(trees.scale.astype(float))
    assert 3.07 < tall[0] < 3.3
    assert tall[-1] < 41.0
    # Diameters (m): 0.05 and an exponential of the mean m, 0.05^2 + 2 0.05 m + 2 m^2 = 0.30^2
    mean = (np.sqrt(2 * 0.3**2 - 0.05**2) - 0.05) / 2
    for part in (0.1, 0.5, 0.9, 0.99):
        inches = (0.05 - mean * np.log(1.0 - part)) / 0.0254
        expected = 0.3048 * (4.5 + np.exp(4.86039 - 9.32795 / (inches + 1.0)))
        assert np.quantile(tall, part) == pytest.approx(expected, rel=0.03)
    assert np.all((trees.size_class == forest.LARGE) == (tall.dtype.type(22.0) <= trees.scale))
    assert np.all((trees.size_class == forest.SMALL) == (trees.scale < 8.0))
    assert set(trees.model[trees.size_class == forest.LARGE]) == {0, 1}
    assert set(trees.model[trees.size_class == forest.MEDIUM]) == {0, 1, 2, 3}
    assert np.all(trees.width == 1.0)
    assert np.corrcoef(trees.rotation, trees.model)[0, 1] == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize("turned", [False, True])
def test_trees_stand_in_their_cells_on_the_ground(turned):
    field = site(7, 6)
    if turned:
        field = (field[0], field[1][::-1], field[2][::-1], field[3])
    trees = stand(field)
    latitude, longitude, height = FRAME.reverse(trees.position)
    y, x = np.divmod(trees.cell, 6)
    row = (np.asarray(latitude) - field[1][0]) / (field[1][1] - field[1][0])
    column = (np.asarray(longitude) - field[2][0]) / (field[2][1] - field[2][0])
    assert np.all(np.abs(row - y) <= 0.5 + 1e-9)
    assert np.all(np.abs(column - x) <= 0.5 + 1e-9)
    inner = (row > 0) & (row < 6) & (column > 0) & (column < 5)
    plane = 900.0 + 4.0 * row + 7.0 * column
    np.testing.assert_allclose(np.asarray(height)[inner], plane[inner], rtol=0, atol=1e-4)


@pytest.mark.parametrize("what", [0.0, 0.01, np.nan, np.inf])
def test_cells_without_fuel_are_clear(what):
    field = site(5, 5)
    field[0][2, 2] = what
    cells = set(stand(field).cell.tolist())
    assert cells == set(range(25)) - {12}
    beside = stand(field).cell == 11
    assert 0 < beside.sum() < np.sum(stand(site(5, 5)).cell == 11)  # the forest's edge is open


def test_cells_without_ground_are_clear():
    field = site(5, 5)
    field[3][1, 1] = np.nan
    trees = stand(field)
    assert set(trees.cell.tolist()) == set(range(25)) - {6}
    assert np.isfinite(trees.position).all()


def test_what_is_kept_of_nothing():
    field = site(4, 4)
    for kept in (0.0, np.nan, -1.0):
        assert len(stand(field, retained=np.full((4, 4), kept))) == 0
    assert len(stand(field, mask=np.zeros((4, 4), bool))) == 0
    assert len(stand(site(1, 1))) == 0  # an only cell has no size
    assert len(forest.stand(np.zeros((0, 0)), [], [], np.zeros((0, 0)), FRAME)) == 0


def test_shapes_that_do_not_fit():
    field = site(4, 4)
    for wrong in ({"retained": np.ones((3, 4))}, {"mask": np.ones((4, 3), bool)}):
        with pytest.raises(ValueError, match="shape"):
            stand(field, **wrong)
