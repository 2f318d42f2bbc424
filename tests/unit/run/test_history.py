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


def test_an_unknown_fire_is_refused_with_the_known_ones():
    with pytest.raises(firetwin_core.InputError, match="known are: king_fire") as caught:
        history.load("../king_fire")
    assert "king_fire" in caught.value.reason
