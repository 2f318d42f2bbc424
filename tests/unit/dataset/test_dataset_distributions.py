"""Distributions against their closed forms."""

import numpy as np
import pytest
from firetwin.dataset.distributions import VALUES, Choice, Constant, LogNormal, LogUniform, Uniform
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from scipy import stats

SHARE = st.floats(0.0, 1.0, exclude_max=True)


@given(share=SHARE, low=st.floats(0.01, 1e4), ratio=st.floats(1.0, 1e4))
@settings(max_examples=examples(60))
def test_quantiles_equal_those_of_scipy(share, low, ratio):
    high = low * ratio
    assert Uniform(low, high).quantile(share) == pytest.approx(low + share * (high - low))
    assert LogUniform(low, high).quantile(share) == pytest.approx(low * ratio**share)
    assert low <= LogUniform(low, high).quantile(share) <= high


@given(share=st.floats(0.001, 0.999))
@settings(max_examples=examples(60))
def test_a_log_normal_is_truncated_without_heaps_at_its_limits(share):
    low, high = np.log([3.0, 150.0])
    mean, sd = np.log(30.0), np.log(2.0)
    wanted = stats.truncnorm((low - mean) / sd, (high - mean) / sd, mean, sd).ppf(share)
    assert LogNormal(30.0, 2.0, 3.0, 150.0).quantile(share) == pytest.approx(np.exp(wanted), rel=1e-6)


def test_a_choice_has_its_weights():
    chosen = Choice((1.0, 5.0, 9.0), (1.0, 0.0, 3.0))
    assert [chosen.quantile(share) for share in (0.0, 0.2499, 0.25, 0.999999, 1.0)] == [
        1.0,
        1.0,
        9.0,
        9.0,
        9.0,
    ]
    assert Constant(4.0).quantile(0.3) == 4.0


@given(name=st.sampled_from(sorted(VALUES)), share=SHARE)
@settings(max_examples=examples(100))
def test_defaults_are_within_the_bounds_of_their_values(name, share):
    value = VALUES[name]
    assert value.low <= value.default.quantile(share) <= value.high
