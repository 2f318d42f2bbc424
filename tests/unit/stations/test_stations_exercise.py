"""The exercise: invented, labelled in every row, reproducible, and without real stations."""

import itertools
from datetime import timedelta
from zoneinfo import ZoneInfo

import pytest
from firetwin.data import history
from firetwin.stations import exercise, reading, types, writing
from firetwin.stations.records import EXERCISE, MODES, STAFFING, STATUSES

KING = exercise.make_for_event("king_fire")


def test_every_row_says_that_it_is_an_exercise():
    assert {each.origin for rows in (KING.stations, KING.resources) for each in rows} == {"exercise"}
    assert KING.exercise
    assert {each.note for each in KING.resources} == {exercise.NOTE}
    assert all(each.name.startswith("Exercise ") for rows in (KING.stations, KING.resources) for each in rows)
    (source,) = KING.sources
    assert "invented" in source.name
    assert "data/king_fire.toml" in source.name
    assert "not operational" in EXERCISE


def test_bases_are_the_towns_with_published_positions():
    towns = {each.name: each for each in history.load("king_fire").places if not each.approximate}
    assert {"Georgetown", "Pollock Pines", "Foresthill"} <= {each.source_id for each in KING.stations}
    for base in KING.stations:
        town = towns[base.source_id]
        assert town.kind in ("town", "valley")
        assert (base.latitude, base.longitude) == (town.latitude, town.longitude)
        assert base.kind == "exercise base"
        assert [base.agency, base.address, base.picture] == ["", "", ""]


def test_types_are_the_standards_and_values_are_in_the_closed_lists():
    known = {each.code for each in types.standard_types()}
    assert set(exercise.ASSUMPTIONS) <= known
    assert {each.type for each in KING.resources} == set(exercise.ASSUMPTIONS)
    for each in KING.resources:
        assert each.mode in MODES
        assert each.staffing in STAFFING
        assert min(each.speed_km_h, each.cost_hour, each.cost_day) > 0
        assert each.cost_hour * 24 > each.cost_day  # a day is the cheaper one


def test_windows_cover_13_september_to_9_october_without_gaps():
    zone = ZoneInfo("America/Los_Angeles")
    by_resource = {}
    for window in KING.availability:
        by_resource.setdefault(window.resource, []).append(window)
    assert set(by_resource) == {each.id for each in KING.resources}
    for windows in by_resource.values():
        first, last = windows[0].begins.astimezone(zone), windows[-1].ends.astimezone(zone)
        assert (first.isoformat(), last.isoformat()) == (
            "2014-09-13T06:00:00-07:00",
            "2014-10-10T06:00:00-07:00",
        )
        for one, other in itertools.pairwise(windows):
            assert one.ends == other.begins
            assert one.status != other.status
            assert one.status in STATUSES


def test_what_does_not_work_at_night_is_not_available_then():
    zone, day = ZoneInfo("America/Los_Angeles"), timedelta(days=1)
    crews = {each.id for each in KING.resources if not each.night}
    assert crews
    midnight = history.load("king_fire").ignitions[0].time.astimezone(zone).replace(hour=0, minute=0) + day
    for k in range(20):
        at = midnight + k * day
        awake = {w.resource for w in KING.availability if w.begins <= at < w.ends and w.status == "available"}
        assert awake
        assert not awake & crews


def test_the_same_seed_makes_the_same_bytes_and_another_one_others(tmp_path):
    paths = [tmp_path / f"{k}.gpkg" for k in range(3)]
    for path, seed in zip(paths, (0, 0, 1), strict=True):
        writing.write(exercise.make_for_event("king_fire", seed), path)
    one, other, different = (path.read_bytes() for path in paths)
    assert one == other
    assert one != different
    assert reading.read(paths[0]).stations == KING.stations


@pytest.mark.parametrize(
    ("code", "value", "figure"),
    [
        ("engine/3", "tank_l", 1892.7),
        ("engine/1", "pump_l_min", 3785.4),
        ("airtanker/VLAT", "tank_l", 30283.3),
        ("helicopter/1", "payload_kg", 2268.0),
        ("crew/IHC", "people", 18),
    ],
)
def test_types_have_the_minima_of_pms_200(code, value, figure):
    (found,) = (each for each in types.standard_types() if each.code == code)
    assert getattr(found, value) == pytest.approx(figure, abs=0.05)
    assert "PMS 200" in found.standard


def test_codes_of_the_users_own():
    assert types.user_type("tender/1").kind == "tender"
    assert types.user_type("Engine 3") is None
    assert types.mode_of("engine/2") == "structure"
    assert types.mode_of("boat/1") == "attack"
