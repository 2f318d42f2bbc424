"""Exposure of samples: it rises in the dark to a limit, and not where lights would become too bright."""

import numpy as np
import pytest
from firetwin.dataset import metering


def _grey(value):
    return np.full((48, 64, 3), value, np.float32)


def test_a_day_keeps_its_exposure_and_a_night_rises_to_the_shown_luminance():
    assert metering.rise(_grey(0.2), 0.5) == 0.0
    risen = metering.rise(_grey(0.001), 2.0)
    assert 0.0 < risen < metering.MOST
    assert 0.001 * 2.0 ** (2.0 + risen) == pytest.approx(metering._SHOWN, rel=1e-3)


def test_the_rise_has_a_limit():
    assert metering.rise(_grey(0.0), 0.0) == metering.MOST


def test_flames_that_are_white_already_keep_the_exposure():
    night = _grey(0.001)
    night[:6, :6] = 2.0
    assert metering.rise(night, 2.0) == 0.0


def test_a_lamp_of_few_pixels_does_not_keep_the_exposure():
    night = _grey(0.001)
    night[0, :2] = 5.0
    assert metering.rise(night, 2.0) == pytest.approx(metering.rise(_grey(0.001), 2.0), abs=0.1)
