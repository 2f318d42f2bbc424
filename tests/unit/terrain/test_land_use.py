"""The user's map of land use: kinds of features, their position, and areas without plants."""

import json

import geopackage_file
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run import opening as runs
from firetwin.run.observations import features
from firetwin.shot.source import ShotSource
from firetwin.shot.surface import land_drawing, land_kinds, land_use
from scene_text import GROUND_ALONE

WEST, SOUTH, EAST, NORTH = -120.596, 38.902, -120.588, 38.908


@pytest.fixture
def make(make_run, tmp_path):
    """make(feature, ...): a shot of the small run with these features of land use."""
    make_run()

    def scene(*found, name="land.geojson"):
        (tmp_path / name).write_text(json.dumps({"type": "FeatureCollection", "features": list(found)}))
        key = f'land_use = "{name}"'
        (tmp_path / "scene.toml").write_text(GROUND_ALONE.format(key=key, near=0.0, apron=3000.0))
        return ShotSource(scene=str(tmp_path / "scene.toml"))

    return scene


def box(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return _feature("Polygon", [ring], properties)


def line(*points, **properties):
    return _feature("LineString", [list(point) for point in points], properties)


def _feature(kind, coordinates, properties):
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": kind, "coordinates": coordinates},
    }


@pytest.mark.parametrize(
    ("properties", "kind"),
    [
        ({"kind": "field"}, "field"),
        ({"building": "yes"}, "building"),
        ({"building": "no", "landuse": "meadow"}, "meadow"),
        ({"highway": "primary"}, "road"),
        ({"highway": "track"}, "track"),
        ({"waterway": "stream"}, "water"),
        ({"natural": "water"}, "water"),
        ({"natural": "peak"}, None),
        ({"landuse": "vineyard"}, "field"),
        ({"landuse": "forest", "plantation": "yes"}, "plantation"),
        ({"barrier": "hedge"}, "hedge"),
        ({"barrier": "wall"}, None),
        ({"landuse": "residential"}, None),
        ({"LANDUSE": "Quarry"}, "bare"),
        ({"kind": "castle", "name": None}, None),
        ({}, None),
    ],
)
def test_what_a_feature_is(properties, kind):
    assert land_kinds.kind_of(properties) == kind


def at(shot, layer, longitude, latitude):
    """Colour and cover of a layer at a place, of the coarsest picture."""
    picture = land_use.pictures(shot)[layer][0]
    place = shot.ground.point(latitude, longitude)[0, :2]
    size = np.array(picture.pixels.shape[1::-1])
    x, y = np.floor((place - picture.low) / (picture.high - picture.low) * size).astype(int)
    return picture.pixels[y, x] / 255.0


def test_each_place_has_what_the_map_says_is_there(make):
    shot = make(
        box(WEST, SOUTH, -120.592, NORTH, landuse="farmland"),
        box(-120.5915, 38.903, -120.5895, 38.905, natural="water"),
        line((WEST, 38.905), (EAST, 38.907), highway="tertiary"),
        box(EAST, 38.9, -120.58, 38.91, landuse="residential"),
    ).shot()
    assert set(land_use.pictures(shot)) == {"soft", "hard", "water"}
    assert at(shot, "soft", -120.594, 38.904)[3] == 1.0
    assert at(shot, "soft", -120.590, 38.904)[3] == 0.0
    assert at(shot, "water", -120.5905, 38.904)[3] == 1.0
    assert at(shot, "hard", -120.592, 38.906)[3] == 1.0  # half-way along the road
    assert at(shot, "hard", -120.592, 38.9052)[3] == 0.0
    road = at(shot, "hard", -120.592, 38.906)[:3]
    assert road == pytest.approx(land_kinds.KINDS["road"].colours[0], abs=0.05)


