"""Signs face the camera and tell an exercise, buildings have their true size, routes lie on the ground."""

import json
from dataclasses import replace

import bpy
import numpy as np
import pytest
import small_stations
from firetwin.blender import owned
from firetwin.render import layers
from firetwin.scene import build
from firetwin.scene.labels import lettering
from firetwin.scene.stations import buildings, routes, signs
from firetwin.shot.sections import StationSettings
from firetwin.shot.shot import Shot
from firetwin.shot.stations import station_signs
from firetwin.stations.records import EXERCISE

NEAR, FAR = (38.840, -120.555), (38.872, -120.545)


@pytest.fixture
def stationed(settings, tmp_path):
    """Settings with two stations, one of an exercise, and one that lies beyond the ground."""
    path = small_stations.write(
        tmp_path / "stations.gpkg",
        [
            (1, "Near Station", *NEAR, "fire station", "fact"),
            (2, "Base Two", *FAR, "exercise base", "exercise"),
            (3, "Elsewhere", 10.0, 20.0, "fire station", "fact"),
        ],
        [(2, "engine/3", 2, 60.0, 5.0, "exercise")],
    )
    return replace(settings, stations=StationSettings(enabled=True, file=path, size=0.1))


def shown(name):
    graph = bpy.context.evaluated_depsgraph_get()
    graph.update()
    wanted = bpy.data.objects[name]
    return [
        (i.matrix_world.copy(), i.object.data.name)
        for i in graph.object_instances
        if i.is_instance and i.parent.original == wanted
    ]


def test_signs_face_the_camera_keep_their_size_and_have_two_forms(stationed, run, scene):
    far = replace(stationed, stations=replace(stationed.stations, detail=3000.0))
    shot = Shot(far, run)
    build.build(shot, scene, ("cameras", "stations"))
    signs = shown("Firetwin Signs")
    wanted = shot.ground.point(*zip(NEAR, FAR, strict=True))
    eye = np.array(scene.camera.matrix_world.translation)
    turned = np.array(scene.camera.matrix_world.to_3x3())
    wide = 2.0 * shot.paths[0].half[0]
    assert len(signs) == 2
    for (matrix, _), place in zip(signs, wanted, strict=True):
        scale = matrix.to_scale()[0]
        assert np.array(matrix.translation) == pytest.approx(place, abs=0.01)
        assert np.array(matrix.to_3x3()) / scale == pytest.approx(turned, abs=1e-3)
        assert scale == pytest.approx(0.1 * wide * 36 / 64 * np.linalg.norm(place - eye), rel=1e-3)
    away = np.linalg.norm(wanted - eye, axis=1)
    assert list(away < 3000.0) == [True, False]
    assert [name for _, name in signs] == ["Firetwin Sign 00000", "Firetwin Sign 00003"]
    build.build(
        Shot(replace(far, stations=replace(far.stations, distance=3000.0)), run), scene, ("stations",)
    )
    assert len(shown("Firetwin Signs")) == 1


def test_a_plate_leaves_out_its_last_lines_but_not_the_exercise():
    lines = [("Base", False), ("exercise base", False), ("3 engines", False), (EXERCISE, True)]
    assert signs.fitting(lines, 0.62, 10.0) == lines
    assert signs.fitting(lines, 0.62, 3.7) == [lines[0], lines[1], lines[3]]
    assert signs.fitting(lines, 1.0, 1.0) == [lines[0], lines[3]]


@pytest.mark.parametrize(("rows", "pixels"), [(2160, 64.8), (1080, 32.4), (360, 17.6), (54, 5.4)])
def test_capitals_are_legible_in_pictures_of_any_size(stationed, run, rows, pixels):
    picture = replace(stationed.render, resolution=(2 * rows, rows))
    size = lettering.legible_size(Shot(replace(stationed, render=picture), run), 0.03)
    assert size * rows == pytest.approx(pixels, abs=0.1)


def test_every_form_of_an_exercise_says_so(stationed, run):
    near, base = station_signs.make_signs(Shot(stationed, run))
    assert signs.full(base)[-1] == (EXERCISE, True)
    assert signs.short(base)[-1] == ("Exercise", True)
    assert not any("xercise" in text for text, _ in signs.full(near) + signs.short(near))


