"""`firetwin stations` and `firetwin resources`: output, files, and failures."""

import json
import re

import numpy as np
import pytest
from firetwin import cli
from firetwin.commands import _fire
from firetwin.run import opening as runs
from firetwin.run import times
from firetwin.stations import reading, writing
from firetwin.stations.records import EXERCISE
from random_stations import random_stations
from small_run import RUN_TOML, small_fields
from station_files import write_hifld


def firetwin(capsys, *arguments):
    """Run the command in this process: status, stdout, stderr."""
    try:
        status = cli.main([*map(str, arguments)])
    except SystemExit as error:
        status = error.code
    out, err = capsys.readouterr()
    return status, out, err


@pytest.fixture
def run(make_run):
    """The small run of the King Fire's name, with a front that goes north."""
    fields = small_fields()
    y = fields["fuel_latitude"]
    arrival = np.repeat((10.0 + 10_000.0 * (y - y[0]))[:, None], len(fields["fuel_longitude"]), axis=1)
    arrival[7] = np.nan
    return make_run(fuel_arrival_time=arrival)


@pytest.fixture
def exercise(tmp_path, run, capsys):
    path = tmp_path / "exercise.gpkg"
    assert firetwin(capsys, "stations", "exercise", run, "--out", path)[0] == 0
    return path


def test_import_says_what_it_did_and_info_lists_it(tmp_path, capsys):
    path, out = write_hifld(tmp_path / "stations.csv"), tmp_path / "stations.gpkg"
    status, printed, said = firetwin(
        capsys, "stations", "import", path, "--out", out, "--licence", "mine", "--date", "2026-11-01"
    )
    assert (status, printed) == (0, f"{out}\n")
    assert "4 stations; source HIFLD fire stations, licence mine, data of 2026-11-01" in said
    assert said.count("rejected") == 3
    status, printed, _ = firetwin(capsys, "stations", "info", out)
    assert status == 0
    assert "stations   3" in printed
    assert "data of 2026-11-01" in printed
    assert EXERCISE not in printed
    status, printed, said = firetwin(capsys, "stations", "info", out, "--json")
    assert json.loads(printed)["origins"] == {"fact": 3}


def test_an_exercise_is_labelled_wherever_it_is_shown(exercise, capsys):
    for command in (("stations", "info"), ("resources",)):
        assert firetwin(capsys, *command, exercise)[1].startswith(f"{EXERCISE}\n")
        found = json.loads(firetwin(capsys, *command, exercise, "--json")[1])
        assert (found["exercise"], found["label"]) == (True, EXERCISE)
    assert reading.read(exercise).exercise


def test_an_exercise_elsewhere_needs_bases(tmp_path, make_run, capsys):
    folder = make_run(toml=RUN_TOML.replace('event = "king_fire"', ""))
    out = tmp_path / "exercise.gpkg"
    status, _, said = firetwin(capsys, "stations", "exercise", folder, "--out", out)
    assert status == 1
    assert "name a list of bases with --towns" in said
    (tmp_path / "towns.csv").write_text("name,lat,lon\nCamp,38.9,-120.6\n")
    towns = ("--towns", tmp_path / "towns.csv", "--seed", "4")
    assert firetwin(capsys, "stations", "exercise", folder, "--out", out, *towns)[0] == 0
    assert [each.name for each in reading.read(out).stations] == ["Exercise base Camp"]


def test_the_five_words_as_text_and_as_json(exercise, run, capsys):
    asked = (
        *("--run", run, "--near", "ignition", "--within", "60km", "--minutes", 90, "--kind", "engine"),
        *("--type", "1-3", "--mode", "attack", "--available-at", "2014-09-17T16:00-07:00"),
    )
    status, printed, said = firetwin(capsys, "resources", exercise, *asked)
    assert status == 0
    assert "ignition: 38.7820, -120.6040 (Wikipedia" in said
    for words in (
        "min  ",
        "cost, USD",
        "roads are 1.4 times",
        "12 h of work",
        "source     exercise for King",
    ):
        assert words in printed
    answer = json.loads(firetwin(capsys, "resources", exercise, *asked, "--json")[1])
    assert answer["query"]["types"] == ["1", "2", "3"]
    assert answer["matches"]
    for match in answer["matches"]:
        assert match["resource"]["type"] == "engine/3"
        assert match["resource"]["origin"] == "exercise"
        assert match["minutes"] <= 90
        assert match["distance_km"] <= 60
        assert match["fire"]["state"] == "outside of the run"
    asked += ("--tonnes-per-hour", 9, "--budget", 100000)
    chosen = json.loads(firetwin(capsys, "resources", exercise, *asked, "--json")[1])
    assert chosen["tonnes_per_hour"] >= 9.0
    assert chosen["candidates"] == len(answer["matches"])
    assert chosen["cost"] == pytest.approx(sum(each["cost"] for each in chosen["matches"]))


def test_no_set_is_a_failure_that_says_why(exercise, capsys):
    asked = ("--near", "38.9,-120.6", "--tonnes-per-hour", 20)
    status, printed, said = firetwin(capsys, "resources", exercise, *asked, "--budget", 10)
    assert status == 1
    assert "firetwin: no set: the cheapest set costs" in said
    assert "0 resources of" in printed
    status, _, said = firetwin(capsys, "resources", exercise, *asked[:3], 9999)
    assert status == 1
    assert "together deliver" in said


STATIONS = (
    "name,lat,lon\nSouth,38.9005,-120.592\nMiddle,38.904,-120.592\nNorth,38.9096,-120.592\nFar,39.5,-120.5\n"
)


