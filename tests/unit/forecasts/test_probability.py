"""Scores of probabilities: by hand, by their properties, and by libraries that we did not write."""

import numpy as np
import pytest
from firetwin.forecasts import probability
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

NEVER = 24.0  # h, censored at the end of the forecast


def test_crps_with_a_member_that_never_burns_by_hand():
    """Members 10, 12, 14 and never, of a forecast of 24 h."""
    members = np.array([[10.0], [12.0], [14.0], [NEVER]])
    assert probability.crps(members, np.array([11.0])) == pytest.approx([1.75])
    assert probability.crps(members, np.array([11.0]), fair=True) == pytest.approx([0.8333333])
    assert probability.crps(members, np.array([NEVER])) == pytest.approx([6.25])


values = arrays.arrays(np.float64, st.tuples(st.integers(1, 6), st.integers(1, 4)), elements=st.floats(0, 24))


@given(values, st.floats(0, 24))
def test_crps_is_the_integral_over_thresholds(members, observed):
    """Integral of (share of members at or below t - observed at or below t) squared."""
    seen = np.full(members.shape[1], observed)
    edges = np.unique(np.concatenate([members.ravel(), seen]))
    middle = (edges[1:] + edges[:-1]) / 2
    step = (members[:, :, None] <= middle).mean(0) - (seen[:, None] <= middle)
    expected = (step**2 * np.diff(edges)).sum(1)
    np.testing.assert_allclose(probability.crps(members, seen), expected, atol=1e-9)


def test_fair_crps_needs_two_members():
    assert np.isnan(probability.crps(np.array([[1.0]]), np.array([2.0]), fair=True)).all()
    assert probability.crps(np.array([[1.0]]), np.array([2.0])) == 1.0


forecasts = st.integers(2, 30).flatmap(
    lambda n: st.tuples(
        arrays.arrays(np.float64, n, elements=st.sampled_from([0.0, 0.25, 0.5, 0.75, 1.0])),
        arrays.arrays(bool, n),
        arrays.arrays(np.float64, n, elements=st.floats(0.5, 2.0)),
    )
)


@given(forecasts)
def test_the_parts_of_the_brier_score_add_up(forecast):
    found = probability.brier(*forecast)
    assert found.score == pytest.approx(found.reliability - found.resolution + found.uncertainty, abs=1e-12)
    assert found.score == pytest.approx(np.average((forecast[0] - forecast[1]) ** 2, weights=forecast[2]))


def test_reliability_counts_cells():
    rows = probability.reliability(np.array([0.5, 0.5, 1.0, 0.0]), np.array([1, 0, 1, 0], bool), np.ones(4))
    assert [(row.probability, row.frequency, row.cells) for row in rows] == [
        (0, 0, 1),
        (0.5, 0.5, 2),
        (1, 1, 1),
    ]


def test_fss_by_hand():
    """Two cells that touch: no skill in a cell, perfect in a window that holds both."""
    here, there = np.zeros((2, 5, 5))
    here[2, 1], there[2, 2] = 1.0, 1.0
    assert probability.fss(here, there, 1) == 0.0
    assert probability.fss(here, there, 5) == 1.0
    # of the 9 windows of 3 cells, 6 hold the first, and all hold the second
    assert probability.fss(here, there, 3) == pytest.approx(1 - 3 / (6 + 9))
    assert np.isnan(probability.fss(here * 0, there * 0, 3))
    assert np.isnan(probability.fss(here, there, 6))


def test_libraries_agree():
    """`scores` and properscoring: CRPS, fair CRPS, Brier score and FSS to 1e-12."""
    rng = np.random.default_rng(4)
    members, observed = np.minimum(rng.gamma(2.0, 8.0, (7, 300)), NEVER), rng.uniform(0, NEVER, 300)
    oracle = pytest.importorskip("properscoring")
    expected = oracle.crps_ensemble(observed, members.T)
    np.testing.assert_allclose(probability.crps(members, observed), expected, rtol=0, atol=1e-12)
    library = pytest.importorskip("scores")
    spatial = pytest.importorskip("scores.spatial")
    xarray = pytest.importorskip("xarray")
    forecast = xarray.DataArray(members, dims=("member", "cell"))
    seen = xarray.DataArray(observed, dims="cell")
    for method, fair in (("ecdf", False), ("fair", True)):
        expected = library.probability.crps_for_ensemble(
            forecast, seen, "member", method=method, preserve_dims="all"
        )
        np.testing.assert_allclose(probability.crps(members, observed, fair), expected, rtol=0, atol=1e-12)
    expected = library.probability.brier_score_for_ensemble(
        forecast, seen, "member", 12.0, fair_correction=False
    )
    ours = probability.brier((members >= 12).mean(0), observed >= 12, np.ones(300))
    assert ours.score == pytest.approx(float(expected.squeeze()), abs=1e-12)
    fields = rng.random((2, 20, 30)) > 0.7
    for width in (1, 3, 7):
        expected = spatial.fss_2d_single_field(
            *fields.astype(float), event_threshold=0.5, window_size=(width, width)
        )
        assert probability.fss(*fields.astype(float), width) == pytest.approx(float(expected), abs=1e-12)
