"""Signs and routes of stations: their content, the mark of an exercise, and messages on wrong files."""

import json
from dataclasses import replace

import numpy as np
import pytest
import small_stations
from firetwin import limits
from firetwin.errors import InputError
from firetwin.run import opening as runs
from firetwin.run import times
from firetwin.shot.sections import LabelSettings, StationSettings
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.shot.stations import labels, station_signs
from firetwin.stations import describe, fire_arrival
from firetwin.stations.records import EXERCISE, Station

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
        file = small_stations.write(tmp_path / "stations.gpkg", ROWS, resources)
        settings = replace(scene_file.read(path), stations=StationSettings(enabled=True, file=file, **more))
        return Shot(settings, runs.open(run))

    return make


def test_signs_have_name_kind_resources_minutes_and_origin(shot_of):
    shot = shot_of()
    fact, base = station_signs.make_signs(shot)  # one lies beyond the ground
    assert (fact.name, fact.origin, fact.lines) == ("Fact Station", "fact", ("fire station", "1 x engine/6"))
    far = np.hypot(
        *(shot.ground.point(38.906, -120.59) - shot.ground.point(*station_signs.ignition_point(shot)))[0, :2]
    )
    least = 5.0 + 1.4 * far / 1000.0
    assert base.lines == (
        "exercise base",
        "2 x engine/3, 1 x helicopter/2",
        f"{least:.0f} min to the ignition",
        EXERCISE,
    )


def test_a_sign_says_when_the_fire_reaches_it_where_that_is_asked_for(shot_of):
    shot = shot_of(show=("fire",))
    fact, base = station_signs.make_signs(shot)
    found = fire_arrival.sample(shot.run, [fact.latitude, base.latitude], [fact.longitude, base.longitude])
    assert found.state.tolist() == [fire_arrival.REACHED, fire_arrival.NOT_REACHED]
    assert fact.lines == (f"fire: {times.text(found.utc(shot.run, 0)[0], shot.settings.time.zone)}",)
    assert base.lines[0].startswith(("fire: within ", "fire: not reached, nearest fire "))
    assert base.lines[1:] == (EXERCISE,)


def test_what_an_exercise_adds_to_a_fact_is_an_exercise(shot_of, tmp_path):
    invented = [(1, "engine/3", 1, None, None, "exercise")]
    for show, origin in ((("kind", "resources"), "exercise"), (("kind",), "fact")):
        fact = station_signs.make_signs(shot_of(invented, show=show))[0]
        assert fact.origin == origin
        assert (EXERCISE in fact.lines) == (origin == "exercise")


def test_a_sign_sums_up_resources_and_has_a_short_name(shot_of):
    many = [small_stations.resource(k, 1, f"engine/{k}", k) for k in range(1, 6)]
    assert describe.count_types(many, 3) == "5 x engine/5, 4 x engine/4, 3 x engine/3 and 2 more types"
    shot = shot_of()
    at = shot.settings.stations.file
    names = ["A " * 99, " \n"]
    small_stations.put(at, [Station(k, name, *ROWS[0][2:4], "fact", 1) for k, name in enumerate(names, 1)])
    first, second = station_signs.make_signs(shot)
    assert (len(first.name), second.name) == (80, "station 2")


def test_routes_are_straight_lines_or_the_users(shot_of, tmp_path):
    assert not station_signs.make_routes(shot_of(), [])
    shot = shot_of(routes=True)
    found = station_signs.make_routes(shot, station_signs.make_signs(shot))
    assert [route.origin for route in found] == ["fact", "exercise"]
    latitude, longitude = station_signs.ignition_point(shot)
    assert all(np.array_equal(route.line[-1], (longitude, latitude)) for route in found)
    line = {"type": "LineString", "coordinates": [[-120.6, 38.9], [-120.59, 38.905], [-120.588, 38.906]]}
    feature = {"type": "Feature", "properties": {"origin": "exercise"}, "geometry": line}
    (tmp_path / "routes.geojson").write_text(json.dumps(feature))
    own = replace(shot.settings.stations, routes_file=tmp_path / "routes.geojson")
    (route,) = station_signs.make_routes(Shot(replace(shot.settings, stations=own), shot.run), [])
    assert (len(route.line), route.origin) == (3, "exercise")


