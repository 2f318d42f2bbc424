"""Wording of fire arrival: closest approach instead of "never", and no uncertainty without a source."""

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.stations import arrival_text, fire_arrival
from small_run import small_fields


@pytest.fixture
def burning(make_run):
    """A run in which the western columns burn within a minute."""
    fields = small_fields()
    arrival = np.full((len(fields["fuel_latitude"]), len(fields["fuel_longitude"])), np.nan)
    arrival[:, :3] = 30.0
    arrival[0, 0] = -30.0
    return runs.open(make_run(fuel_arrival_time=arrival))


def describe(run, latitude, longitude, **options):
    found = fire_arrival.sample(run, [latitude], [longitude])
    return arrival_text.describe(run, found, 0, "America/Los_Angeles", **options)


@pytest.mark.parametrize(
    ("metres", "text"),
    [
        (0.4, "10 m"), (280.0, "280 m"), (281.0, "290 m"), (990.0, "990 m"), (991.0, "1.0 km"),
        (4310.0, "4.4 km"), (9900.0, "9.9 km"), (9901.0, "10 km"), (14_000.0, "14 km"),
    ],
)  # fmt: skip
def test_a_distance_is_never_shorter_than_it_is(metres, text):
    assert arrival_text.format_distance(metres) == text


def test_a_near_place_has_distance_and_time_of_the_closest_approach(burning):
    y, x = burning.fuel_latitude, burning.fuel_longitude
    near = describe(burning, y[4], x[5])
    assert near.headline.startswith("within ")
    assert " m at 16 Sep 2014 " in near.headline
    assert "at the model's cell of " in near.note
    assert describe(burning, y[4], x[1]).headline.startswith("16 Sep 2014 ")
    assert str(describe(burning, y[0], x[0])).startswith("burned before the run, by 16 Sep 2014 ")


def test_a_far_place_is_not_reached_with_distance_and_period(burning):
    burning_far = describe(burning, burning.fuel_latitude[4], burning.fuel_longitude[0] - 0.5)
    assert burning_far.headline.startswith("outside the run, nearest fire ")
    assert " to 16 Sep 2014 " in burning_far.note
    found = fire_arrival.sample(burning, [burning.fuel_latitude[4]], [burning.fuel_longitude[5]])
    found.nearest_km[0] = 3.21
    text = arrival_text.describe(burning, found, 0, "America/Los_Angeles")
    assert text.headline == "not reached, nearest fire 3.3 km"


def test_an_uncertainty_needs_observations(burning):
    y, x = burning.fuel_latitude, burning.fuel_longitude
    assert "error" not in str(describe(burning, y[4], x[1]))
    assert describe(burning, y[4], x[1], error=2460.0).note.endswith("mean error 41 min against observations")


def test_a_run_without_arrival_times_names_its_output_interval(make_run):
    run = runs.open(make_run())
    assert arrival_text.format_resolution(run).endswith("m, output every 60 s")


def test_a_run_without_fire_has_no_distance(make_run):
    run = runs.open(make_run(heat_flux=np.zeros_like(small_fields()["heat_flux"])))
    assert describe(run, 38.9, -120.6).headline == "not reached"
    assert describe(run, 38.9, -120.6).note.startswith("no fire by ")
