"""Facts about the King Fire."""

from datetime import UTC, datetime

import firetwin_core
import pytest
from firetwin.data import history


def test_reported_acres_grow_to_the_final_size():
    acreages = history.load("king_fire").acreages
    assert [each.acres for each in acreages] == sorted(each.acres for each in acreages)
    assert acreages[-1].acres == 97_717
    assert all(time.tzinfo is UTC and source for time, _, source, _ in acreages)
    assert datetime(2014, 9, 18, 2, 0, tzinfo=UTC) in [each.time for each in acreages if each.acres == 27_930]


def test_both_published_ignition_points_are_kept():
    points = [(point.latitude, point.longitude) for point in history.load().ignitions]
    assert points == [(38.782, -120.604), (38.805437, -120.629714)]
    assert {point.time for point in history.load().ignitions} == {datetime(2014, 9, 13, 23, 32, tzinfo=UTC)}


def test_rivers_rise_from_mouth_to_head():
    for name, line in history.load().rivers.items():
        heights = [height for _, _, height in line]
        assert heights == sorted(heights), name


def test_places_of_the_country_are_known():
    names = {place.name for place in history.load().places if not place.approximate}
    assert names >= {
        *("Pollock Pines", "Georgetown", "Foresthill", "Stumpy Meadows", "Union Valley"),
        *("Ice House", "Loon Lake", "Hell Hole", "French Meadows", "Pyramid Peak"),
    }


def test_an_unknown_fire_is_refused_with_the_known_ones():
    with pytest.raises(firetwin_core.InputError, match="known are: king_fire") as caught:
        history.load("../king_fire")
    assert "king_fire" in caught.value.reason