def test_too_many_routes_are_refused_with_their_number(shot_of, tmp_path, monkeypatch):
    path = tmp_path / "routes.geojson"
    shot = shot_of()
    own = replace(shot.settings, stations=replace(shot.settings.stations, routes_file=path))
    line = [[-120.6, 38.9], [-120.6, 39.9]]
    path.write_text(json.dumps({"type": "MultiLineString", "coordinates": [line, line, line]}))
    routes = station_signs.make_routes(Shot(own, shot.run), [])
    assert len(routes) == 3
    for name, most, words in (
        ("ROUTES", 2, "3 lines"),
        ("ROUTE_CORNERS", 5, "6 corners"),
        ("ROUTE_KM", 300, "33[1-4] km"),
    ):
        with monkeypatch.context() as few:
            few.setattr(limits, name, most)
            for call in (
                station_signs.check,
                lambda settings, run: station_signs.make_routes(Shot(settings, run), []),
            ):
                with pytest.raises(InputError, match=rf"routes.geojson: has {words}.*; at most {most} are"):
                    call(own, shot.run)
    path.write_text(json.dumps({"type": "Point", "coordinates": line[0]}))
    with pytest.raises(InputError, match="has no lines; draw routes"):
        station_signs.check(own, shot.run)


def test_files_are_inputs_of_pictures_only_where_stations_are_on(shot_of):
    settings = shot_of().settings
    assert set(station_signs.inputs(settings)) == {"stations"}
    assert not station_signs.inputs(replace(settings, stations=replace(settings.stations, enabled=False)))


def test_stations_without_a_file_are_an_error_that_names_the_key(shot_of):
    settings = shot_of().settings
    settings.path.write_text('run = "run"\n[stations]\nenabled = true\n')
    with pytest.raises(InputError, match=r"scene\.toml:3:\d+: stations\.enabled needs stations\.file"):
        station_signs.check(scene_file.read(settings.path), None)
    station_signs.check(settings, shot_of().run)


def test_too_many_stations_labels_and_corners_are_refused_with_their_number(shot_of, tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "SIGNS", 1)
    crowded = shot_of()
    checked = lambda: station_signs.check(crowded.settings, crowded.run)  # noqa: E731
    for call in (checked, lambda: station_signs.make_signs(crowded)):
        with pytest.raises(InputError, match=r"stations.gpkg: has 2 stations in the scene; at most 1 are"):
            call()
    monkeypatch.undo()
    path = tmp_path / "labels.csv"
    rows = "".join(f"Place {k},38.903,-120.592\n" for k in range(5000))
    path.write_text(f"name,latitude,longitude\n{rows}Far,10,20\n")
    shot = shot_of()
    listed = replace(shot.settings, labels=LabelSettings(enabled=True, file=path))
    for call in (lambda: labels.check(listed, shot.run), lambda: labels.find(Shot(listed, shot.run))):
        with pytest.raises(InputError, match=r"labels.csv: has 5,000 labels in the scene; at most 500"):
            call()
    angle = np.linspace(0.0, 2.0 * np.pi, 5001)[:, None]
    ring = (np.array([-120.592, 38.903]) + 1e-4 * np.hstack([np.cos(angle), np.sin(angle)])).tolist()
    shape = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
    (tmp_path / "houses.geojson").write_text(json.dumps(shape))
    with pytest.raises(InputError, match=r"has a footprint of 5,0\d\d corners; simplify it to at most 5,000"):
        station_signs.check(shot_of(footprints=tmp_path / "houses.geojson").settings, crowded.run)


def test_the_nearest_footprint_is_found_among_many():
    """By brute force over all corners; some lie across the date line."""
    rng = np.random.default_rng(5)
    squares = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 2e-4
    centres = np.column_stack([rng.uniform(179.99, 180.01, 300), rng.uniform(38.99, 39.01, 300)])
    outlines = [centre + squares - np.array([360.0 * (centre[0] > 180.0), 0.0]) for centre in centres]
    boxes = station_signs.bounds(outlines)
    for longitude, latitude in rng.uniform((179.99, 38.99), (180.01, 39.01), (50, 2)):
        far = [
            np.hypot((ring[:, 0] % 360.0 - longitude) * 86_500.0, (ring[:, 1] - latitude) * 111_000.0).min()
            for ring in outlines
        ]
        found = station_signs.nearest_outline(outlines, boxes, latitude, longitude)
        assert (found is None) == (min(far) > 120.0) or abs(min(far) - 120.0) < 1.0
        if found is not None and sorted(far)[1] - min(far) > 1.0:
            assert found is outlines[int(np.argmin(far))]