def test_roads_are_as_wide_as_they_say(make):
    shot = make(line((-120.592, SOUTH), (-120.592, NORTH), highway="track", width="12 m")).shot()
    picture = land_use.pictures(shot)["hard"][0]
    pixel = (picture.high - picture.low)[0] / picture.pixels.shape[1]
    row = picture.pixels[picture.pixels.shape[0] // 2, :, 3] / 255.0
    assert row.sum() * pixel == pytest.approx(12.0, abs=0.5)


def drawn(draw, *arguments):
    """Picture (200 m square, pixels of 0.5 m) of one feature."""
    picture = land_drawing.LandPicture(np.zeros(2), np.full(2, 200.0), np.array([400, 400]))
    draw(picture, *arguments)
    return picture.pixels / 255.0


def test_a_narrow_track_has_two_ruts_and_grass_between():
    line, soil = np.array([[100.0, -10.0], [100.0, 210.0]]), (0.44, 0.38, 0.30)
    row = drawn(land_drawing.draw_track, line, 3.0, soil)[200]
    ruts = np.flatnonzero(np.abs(row[:, :3] - soil).max(axis=1) < 0.02)
    assert ruts.min() < 199 < 200 < ruts.max()
    assert not {199, 200} & set(ruts.tolist())
    assert row[200, 1] >= row[200, 0] - 0.02  # grass; the soil is redder
    assert 0.5 < row[200, 3] < 0.8  # no plant stands there
    assert (row[:, 3] > 0.5).sum() * 0.5 == pytest.approx(3.0, abs=1.0)


def test_a_road_has_shoulders_and_water_a_bank():
    line = np.array([[100.0, -10.0], [100.0, 210.0]])
    road = drawn(land_drawing.draw_road, line, 7.0, (0.27, 0.27, 0.28))[200]
    assert road[200, :3] == pytest.approx((0.27, 0.27, 0.28), abs=0.01)
    assert road[208, 0] > 0.4  # 4 m from the middle
    assert road[214, 3] == 0.0
    bank = drawn(land_drawing.draw_bank, line, 4.0)[200, :, 3]
    assert (bank > 0.0).sum() * 0.5 == pytest.approx(14.0, abs=1.5)


@pytest.mark.parametrize("pattern", ["crop", "ploughed", "stubble", "mown"])
def test_rows_of_a_field_run_along_its_longest_side(pattern):
    ring = np.array([[20.0, 40.0], [180.0, 40.0], [180.0, 160.0], [20.0, 160.0]])
    colour = (0.4, 0.35, 0.2)
    shown = drawn(land_drawing.draw_field, [ring], colour, 1.0, pattern)
    inner = shown[110:290, 70:330, 1]
    assert inner.std(axis=1).max() < 0.01  # along the rows
    assert inner.mean(axis=1).std() > 0.008  # across them
    assert inner.mean() == pytest.approx(colour[1], abs=0.03)
    assert shown[200, 41, :3] == pytest.approx(land_drawing._GRASS, abs=0.08)  # its edge
    assert (shown[..., 3] == 0.0).mean() == pytest.approx(1.0 - 160 * 120 / 40_000, abs=0.01)


def test_hedges_and_plantations_are_known_by_place(make):
    shot = make(
        line((WEST, 38.905), (EAST, 38.905), barrier="hedge", width="4"),
        box(-120.592, SOUTH, -120.590, NORTH, landuse="forest", plantation="yes"),
    ).shot()
    longitude, north = np.full(3, -120.591), shot.ground.point(38.905, -120.591)[0, 1]
    place = shot.ground.point(np.full(3, 38.905), longitude)
    place[:, 1] = north + np.array([0.0, 1.9, 2.1])
    assert land_use.hedges(shot, place).tolist() == [True, True, False]
    assert land_use.planted(shot, place).all()
    assert not land_use.planted(shot, place + np.array([400.0, 0.0, 0.0])).any()
    assert not land_use.keeps_out(shot, place).any()


def test_no_plant_stands_on_water_roads_fields_and_buildings(make):
    shot = make(
        box(WEST, SOUTH, -120.594, NORTH, kind="meadow"),
        box(-120.594, SOUTH, -120.592, NORTH, kind="field"),
        box(-120.592, SOUTH, -120.590, NORTH, kind="water"),
        box(-120.590, SOUTH, EAST, NORTH, building="yes"),
    ).shot()
    longitude = np.array([-120.595, -120.593, -120.591, -120.589, -120.599])
    place = shot.ground.point(np.full(5, 38.905), longitude)
    assert land_use.keeps_out(shot, place).tolist() == [False, True, True, True, False]
    assert land_use.mapped(shot, place).tolist() == [True, True, True, True, False]


def test_without_a_map_there_is_nothing(make_run):
    from firetwin.shot.sections import TerrainSettings
    from firetwin.shot.settings import Settings
    from firetwin.shot.shot import Shot

    shot = Shot(Settings(terrain=TerrainSettings(apron=0.0)), runs.open(make_run()))
    assert land_use.pictures(shot) == {}
    assert not land_use.mapped(shot, np.zeros((3, 3))).any()


@pytest.mark.parametrize(
    ("found", "says"),
    [
        ([box(WEST, SOUTH, EAST, NORTH, natural="peak")], "no polygon or line with .* a kind of meadow"),
        ([box(10.0, 45.0, 10.1, 45.1, kind="field")], "covers 45.000 to 45.100 N.*outside of the run"),
    ],
)
def test_a_map_that_shows_nothing_is_refused(make, found, says):
    with pytest.raises(InputError, match=says):
        _ = make(*found).shot()


def test_another_file_is_refused_by_its_name(make):
    with pytest.raises(InputError, match=r"is no \.geojson or \.gpkg"):
        _ = make(box(WEST, SOUTH, EAST, NORTH, kind="field"), name="land.txt").shot()


def test_lines_of_a_geopackage_are_read(tmp_path):
    path = tmp_path / "roads.gpkg"
    points = np.array([[WEST, SOUTH], [EAST, NORTH]])
    geopackage_file.write(path, ["highway"], roads=[(geopackage_file.line(points), "primary")])
    (found,) = features(path)
    assert land_kinds.kind_of(found.properties) == "road"
    assert np.array_equal(found.lines[0], points)
