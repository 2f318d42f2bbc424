"""ForeFire's landscape on a map: heights without steps, and wind."""

from pathlib import Path

import model_files as made
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run.models import fuels
from model_files import said

SIDE, BOX = 1000.0, "9.0,42.0,9.02,42.02"
FUEL = np.ones((1, 1, 4, 4), np.int16)
ARRIVAL = np.hypot(*np.mgrid[-50:50, -60:60]) * 10.0  # cells of 8.33 m by 10 m


@pytest.fixture
def make(tmp_path, converted):
    """Convert a map and a landscape of the same domain."""

    def run(altitude=None, wind=None, fuel=FUEL, **domain):
        altitude = np.zeros((1, 1, 5, 5), np.float32) if altitude is None else altitude[None, None]
        files = [made.forefire(tmp_path / "ForeFire.0.nc", ARRIVAL, lx=SIDE, ly=SIDE)]
        files += [
            made.landscape(tmp_path / "land.nc", fuel, altitude, size=SIDE, box=BOX, wind=wind, **domain)
        ]
        return converted(files)

    return run


@pytest.mark.parametrize("kind", [np.float32, np.int16])
def test_heights_have_no_steps(make, kind):
    """A slope of 1:2 in cells of 20 m: between their middles it is a plane on cells of 10 m by 8.33 m."""
    y, x = ((np.arange(50) + 0.5) * 20.0 for _ in range(2))
    altitude = 100.0 + 0.5 * x[None, :] + 0.25 * y[:, None]
    run = make(altitude.astype(kind))
    east, north = (np.arange(120) + 0.5) * SIDE / 120, (np.arange(100) + 0.5) * SIDE / 100
    plane = 100.0 + 0.5 * np.clip(east, 10, 990)[None, :] + 0.25 * np.clip(north, 10, 990)[:, None]
    assert run.elevation == pytest.approx(plane, abs=1e-3 if kind is np.float32 else 1.0)
    assert ("whole metres" in said(run)) == (kind is np.int16)
    assert "altitude of land.nc" in said(run)


def test_wind_of_one_time_blows_all_the_time(make):
    u = np.full((1, 1, 2, 3), 4.0, np.float32)
    v = np.linspace(-1, 1, 6, dtype=np.float32).reshape(1, 1, 2, 3)
    run = make(wind=(u, v))
    for index in (0, len(run.times) - 1):
        east, north = run.wind(index)
        assert (east == 4.0).all()
        assert north[[0, -1], [0, -1]].tolist() == [-1.0, 1.0]
        assert (np.diff(north, axis=0) >= 0).all()
        assert np.abs(np.diff(north, axis=1)).max() < 0.02  # no stripes
    assert "windU and windV of land.nc" in said(run)


def test_winds_of_several_times_share_the_time(make):
    u = np.arange(1.0, 4.0).reshape(3, 1, 1, 1)
    run = make(wind=(u, 0 * u), t0=0.0, Lt=600.0)
    for index, time in enumerate(run.times):
        assert (run.wind(index)[0] == 1.0 + min(time // 200.0, 2)).all()


def test_of_winds_without_their_time_the_first_is_used_and_that_is_said(make):
    u = np.arange(1.0, 4.0).reshape(3, 1, 1, 1)
    run = make(wind=(u, 0 * u))
    assert (run.wind(len(run.times) - 1)[0] == 1.0).all()
    assert "has 3 winds without their duration" in said(run)


def test_what_answers_to_a_wind_that_is_not_there_is_no_wind(make):
    u = np.ones((1, 2, 1, 1))
    run = make(wind=(u, u))
    assert not (Path(run.path) / "wind_east.npy").exists()
    assert "are the response to an unspecified wind" in said(run)


def test_halves_of_a_wind_have_to_fit(make):
    with pytest.raises(InputError, match=r"land\.nc.*windU \(1, 1, 1, 1\) and windV \(1, 1, 2, 1\)"):
        make(wind=(np.ones((1, 1, 1, 1)), np.ones((1, 1, 2, 1))))


@pytest.mark.parametrize(
    ("numbers", "models", "words"),
    [
        ([311, 312, 323, 512], {182, 188, 147, 98}, "Corine land cover"),
        ([102, 145, 183, 98], {102, 145, 183, 98}, "Scott and Burgan's fuel models"),
    ],
)
def test_fuel_without_a_table_is_read_by_its_legend(make, numbers, models, words):
    run = make(fuel=np.repeat(np.array(numbers, np.int16), 4).reshape(1, 1, 4, 4))
    assert set(np.unique(run.fuel_rows("fuel_category", 0, len(run.fuel_latitude)))) == models
    assert np.unique(run.surface_fuel) == pytest.approx(np.unique(fuels.loads(np.array(sorted(models)))))
    assert f"fuel of land.nc has the numbers of {words}" in said(run)


@pytest.mark.parametrize("numbers", [[1, 2, 5, 7], [121, 122, 123, 142], [311, 312, 9999, 512]])
def test_fuel_of_no_clear_legend_is_named_as_unused(make, numbers):
    run = make(fuel=np.repeat(np.array(numbers, np.int16), 4).reshape(1, 1, 4, 4))
    assert "fuel_category" not in run.fields
    text = said(run)
    assert f"fuel of land.nc is not used: its numbers ({', '.join(map(str, sorted(numbers)))})" in text
    assert "add the model's fuels table" in text
