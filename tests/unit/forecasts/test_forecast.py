"""A run and an ensemble belong together only if the run is a member: refusals and words, at each door."""

from datetime import UTC, datetime

import numpy as np
import pytest
import small_stations
import whole_run
from firetwin import cli
from firetwin.errors import InputError
from firetwin.forecasts import forecast, line_arrivals
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.run import readers

ISSUED = datetime(2014, 9, 17, 4, 0, tzinfo=UTC)
PLACE = 38.9, -120.6


def make_run(folder, at):
    """Write a run of three hours, 60 cells of 30 m a side."""
    return whole_run.write(
        folder,
        cells=60,
        at=at,
        times=(0.0, 3600.0, 7200.0, 10800.0),
        start="2014-09-17T04:00:00Z",
        speed=0.06,
    )


def make_ensemble(out, run, change=None):
    """Write an ensemble of the run's fire, and of one at half its speed."""
    latitude, longitude = (np.load(run / f"fuel_{axis}.npy") for axis in ("latitude", "longitude"))
    times = np.nan_to_num(np.load(run / "fuel_arrival_time.npy").astype(np.float32), nan=np.inf)
    every = [(Member("00"), change(times) if change else times), (Member("01"), times * 2.0)]
    write.write(out, Manifest("Made up", "", ISSUED, 10800.0, ()), latitude, longitude, every)
    return out


@pytest.fixture(scope="module")
def mine(tmp_path_factory):
    """A run, its ensemble, and the ensemble of a fire 400 m to the north of it."""
    folder = tmp_path_factory.mktemp("doors")
    run, other = make_run(folder / "run", PLACE), make_run(folder / "other", (38.9036, -120.6))
    return run, make_ensemble(folder / "mine", run), make_ensemble(folder / "theirs", other)


def test_a_run_is_named_as_its_member(mine, tmp_path):
    run = readers.open(mine[0])
    assert forecast.shown_by(ensemble.open(mine[1]), run) == "The run is member 00 of the forecast."

    def grown(times):
        """Burn 4 cells far from the fire, too: about 1.5 % of the area."""
        more = times.copy()
        more[0, :4] = 60.0
        return more

    near = forecast.shown_by(ensemble.open(make_ensemble(tmp_path / "near", mine[0], grown)), run)
    assert near.startswith("The run is similar to member 00 of the forecast, but not equal: of the area that")
    assert near.endswith("T07:00:00Z, 98.5% burned in both."), near


@pytest.mark.parametrize("away", [(38.9036, -120.6), (39.0, -120.6), (43.0, -116.0)])
def test_an_ensemble_of_another_fire_is_refused(mine, tmp_path, away):
    """Fires 400 m, 11 km and 600 km away: with common ground, and without."""
    theirs = ensemble.open(make_ensemble(tmp_path / "e", make_run(tmp_path / "far", away)))
    with pytest.raises(
        InputError, match=r"has no member that is the run .*, and 97% are needed; give the run"
    ):
        forecast.shown_by(theirs, readers.open(mine[0]))


def test_each_door_refuses_it(mine, tmp_path, capsys):
    run, members, others = mine
    stations = small_stations.briefed(tmp_path / "stations.gpkg", [("Alpha", *PLACE)])
    doors = (
        ("brief", run, "--out", tmp_path / "page.html"),
        ("resources", stations, "--stations", "--run", run),
    )
    for door in doors:
        assert cli.main([*map(str, door), "--ensemble", str(others)]) == 1
        assert "theirs: has no member that is the run" in capsys.readouterr().err
        assert cli.main([*map(str, door), "--ensemble", str(members)]) == 0
        capsys.readouterr()
    page = (tmp_path / "page.html").read_text()
    assert "<p>The run is member 00 of the forecast.</p>" in page
    assert page.index('<h2 id="forecast-title">') < page.index('<h2 id="map-title"'), (
        "the forecast comes first"
    )
    suggestion = {"from": "2014-09-17T04:00:00Z", "divisions": [], "assumptions": []}
    with pytest.raises(InputError, match="theirs: has no member"):
        line_arrivals.add(suggestion, readers.open(run), ensemble.open(others), {"features": []})
