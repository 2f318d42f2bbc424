"""Arrival of members at stations and control lines, in lists of other commands."""

import json
import re
from datetime import UTC, datetime

import numpy as np
import pytest
import small_stations
from firetwin import cli
from firetwin.forecasts import forecast, line_arrivals
from firetwin.forecasts.ensemble import ensemble, write
from firetwin.forecasts.ensemble.manifest import Manifest, Member
from firetwin.run import readers
from small_run import small_fields


def call(capsys, *arguments):
    """Run the command in this process: its output."""
    assert cli.main([*map(str, arguments)]) == 0
    return capsys.readouterr().out


@pytest.fixture(autouse=True)
def _any_run(monkeypatch):
    """Accept the run of a list as a member: `test_forecast` has the check."""
    monkeypatch.setattr(forecast, "shown_by", lambda *_: "The run is member 00 of the forecast.")


@pytest.fixture
def members(tmp_path):
    """Twenty members on the grid of the small run: 2 burn all in an hour, 8 in five, 10 nothing there."""
    fields = small_fields()
    latitude, longitude = fields["fuel_latitude"], fields["fuel_longitude"]
    shape = len(latitude), len(longitude)
    hours = [1.0] * 2 + [5.0] * 8 + [np.inf] * 10
    each = [(Member(f"{k:02}"), np.full(shape, 3600.0 * hour, np.float32)) for k, hour in enumerate(hours)]
    head = Manifest("Many", "", datetime(2014, 9, 17, 4, 45, tzinfo=UTC), 6 * 3600.0, ())
    write.write(tmp_path / "ensemble", head, latitude, longitude, each)
    return tmp_path / "ensemble"


def test_members_of_a_forecast_at_stations(make_run, members, tmp_path, capsys):
    fields = small_fields()
    place = float(fields["fuel_latitude"][3]), float(fields["fuel_longitude"][3])
    station_file = small_stations.briefed(
        tmp_path / "there.gpkg", [("Inside", *place), ("Outside", 40.0, -120.0)]
    )
    text = call(capsys, "resources", station_file, "--stations", "--ensemble", members)
    assert "2 of 20 burn it by  10 of 20 burn it by  do not reach it by 17 Sep 02:45" in text
    rows = {name: line for line in text.splitlines() for name in ("Inside", "Outside") if name in line}
    assert re.search(r"16 Sep 21:45 +17 Sep 01:45 +10 of 20", rows["Inside"])
    assert rows["Outside"].count("not simulated") == 3
    assert "forecast: Many, 20 of 20 members, issued 16 Sep 2014 20:45 -08" in text
    text = call(capsys, "resources", station_file, "--stations", "--ensemble", members, "--json")
    inside, outside = (each["forecast"] for each in json.loads(text)["matches"])
    assert [each["time"] for each in inside["burned_by"]] == [
        "2014-09-17T05:45:00Z",
        "2014-09-17T09:45:00Z",
        None,
    ]
    assert (inside["members"], inside["not_reached"], outside["members"]) == (20, 10, 0)
    for late, listed in (("2014-09-17T05:00Z", ["Inside"]), ("2014-09-17T06:00Z", [])):
        options = "--ahead", "--available-at", late, "--json"
        text = call(capsys, "resources", station_file, "--stations", "--ensemble", members, *options)
        assert [each["station"]["name"] for each in json.loads(text)["matches"]] == listed
    text = call(capsys, "resources", station_file, "--stations", "--run", make_run(), "--ensemble", members)
    assert "fire  " in text
    assert " Sep 2014" in text, "the zone of the run"
    assert "forecast: The run is member 00 of the forecast." in text


def test_members_at_a_control_line(make_run, members):
    """The line is reached after 60 and 300 minutes, and its hour is 70 minutes after the issue time."""
    fields = small_fields()
    point = [float(fields["fuel_longitude"][3]), float(fields["fuel_latitude"][3])]
    about = {"kind": "control_line", "division": "A", "hour": 1.0}
    drawn = {"features": [{"properties": about, "geometry": {"coordinates": [[point], [point]]}}]}
    suggestion = {
        "from": "2014-09-17T04:55:00Z",
        "divisions": [{"name": "A"}, {"name": "B"}],
        "assumptions": [],
    }
    lines = line_arrivals.add(suggestion, readers.open(make_run()), ensemble.open(members), drawn)
    told = suggestion["divisions"][0]["forecast"]
    assert (told["members"], told["hour"], told["reached_by_hour"]) == (20, 1.0, 2)
    assert [each["time"] for each in told["reached_by"]] == [
        "2014-09-17T05:45:00Z",
        "2014-09-17T09:45:00Z",
        None,
    ]
    assert "forecast" not in suggestion["divisions"][1]
    assert lines["A"][0].startswith("members of the forecast at this line: 2 of 20 by ")
    assert lines["A"][0].endswith(" when the forecast ends")
    assert lines["A"][1] == "2 of 20 members reach it by hour 1"
    assert suggestion["assumptions"][1] == "forecast: The run is member 00 of the forecast."
    assert suggestion["assumptions"][0].startswith("forecast: Many, 20 of 20 members, issued 16 Sep 2014 ")