def test_a_station_without_an_outline_is_a_hall_of_true_size(stationed, run, scene):
    one = replace(stationed, stations=replace(stationed.stations, signs=False))
    build.build(Shot(one, run), scene, ("stations",))
    data = bpy.data.objects["Firetwin Halls"].data
    points = np.array([v.co[:] for v in data.vertices])[:24]  # the corners of the walls' triangles
    east, north = np.ptp(points[:, 0]), np.ptp(points[:, 1])
    assert (east, north) == pytest.approx((buildings._LONG, buildings._WIDE), abs=0.01)
    assert "Firetwin Signs" not in bpy.data.objects
    assert bpy.data.objects["Firetwin Halls"].users_collection[0].name == "Firetwin Buildings"


def test_an_outline_gives_a_building_its_shape(stationed, run, scene, tmp_path):
    side = 20.0 / 111_000.0
    square = [(NEAR[1], NEAR[0]), (NEAR[1], NEAR[0] + side), (NEAR[1] + side, NEAR[0] + side)]
    shape = {"type": "Polygon", "coordinates": [[*square, square[0]]]}  # clockwise
    (tmp_path / "outlines.geojson").write_text(
        json.dumps({"type": "Feature", "properties": {}, "geometry": shape})
    )
    outlined = replace(stationed.stations, footprints=tmp_path / "outlines.geojson")
    shot = Shot(replace(stationed, stations=outlined), run)
    near, base = station_signs.make_signs(shot)
    assert (len(near.footprint), base.footprint) == (3, None)
    build.build(shot, scene, ("stations",))
    data = bpy.data.objects["Firetwin Halls"].data
    ring = shot.ground.point([b for _, b in square], [a for a, _ in square])
    corners = np.array([v.co[:] for v in data.vertices])
    starts = corners[:18:6, :2]  # six corners a wall
    assert starts == pytest.approx(ring[::-1, :2], abs=0.01)
    ground, middle = shot.ground.up(*ring[:, :2].T), ring[:, :2].mean(axis=0)
    above = shot.ground.up(*middle)[0] + buildings._HIGH
    assert corners[:, 2].max() == pytest.approx(max(above, ground.max() + 1.0), abs=0.05)
    assert corners[:, 2].min() < ground.min() - 1.9
    walls = [p for p in data.polygons if abs(p.normal.z) < 0.5][:6]
    assert all(np.dot(np.array(p.center[:2]) - middle, p.normal[:2]) > 0.0 for p in walls)  # outwards


def test_routes_lie_on_the_ground_as_wide_in_every_picture(stationed, run, scene):
    routed = replace(stationed, stations=replace(stationed.stations, routes=True, route_width=0.02))
    shot = Shot(routed, run)
    build.build(shot, scene, ("cameras", "stations"))
    obj = bpy.data.objects["Firetwin Routes"]
    line = routes.drape_line(shot, station_signs.make_routes(shot, station_signs.make_signs(shot))[0].line)
    assert np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1).max() < 30.01
    assert line[0] == pytest.approx(shot.ground.point(*NEAR)[0], abs=0.01)
    assert line[-1] == pytest.approx(shot.ground.point(*station_signs.ignition_point(shot))[0], abs=0.01)
    scene.view_layers[0].update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    corners = np.array([v.co[:] for v in mesh.vertices[:4]])
    eye = np.array(scene.camera.matrix_world.translation)
    picture = 2.0 * shot.paths[0].half[0] * 36 / 64 * np.linalg.norm(line[0] - eye)
    assert np.linalg.norm(corners[0] - corners[2]) == pytest.approx(0.02 * picture, rel=1e-3)
    assert corners[3, 2] > line[0, 2]  # the lowest side
    assert {p.material_index for p in mesh.polygons} == {0, 1}


def test_off_by_default(settings, run, scene):
    build.build(Shot(settings, run), scene, ("cameras", "stations", "labels"))
    assert [thing.type for thing in bpy.data.objects] == ["CAMERA"]


def test_eyes_alone_see_signs_and_every_pass_sees_buildings(stationed, run, scene, stage, plain_looks):
    shot = Shot(stationed, run)
    build.build(shot, scene)
    layers.build(shot.settings, stage)
    seen = {}
    for layer in scene.view_layers:
        (root,) = [each for each in layer.layer_collection.children if owned.is_ours(each.collection, "root")]
        parts = {str(each.collection[owned.MARK]): not each.exclude for each in root.children}
        seen[layer.name] = parts["Stations"], parts["Buildings"]
    assert len(seen) > 1
    assert all(walls for _, walls in seen.values())
    assert {signs for signs, _ in seen.values()} == {True, False}
    assert seen["rgb"][0]
