"""Dated events: flare-ups, ignition, and the arrival of the fire at places."""

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.run import times
from firetwin.run.labels import Label
from firetwin.stations import events, fire_arrival
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize(
    ("rate", "found"),
    [
        ([], []),
        ([0.0, 0.0], []),
        ([1.0, 1.0, 1.0], []),
        ([1.0, 9.0, 1.0, 1.0, 1.0], [1]),
        ([1.0, 9.0, 9.0, 1.0, 1.0, 1.0, 1.0, 1.0], [1]),
        ([9.0, 1.0, 1.0, 1.0, 1.0, 8.0], [0, 5]),
        ([1.0, 8.0, 7.0, 9.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0], [3]),
        ([1.0, 2.0, 1.0, 2.0, 1.0], []),
    ],
)
def test_peaks_exceed_twice_the_mean(rate, found):
    assert events.peaks(np.array(rate)) == found


@given(st.lists(st.integers(0, 20), min_size=1, max_size=30))
def test_the_highest_rate_is_a_peak_if_it_exceeds_twice_the_mean(rate):
    values = np.array(rate, float)
    assert (int(np.argmax(values)) in events.peaks(values)) == (values.max() > 2 * values.mean())


def test_events_of_a_run_have_its_times(make_run):
    y, x = np.meshgrid(np.arange(8), np.arange(10), indexing="ij")
    run = runs.open(make_run(fuel_arrival_time=10.0 + 5.0 * y + 5.0 * x))
    place = Label("Here", float(run.fuel_latitude[3]), float(run.fuel_longitude[4]))
    outside = Label("Far", 38.0, -121.0)
    assert events.arrivals_at(run, [place, outside]) == [
        events.Event(times.utc(run, 45.0), "the fire reaches Here", "Here")
    ]
    assert events.arrivals_at(run, []) == []
    (began,) = events.ignitions(run)
    nearest = fire_arrival.sample(run, *([each] for each in events.ignition.find(run)[0])).nearest_time[0]
    assert began == events.Event(times.utc(run, float(nearest)), "ignition")
    (flare_up,) = events.flare_ups(run)
    assert flare_up.time == times.utc(run, 120.0)
