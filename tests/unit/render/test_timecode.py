"""Exact frame rates, and timecode against SMPTE ST 12-1: by counting, and known values."""

import itertools
from fractions import Fraction

import pytest
from firetwin import timecode

NTSC = timecode.exact_rate(29.97)


@pytest.mark.parametrize(
    ("fps", "rate"),
    [(23.976, "24000/1001"), (23.98, "24000/1001"), (29.97, "30000/1001"), (59.94, "60000/1001"), (24, "24")],
)
def test_decimal_rates_are_exact_fractions(fps, rate):
    assert timecode.exact_rate(fps) == Fraction(rate)
    assert timecode.invalid_rate(fps) is None
    assert timecode.exact_rate(float(timecode.format_rate(timecode.exact_rate(fps)))) == Fraction(rate)


@pytest.mark.parametrize("fps", [23.5, 24.01, 12.5, 29.9])
def test_other_fractions_of_a_frame_are_refused(fps):
    assert "23.976" in timecode.invalid_rate(fps)


@pytest.mark.parametrize("fps", [29.97, 59.94])
def test_drop_frame_skips_the_first_numbers_of_nine_minutes_in_ten(fps):
    rate = timecode.exact_rate(fps)
    nominal, counted = timecode.nominal_rate(rate), itertools.count()
    for minute, second, frame in itertools.product(range(21), range(60), range(nominal)):
        if second or minute % 10 == 0 or frame >= nominal // 15:
            expected = 0, minute, second, frame
            assert timecode.components(next(counted), rate) == expected


def test_known_values_of_drop_frame():
    """Frame counts of SMPTE ST 12-1: 17,982 in ten minutes, 107,892 in an hour, 2,589,408 in a day."""
    known = {1799: (0, 0, 59, 29), 1800: (0, 1, 0, 2), 17_982: (0, 10, 0, 0), 107_892: (1, 0, 0, 0)}
    assert {count: timecode.components(count, NTSC) for count in known} == known
    assert timecode.components(2_589_407, NTSC) == (23, 59, 59, 29)
    assert timecode.components(2_589_408, NTSC) == (0, 0, 0, 0)


@pytest.mark.parametrize("fps", [12, 23.976, 24, 29.97, 30, 59.94])
def test_films_begin_at_one_hour(fps):
    rate = timecode.exact_rate(fps)
    mark = ";" if fps in (29.97, 59.94) else ":"
    last = timecode.nominal_rate(rate) - 1
    assert timecode.of_frame(1, rate) == f"01:00:00{mark}00"
    assert timecode.of_frame(0, rate) == f"00:59:59{mark}{last}"  # a slate before it
    assert timecode.of_frame(1 + round(rate), rate) == f"01:00:01{mark}00"
    behind = Fraction(timecode.count_of_frame(1, rate)) / rate - 3600
    assert abs(behind) <= (Fraction("0.0037") if mark == ";" else Fraction("3.6"))
