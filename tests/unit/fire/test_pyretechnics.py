"""Wind of pyretechnics' matrices."""

import numpy as np
import pytest
from firetwin.errors import InputError

ARRIVAL = np.hypot(*np.mgrid[-8:9, -8:9]) * 1.5  # minutes


@pytest.fixture
def make(tmp_path, converted):
    def run(**arrays):
        path = tmp_path / "a.npz"
        np.savez(path, time_of_arrival=ARRIVAL, cell_width=30.0, cell_height=30.0, **arrays)
        return converted([path], start="2020-07-01T20:00:00Z", at="39,-120")

    return run


def test_wind_goes_where_it_does_not_come_from(make):
    """36 km/h from the west, then from the south: 10 m/s to the east, then to the north."""
    run = make(wind_speed_10m=36.0, upwind_direction=[270.0, 180.0], band_duration=5.0)
    for index, time in enumerate(run.times):
        east, north = (np.unique(np.round(each, 3)).tolist() for each in run.wind(index))
        assert (east, north) == (([10.0], [0.0]) if time < 300.0 else ([0.0], [10.0]))


def test_wind_may_differ_from_cell_to_cell(make):
    speed = np.arange(ARRIVAL.size, dtype=float).reshape(1, *ARRIVAL.shape)
    run = make(wind_speed_10m=3.6 * speed, upwind_direction=180.0)
    assert run.wind(3)[1] == pytest.approx(speed[0], rel=1e-6)


@pytest.mark.parametrize(
    ("arrays", "reason"),
    [
        ({"wind_speed_10m": [1.0, 2.0], "upwind_direction": 0.0}, "band_duration"),
        ({"wind_speed_10m": np.ones((1, 3, 4)), "upwind_direction": 0.0}, "not of its bands and cells"),
        ({"wind_speed_10m": [1.0, 2.0], "upwind_direction": np.ones(3)}, "not of its bands and cells"),
        ({"wind_speed_10m": np.nan, "upwind_direction": 0.0}, "gaps"),
        ({"wind_speed_10m": np.ones((3, 4)), "upwind_direction": 0.0}, "bands, rows, columns"),
    ],
)
def test_wind_that_makes_no_sense(make, arrays, reason):
    with pytest.raises(InputError, match=reason):
        make(**arrays)
