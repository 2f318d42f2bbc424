"""Station list: stations with a resource that a search finds; the map shows fire and dots."""

from dataclasses import replace

import numpy as np
import pytest
from exercise_stations import STATION_FILE
from firetwin.stations import ignition, listing, picture, search
from firetwin.stations.query import Query
from firetwin.stations.records import EXERCISE
from firetwin.stations.station_file import StationFile
from random_stations import CENTRE, NOON, random_stations

QUERIES = (
    Query(near=CENTRE, minutes=60.0),
    Query(near=CENTRE, kinds=("engine",), types=("1", "2", "3")),
    Query(near=CENTRE, within_km=40.0, at=NOON),
    Query(modes=("drop", "line")),
)


@pytest.mark.parametrize("query", QUERIES)
def test_stations_are_those_of_the_resources_that_a_search_finds(query):
    listed = 0
    for seed in range(20):
        station_file = random_stations(seed, resources=20)
        matches = search.find(station_file, query)
        rows = listing.survey(station_file, query).rows
        assert [row.station for row in rows] == list(dict.fromkeys(each.station for each in matches))
        for row in rows:
            own = [each for each in matches if each.station == row.station]
            assert row.distance_km == own[0].distance_km
            assert row.minutes == min((e.minutes for e in own if e.minutes is not None), default=None)
        listed += len(rows)
    assert listed > 20


def test_without_a_condition_on_resources_every_station_is_listed():
    query = Query(near=(38.84, -120.55))
    rows = {row.station.name: row for row in listing.survey(STATION_FILE, query).rows}
    assert list(rows) == ["Near Station", "Base Two", "Beyond"]  # by distance
    assert rows["Near Station"].minutes is None
    first = min(e.minutes for e in search.find(STATION_FILE, query) if e.station.name == "Base Two")
    assert rows["Base Two"].minutes == first
    assert [rows[name].exercise for name in rows] == [False, True, True]
    near = listing.survey(STATION_FILE, replace(query, within_km=2.0))
    assert [row.station.name for row in near.rows] == ["Near Station"]
    assert near.left_out == {"farther than 2 km": 2}
    bare = StationFile(STATION_FILE.stations, (), (), STATION_FILE.sources, STATION_FILE.types)
    assert len(listing.survey(bare, Query(kinds=("engine",))).rows) == 3  # a file of stations alone


def test_a_station_is_found_by_number_and_name_or_by_its_only_name():
    near, base, _ = STATION_FILE.stations
    assert listing.find(STATION_FILE.stations, listing.station_key(base)) is base
    moved = [replace(near, id=9), base]
    assert listing.find(moved, "1 Near Station") is moved[0]
    assert listing.find([replace(near, id=8), *moved], "1 Near Station") is None
    assert listing.find(STATION_FILE.stations, "") is None


def test_facts_of_a_station_name_its_source_and_tell_an_exercise():
    near, base, _ = (dict(listing.facts(STATION_FILE, each)) for each in STATION_FILE.stations)
    assert near["Source"] == "Made up list, public domain, 2026-11-01"
    assert (near["Origin"], near["Resources"]) == ("fact", "unknown")
    assert "" not in near
    assert base["Resources"] == "1 x engine/3, 1 x dozer/2"
    assert base[""] == EXERCISE


@pytest.fixture(scope="module")
def field():
    """A slope up to the east, and a fire that runs north a row in a minute, but not in the last column."""
    arrival = np.repeat(60.0 * np.arange(50.0)[:, None], 40, axis=1)
    arrival[:, -1] = np.nan
    return picture.RunTerrain(
        np.linspace(38.8, 38.9, 50),
        np.linspace(-120.6, -120.5, 40),
        np.tile(np.arange(40.0), (50, 1)),
        arrival,
    )


def test_the_map_shows_what_has_burned(field):
    plan = picture.prepare_map(field, [], [])

    def share(time, colour):
        seen = picture.draw(plan, time, [], [], [], None)[..., :3]
        near = np.abs(seen - plan.ground - 0.85 * (np.array(colour) - plan.ground)).max(axis=-1) < 1e-3
        return near[np.isfinite(plan.arrival)].mean()

    assert share(-1.0, picture._FIRE) == 0.0
    assert share(1470.0, picture._FIRE) == pytest.approx(0.5, abs=0.02)
    assert share(2940.0, picture._FIRE) == pytest.approx(0.61, abs=0.03)
    assert share(2940.0, picture._BURNED) == pytest.approx(0.39, abs=0.03)


def test_the_map_is_true_to_scale_and_in_the_order_of_the_sky(field):
    plan = picture.prepare_map(field, [], [])
    row, column = plan.pixels([38.8, 38.9, 38.9], [-120.6, -120.6, -120.5])
    assert row[1] > row[0]
    assert column[2] > column[1]
    high, wide = row[1] - row[0], column[2] - column[1]
    assert wide / high == pytest.approx(np.cos(np.radians(38.85)), abs=0.004)
    turned = replace(field, latitude=field.latitude[::-1], elevation=field.elevation[::-1])
    turned = replace(turned, arrival=field.arrival[::-1])
    same = picture.prepare_map(turned, [], [])
    np.testing.assert_allclose(same.ground, plan.ground, atol=1e-6)
    assert np.nanmax(np.abs(same.arrival - plan.arrival)) == 60.0 * 0  # rows are the same ones


def test_a_slope_that_faces_the_light_is_brighter():
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    lit, flat, dark = (picture.shade(s * (x - y), (1.0, 1.0))[4, 4] for s in (0.2, 0.0, -0.2))
    assert lit > flat > dark


def test_the_selected_station_has_a_ring(field):
    y, x = [38.82, 38.87], [-120.57, -120.53]
    plan = picture.prepare_map(field, y, x)
    row, column = (np.rint(each).astype(int) for each in plan.pixels(y, x))
    plain, ringed = (picture.draw(plan, 0.0, y, x, ["fact", "user"], k) for k in (None, 1))
    changed = np.argwhere(np.abs(plain - ringed).max(axis=-1) > 0.01)
    far = np.hypot(changed[:, 0] - row[1], changed[:, 1] - column[1])
    assert 6.0 < far.min() < 9.0
    assert 11.0 < far.max() < 14.0
    assert plain[row[0], column[0], :3] == pytest.approx(picture.COLOURS["fact"])


def test_the_nearest_station_of_a_point_of_the_map(field):
    y, x = [38.82, 38.87], [-120.57, -120.53]
    plan = picture.prepare_map(field, y, x)
    row, column = plan.pixels(y, x)
    for k in range(2):
        assert plan.nearest(y, x, ((row[k] + 3) / 512, (column[k] - 3) / 512)) == k
    assert plan.nearest([], [], (0.5, 0.5)) is None


def test_stations_far_from_the_run_are_not_on_the_map(field):
    near = picture.prepare_map(field, [38.95], [-120.55])
    assert near.north > 38.95
    far = picture.prepare_map(field, [48.0], [-120.55])
    assert far.north < 39.0
    assert picture.draw(far, 0.0, [48.0], [-120.55], ["fact"], 0).shape == (512, 512, 4)
    assert picture.prepare_map(None, [], []) is None
    assert picture.prepare_map(None, [38.8], [-120.5]).north > 38.8


def test_a_run_of_no_known_fire_begins_at_its_first_cells(monkeypatch):
    monkeypatch.setattr(ignition.fire_arrival, "first_burned_point", lambda run: (1.0, 2.0))
    nothing = type("Run", (), {"event": ""})()
    assert ignition.find(nothing) == ((1.0, 2.0), "the run's first cells")
