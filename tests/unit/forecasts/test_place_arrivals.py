"""Arrivals of members at places: quantiles and their words by hand."""

from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts.ensemble import place_arrivals, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member

END = ", when the forecast ends"
NEVER, NONE = np.inf, np.nan
HOUR = 3600.0


def make(folder, cells, weights=None, kind="forecast"):
    """Write an ensemble of a row of cells: arrivals (n, m), h, and sample it in each cell and outside."""
    arrival = HOUR * np.array(cells, np.float32).T[:, None]
    weights = weights or [1.0] * len(arrival)
    members = [Member(f"{i:02}", weight=weight) for i, weight in enumerate(weights)]
    about = Manifest("made up", "", datetime(2014, 9, 17, tzinfo=UTC), 24 * HOUR, (), kind=kind)
    longitude = -120.0 + 0.01 * np.arange(len(cells))
    write.write(
        folder / "e", about, np.array([38.0, 38.01]), longitude, zip(members, _rows(arrival), strict=True)
    )
    arrivals = place_arrivals.open_forecast(folder / "e", "this list")
    return place_arrivals.sample(arrivals, [38.0] * (len(cells) + 1), [*longitude, -119.0])


def _rows(arrival):
    return [np.repeat(each, 2, axis=0) for each in arrival]


def test_quantiles_count_never_and_leave_out_what_is_not_simulated(tmp_path):
    arrivals = make(tmp_path, [[1, 2, 3, 4], [1, 9, NEVER, NEVER], [NONE, 5, NEVER, 6], [-1, -1, NEVER, 7]])
    assert arrivals.by(0, 0.1) == HOUR
    assert arrivals.by(1, 0.5) == 9 * HOUR
    assert arrivals.by(1, 0.9) == NEVER
    assert arrivals.by(2, 0.5) == 6 * HOUR
    assert np.isnan(arrivals.by(4, 0.5))
    assert arrivals.reached.tolist() == [True] * 4 + [False]
    assert arrivals.simulated.tolist() == [True] * 4 + [False]


def test_sentences(tmp_path):
    arrivals = make(
        tmp_path,
        [[1, 2, 3, 4], [1, 9, NEVER, NEVER], [NONE, 5, NEVER, 6], [-1, -1, NEVER, 7], [NEVER] * 4],
    )
    assert [arrivals.sentence(place, "UTC") for place in range(6)] == [
        "1 of 4 by 17 Sep 01:00, 2 of 4 by 17 Sep 02:00",
        f"1 of 4 by 17 Sep 01:00, 2 of 4 by 17 Sep 09:00; not in 2 of 4 by 18 Sep 00:00{END}",
        f"1 of 3 by 17 Sep 05:00, 2 of 3 by 17 Sep 06:00; not in 1 of 3 by 18 Sep 00:00{END}",
        f"1 of 4 burned before, 2 of 4 burned before; not in 1 of 4 by 18 Sep 00:00{END}",
        f"not in 4 of 4 (within 1 km in 3) by 18 Sep 00:00{END}",
        "not simulated",
    ]
    few = make(tmp_path / "few", [[3] + [NEVER] * 29])
    assert few.sentence(0, "UTC").startswith("1 of 30 by 17 Sep 03:00; not in 29 of 30 by")


def test_members_near_a_place_without_fuel_are_counted(tmp_path):
    """Cells are 880 m wide: the fire of one member is in the next cell, and of another one after the next."""
    arrivals = make(tmp_path, [[NEVER] * 3, [2, NEVER, NEVER], [3, 3, NEVER], [NEVER] * 3])
    assert arrivals.near.tolist() == [1, 0, 0, 2, 0]
    assert arrivals.sentence(0, "UTC") == f"not in 3 of 3 (within 1 km in 1) by 18 Sep 00:00{END}"


def test_weights_are_said_not_to_be_used(tmp_path):
    assert make(tmp_path / "same", [[1, 2]], [0.5, 0.5]).weights_note() == ""
    note = make(tmp_path / "other", [[1, 2]], [0.5, 2.0]).weights_note()
    assert note == "Members count equally; their weights (0.5 to 2) are not used."


def test_other_kinds_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"holds named cases, .*; this list needs the kind forecast"):
        make(tmp_path, [[1, 2]], kind="scenarios")
