"""Blocks of footprints in the scene: on a slope, with holes, with the ground's attributes, and reported."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
from firetwin.run.buildings import ASSUMED, Building, Footprint
from firetwin.scene import build
from firetwin.scene.terrain import buildings, windows
from firetwin.shot.shot import Shot
from firetwin.shot.surface import footprints

HERE = 38.8285, -120.5583


def ring(north, east, high, wide, way=1):
    """A rectangle (5, 2), degrees, from metres north and east of a place."""
    corners = np.array([(0, 0), (wide, 0), (wide, high), (0, high), (0, 0)], float)[::way]
    corners += (east, north)
    return (np.array(HERE[::-1]) + corners / (86_700.0, 111_000.0)).tolist()


def write(path, *polygons):
    found = [
        {"type": "Feature", "properties": about, "geometry": {"type": "Polygon", "coordinates": rings}}
        for rings, about in polygons
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": found}))
    return path


BOW = [[HERE[1] + a, HERE[0] + b] for a, b in ((0, 0), (1e-3, 1e-3), (1e-3, 0), (0, 1e-3), (0, 0))]


@pytest.fixture
def built(near_settings, run, scene, tmp_path, plain_looks):
    """built(polygon, ...): a shot with these footprints, and their mesh."""

    def make(*polygons, key="buildings"):
        path = write(tmp_path / "footprints.geojson", *polygons)
        terrain = replace(near_settings.terrain, **{key: path})
        shot = Shot(replace(near_settings, terrain=terrain), run)
        told = []
        for _ in build.steps(shot, scene, ("terrain",), told.append):
            pass
        return shot, bpy.data.objects["Firetwin Roofs"].data, told

    return make


def values(data, name, width, count, key):
    found = np.empty(width * count, np.float32)
    data.attributes[name].data.foreach_get(key, found)
    return found.reshape(count, width)


def points(data):
    found = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", found)
    return found.reshape(-1, 3).astype(float)


def test_blocks_carry_the_attributes_of_the_ground(built):
    shot, data, _ = built(([ring(0, 0, 60, 80)], {"height": 12}))
    latitude, longitude, height = shot.ground.frame.reverse(points(data))
    count = len(data.vertices)
    assert values(data, "elevation", 1, count, "value")[:, 0] == pytest.approx(height, abs=0.01)
    row, column = shot.ground.indices(latitude, longitude)
    place = values(data, "grid", 3, count, "vector")
    rows, columns = shot.ground.shape
    assert place[:, 0] * columns - 0.5 == pytest.approx(column, abs=0.01)
    assert place[:, 1] * rows - 0.5 == pytest.approx(row, abs=0.01)


def test_what_is_assumed_and_mended_is_told(built):
    pytest.importorskip("shapely", reason="needs shapely")
    shot, data, told = built(([ring(0, 0, 60, 80)], {}), ([BOW], {"height": 4}))
    (sentence,) = [text for text in told if "footprints" in text]
    assert "1 without a height are 5 m high; 1 crossed themselves and were split" in sentence
    assert sorted({each.footprint.height for each in footprints.place_buildings(shot)}) == [4.0, ASSUMED]
    assert set(values(data, "number", 1, len(data.polygons), "value")[:, 0]) == {1.0, 2.0}


def test_the_land_use_map_has_buildings_by_the_same_rule(built):
    about = {"building": "yes", "building:levels": "3"}
    shot, data, told = built(([ring(0, 0, 60, 80)], about), key="land_use")
    (found,) = footprints.place_buildings(shot)
    assert found.footprint.height == pytest.approx(9.6)
    assert not any("footprints" in text for text in told)
    assert len(data.polygons) == 10


def test_the_material_is_charred_with_the_images_of_the_ground(shot, stage):
    plain = buildings.material(shot, stage, "Firetwin Halls")
    from firetwin.scene.terrain import fields

    charred = buildings.material(shot, stage, "Firetwin Roofs", fields.create_images(shot, None))

    def images(look):
        trees = [look.node_tree, *(n.node_tree for n in look.node_tree.nodes if n.type == "GROUP")]
        return {n.image.name for tree in trees for n in tree.nodes if n.type == "TEX_IMAGE" and n.image}

    assert {"Firetwin Ground Fire", "Firetwin Ground Front"} <= images(charred)
    assert "Firetwin Ground Fire" not in images(plain)


def at(settings, hour):
    """Settings of a still at an hour of 18 September 2014 (UTC)."""
    moment = datetime(2014, 9, 18, hour, tzinfo=UTC)
    return replace(settings, time=replace(settings.time, start=moment, end=None, frames=1))


def test_windows_are_lit_by_night_alone_and_where_the_building_has_walls(near_settings, run):
    day, night = (Shot(at(near_settings, hour), run) for hour in (21, 5))
    assert not windows.shines(day)
    assert windows.shines(night)
    assert windows.share(night) == pytest.approx(0.45)
    assert windows.share(Shot(at(near_settings, 10), run)) < 0.15  # 2 a.m.
    outline = np.array([(0.0, 0.0), (40.0, 0.0), (40.0, 20.0), (0.0, 20.0)])
    house = Building(Footprint(outline, (), 9.6), -2.0, 9.6, (20.0, 10.0))
    lit = [windows.lit_windows(house, number, 0.4, 1) for number in range(200)]
    some = [len(faces) for faces, _ in lit]
    assert 0.2 < np.mean(np.array(some) == 0) < 0.4  # some houses are dark
    assert np.mean(some) == pytest.approx(0.4 * 3 * (12 + 5 + 12 + 5), rel=0.15)  # three storeys
    faces, colours = next(each for each in lit if len(each[0]))
    normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    outward = faces.mean(axis=1)[:, :2] - (20.0, 10.0)
    assert (np.einsum("ij,ij->i", normal[:, :2], outward) > 0.0).all()
    assert faces[..., 2].min() > 0.0
    assert faces[..., 2].max() < 9.6
    assert (colours[:, 0] > colours[:, 2]).any()
    assert (colours[:, 0] < colours[:, 2]).any()


def test_lit_windows_are_faces_of_their_building(near_settings, run, scene, tmp_path, plain_looks):
    path = write(
        tmp_path / "footprints.geojson", *([[ring(0, 60 * k, 20, 40)], {"height": 12}] for k in range(9))
    )
    for hour, lit in ((5, True), (21, False)):
        settings = at(near_settings, hour)
        shot = Shot(replace(settings, terrain=replace(settings.terrain, buildings=path)), run)
        for _ in build.steps(shot, scene, ("terrain",), lambda _: None):
            pass
        data = bpy.data.objects["Firetwin Roofs"].data
        assert ("lit" in data.attributes) == lit
    assert set(values(data, "number", 1, len(data.polygons), "value")[:, 0]) == set(range(1, 10))