def test_what_lies_ahead_of_the_fire_and_when(tmp_path, run, capsys):
    (tmp_path / "stations.csv").write_text(STATIONS)
    out = tmp_path / "stations.gpkg"
    firetwin(capsys, "stations", "import", tmp_path / "stations.csv", "--out", out)
    every = json.loads(firetwin(capsys, "resources", out, "--run", run, "--json")[1])
    states = {each["station"]["name"]: each["fire"] for each in every["matches"]}
    assert [states[name]["state"] for name in ("South", "Middle", "North", "Far")] == [
        *("reached", "reached", "not reached", "outside of the run"),
    ]
    assert states["North"]["time"] is None
    opened = runs.open(run)
    wanted = times.iso(times.utc(opened, 10.0 + 10_000.0 * (38.904 - opened.fuel_latitude[0])))
    assert states["Middle"]["time"] == wanted
    assert states["Middle"]["earliest_cell"] <= wanted <= states["Middle"]["latest_cell"]
    later = times.utc(opened, 30.0).isoformat()
    asked = ("resources", out, "--run", run, "--ahead", "--available-at", later)
    status, printed, _ = firetwin(capsys, *asked)
    assert status == 0
    middle, north = (line for line in printed.splitlines() if line.startswith(" ?"))
    assert "Middle" in middle
    assert middle.endswith("PDT")  # without the times of the cells around it
    assert "North" in north
    assert re.search(
        r"within \d+ m at 16 Sep 2014 \d\d:\d\d PDT$", north
    )  # its cell does not burn, but the next cell does
    printed = firetwin(capsys, *asked, "--clearance", "50m")[1]
    for line in ("1 fire: there before that time", "1 fire: not reached", "1 fire: outside of the run"):
        assert f"left out: {line}" in printed


def test_the_head_is_where_the_fire_is_then(exercise, run, capsys):
    opened = runs.open(run)
    at = times.utc(opened, 40.0).isoformat()
    status, _, said = firetwin(
        capsys, "resources", exercise, "--run", run, "--near", "head", "--available-at", at
    )
    assert status == 0
    latitude, longitude = map(float, said.partition("head: ")[2].partition(" (")[0].split(","))
    front = opened.fuel_latitude[0] + 30.0 / 10_000.0
    assert abs(latitude - front) < 0.002
    assert opened.fuel_longitude[0] < longitude < opened.fuel_longitude[-1]
    before = times.utc(opened, -60.0).isoformat()
    status, _, said = firetwin(
        capsys, "resources", exercise, "--run", run, "--near", "head", "--available-at", before
    )
    assert status == 1
    assert "has no fire and therefore no head" in said
    assert _fire.open_fire(run).head(times.utc(opened, -60.0)) is None


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--near", "ignition"], "--near: ignition needs the fire of a run; name it with --run"),
        (["--within", "60km"], "--within: needs a destination"),
        (["--tonnes-per-hour", "2"], "--tonnes-per-hour: needs a destination"),
        (["--ahead"], "--ahead: needs the fire of a run"),
        (["--near", "38.9"], "must be ignition, head, or degrees"),
        (["--near", "98.9,1"], "must be ignition, head, or degrees"),
        (["--within", "60 furlongs"], "must be a length such as 60km"),
        (["--minutes", "0"], "must be a number above 0"),
        (["--type", "3-1"], "goes backwards; write 1-3"),
        (["--mode", "shopping"], "is not one of attack, structure"),
        (["--available-at", "noon"], "must be a time with its zone"),
        (["--kind", ","], "is empty"),
        (["--stations", "--kind", "engine"], "--kind: is a condition on resources"),
    ],
)
def test_mistakes_are_named(exercise, capsys, options, reason):
    status, printed, said = firetwin(capsys, "resources", exercise, *options)
    assert (status, printed) == (2, "")
    assert reason in said


def test_a_head_needs_a_time(exercise, run, capsys):
    status, _, said = firetwin(capsys, "resources", exercise, "--run", run, "--near", "head")
    assert status == 2
    assert "give it with --available-at" in said


def test_a_file_that_is_there_is_kept(exercise, run, capsys):
    assert firetwin(capsys, "stations", "exercise", run, "--out", exercise)[0] == 0  # own and unchanged
    with exercise.open("ab") as file:
        file.write(b"mine")
    before = exercise.read_bytes()
    status, _, said = firetwin(capsys, "stations", "exercise", run, "--out", exercise)
    assert status == 1
    assert "has changed since Firetwin wrote it" in said
    assert exercise.read_bytes() == before
    assert (
        firetwin(capsys, "stations", "exercise", run, "--out", exercise, "--overwrite", "--seed", 1)[0] == 0
    )
    assert exercise.read_bytes() != before
    assert "name a .gpkg file" in firetwin(capsys, "stations", "exercise", run, "--out", "x.db")[2]


def test_a_file_without_any_station_is_not_written(tmp_path, capsys):
    (tmp_path / "stations.csv").write_text("name,lat,lon\nA,,\n")
    status, _, said = firetwin(
        capsys, "stations", "import", tmp_path / "stations.csv", "--out", tmp_path / "p.gpkg"
    )
    assert status == 1
    assert "has no valid station" in said
    assert not (tmp_path / "p.gpkg").exists()


def test_the_former_names_of_the_command_and_of_an_option_are_read_with_a_note(tmp_path, capsys):
    path = tmp_path / "stations.gpkg"
    writing.write(random_stations(1), path)
    status, printed, note = firetwin(capsys, "places", "info", path)
    assert status == 0
    assert printed == firetwin(capsys, "stations", "info", path)[1]
    assert "`firetwin places` is now `firetwin stations`" in note
    brief = ("brief", tmp_path / "none", "--out", tmp_path / "a.html", f"--places={path}")
    assert "`--places` is now `--stations`" in firetwin(capsys, *brief)[2]
