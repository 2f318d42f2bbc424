"""What signs and routes of stations show, how an exercise is told, and what is said of wrong files."""

import json
from dataclasses import replace

import numpy as np
import pytest
import stations
from firetwin.errors import InputError
from firetwin.shot import places, stations_file
from firetwin.shot.settings import scene_file
from firetwin.shot.settings.settings import StationSettings
from firetwin.shot.shot import Shot
from firetwin.shot.stations_file import Resource
from firetwin_core import run as runs

ROWS = [
    (1, "Fact Station", 38.9030, -120.5920, "fire station", "fact"),
    (2, "Base Two", 38.9060, -120.5900, "exercise base", "exercise"),
    (3, "Elsewhere", 10.0, 20.0, "fire station", "fact"),
]
RESOURCES = [
    (2, "engine/3", 2, 60.0, 5.0, "exercise"),
    (2, "helicopter/2", 1, 200.0, 30.0, "exercise"),
    (1, "engine/6", 1, None, None, "fact"),
]


@pytest.fixture
def shot_of(make_run, tmp_path):
    """A shot of the small run with stations: shot_of(resources, **settings)."""
    run, path = make_run(), tmp_path / "scene.toml"
    path.write_text('run = "run"\n[time]\nframes = 2\n')

    def make(resources=RESOURCES, **more):
        file = stations.write(tmp_path / "stations.gpkg", ROWS, resources)
        settings = replace(scene_file.read(path), stations=StationSettings(enabled=True, file=file, **more))
        return Shot(settings, runs.open(run))

    return make


def test_signs_have_name_kind_resources_minutes_and_origin(shot_of):
    shot = shot_of()
    fact, base = places.signs(shot)  # one lies beyond the ground
    assert (fact.name, fact.origin, fact.lines) == ("Fact Station", "fact", ("fire station", "1 x engine/6"))
    far = np.hypot(*(shot.ground.point(38.906, -120.59) - shot.ground.point(*places.ignition(shot)))[0, :2])
    least = 5.0 + 1.4 * far / 1000.0
    assert base.lines == (
        "exercise base",
        "2 x engine/3, 1 x helicopter/2",
        f"{least:.0f} min to the ignition",
        places.EXERCISE,
    )


def test_what_an_exercise_adds_to_a_fact_is_an_exercise(shot_of, tmp_path):
    (tmp_path / "stations.gpkg").unlink(missing_ok=True)
    invented = [(1, "engine/3", 1, None, None, "exercise")]
    for show, origin in ((("kind", "resources"), "exercise"), (("kind",), "fact")):
        (tmp_path / "stations.gpkg").unlink(missing_ok=True)
        fact = places.signs(shot_of(invented, show=show))[0]
        assert fact.origin == origin
        assert (places.EXERCISE in fact.lines) == (origin == "exercise")


def test_air_goes_straight_and_the_ground_by_roads():
    station = stations_file.Station(1, "A", 39.0, -120.5, "fact", "")
    to = (39.0 + 10.0 / 111.02, -120.5)  # 10 km to the north
    ground, air = (Resource(1, type_, 1, 60.0, 3.0, "fact") for type_ in ("engine/3", "helicopter/1"))
    assert places.minutes(station, [ground], to) == pytest.approx(3.0 + 14.0, abs=0.05)
    assert places.minutes(station, [ground, air], to) == pytest.approx(3.0 + 10.0, abs=0.05)
    assert places.minutes(station, [replace(ground, speed_km_h=None)], to) is None
    many = [Resource(1, f"engine/{k}", k, None, None, "fact") for k in range(1, 6)]
    assert places.summary(many) == "5 x engine/5, 4 x engine/4, 3 x engine/3 and 2 more types"


def test_routes_are_straight_lines_or_the_users(shot_of, tmp_path):
    assert not places.routes(shot_of(), [])
    (tmp_path / "stations.gpkg").unlink()
    shot = shot_of(routes=True)
    found = places.routes(shot, places.signs(shot))
    assert [route.origin for route in found] == ["fact", "exercise"]
    latitude, longitude = places.ignition(shot)
    assert all(np.array_equal(route.line[-1], (longitude, latitude)) for route in found)
    line = {"type": "LineString", "coordinates": [[-120.6, 38.9], [-120.59, 38.905], [-120.588, 38.906]]}
    feature = {"type": "Feature", "properties": {"origin": "exercise"}, "geometry": line}
    (tmp_path / "routes.geojson").write_text(json.dumps(feature))
    own = replace(shot.settings.stations, routes_file=tmp_path / "routes.geojson")
    (route,) = places.routes(Shot(replace(shot.settings, stations=own), shot.run), [])
    assert (len(route.line), route.origin) == (3, "exercise")


def test_files_are_inputs_of_pictures_only_where_stations_are_on(shot_of):
    settings = shot_of().settings
    assert set(places.inputs(settings)) == {"stations"}
    assert not places.inputs(replace(settings, stations=replace(settings.stations, enabled=False)))


@pytest.mark.parametrize(
    ("rows", "resources", "reason"),
    [
        ([(1, "A", 38.9, -120.6, "x", "rumour")], [], 'origin is "rumour"; it is fact, exercise, user'),
        ([(1, "", 38.9, -120.6, "x", "fact")], [], "a name has 1 to 80 letters, not 0"),
        (ROWS, [(1, "engine/3", 1, 0.0, 1.0, "fact")], "row 1 of resource has a value"),
        (ROWS, [(1, "engine/3", "many", 9.0, 1.0, "fact")], "row 1 of resource has a value"),
    ],
)
def test_one_clear_error(tmp_path, rows, resources, reason):
    path = stations.write(tmp_path / "stations.gpkg", rows, resources)
    with pytest.raises(InputError, match=reason) as caught:
        stations_file.read(path)
    assert str(path) in str(caught.value)


def test_stations_without_a_file_are_an_error_that_names_the_key(shot_of):
    settings = shot_of().settings
    settings.path.write_text('run = "run"\n[stations]\nenabled = true\n')
    with pytest.raises(InputError, match=r"scene\.toml:3:\d+: stations\.enabled needs stations\.file"):
        places.check(scene_file.read(settings.path))
    places.check(settings)


def test_another_file_is_told(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        stations_file.read(tmp_path / "nowhere.gpkg")
    (tmp_path / "text.gpkg").write_text("no database")
    with pytest.raises(InputError, match="no GeoPackage"):
        stations_file.read(tmp_path / "text.gpkg")
