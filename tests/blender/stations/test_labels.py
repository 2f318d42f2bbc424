"""Labels face the camera, are as large in every picture, fade, and are in the visible picture alone."""

from dataclasses import replace
from datetime import UTC, datetime

import bpy
import numpy as np
import pytest
from firetwin.run import labels as run_labels
from firetwin.scene import build
from firetwin.shot.sections import LabelSettings
from firetwin.shot.shot import Shot


@pytest.fixture
def labelled(settings, tmp_path):
    path = tmp_path / "places.csv"
    path.write_text(
        "name,latitude,longitude\nNear,38.840,-120.555\nFar,38.872,-120.545\nElsewhere,10.0,20.0\n"
    )
    return replace(settings, labels=LabelSettings(enabled=True, file=path, size=0.1))


def instances():
    graph = bpy.context.evaluated_depsgraph_get()
    graph.update()
    return [i.matrix_world.copy() for i in graph.object_instances if i.is_instance]


def test_labels_stand_on_their_places_and_face_the_camera(labelled, run, scene):
    shot = Shot(labelled, run)
    build.build(shot, scene, ("cameras", "labels"))
    matrices = instances()
    wanted = shot.ground.point([38.840, 38.872], [-120.555, -120.545])  # one lies beyond the ground
    assert np.array([m.translation[:] for m in matrices]) == pytest.approx(wanted, abs=0.01)
    eye = np.array(scene.camera.matrix_world.translation)
    turned = np.array(scene.camera.matrix_world.to_3x3())
    wide = 2.0 * shot.paths[0].half[0]
    for matrix, place in zip(matrices, wanted, strict=True):
        scale = matrix.to_scale()[0]
        assert np.array(matrix.to_3x3()) / scale == pytest.approx(turned, abs=1e-3)
        assert scale == pytest.approx(0.1 * wide * 36 / 64 * np.linalg.norm(place - eye), rel=1e-3)


def test_labels_beyond_their_distance_are_gone(labelled, run, scene):
    near = replace(labelled, labels=replace(labelled.labels, distance=3000.0))
    shot = Shot(near, run)
    build.build(shot, scene, ("cameras", "labels"))
    eye = np.array(scene.camera.matrix_world.translation)
    away = np.linalg.norm(shot.ground.point([38.840, 38.872], [-120.555, -120.545]) - eye, axis=1)
    assert list(away < 3000.0) == [True, False]
    assert len(instances()) == 1
    build.remove(scene)
    assert not [font for font in bpy.data.fonts if font.users]  # the typeface was lent


@pytest.mark.parametrize(("hour", "lit"), [(5, True), (21, False)])
def test_labelled_towns_have_lights_by_night(settings, run, scene, monkeypatch, hour, lit):
    places = [
        run_labels.Label("Near", 38.840, -120.555, "town"),
        run_labels.Label("Top", 38.842, -120.55, "summit"),
    ]
    monkeypatch.setattr(run_labels, "known", lambda _: places)
    time = replace(settings.time, start=datetime(2014, 9, 18, hour, tzinfo=UTC), end=None, frames=1)
    shot = Shot(replace(settings, time=time, labels=LabelSettings(enabled=True)), run)
    build.build(shot, scene, ("cameras", "labels"))
    lights = bpy.data.objects.get("Firetwin Town Lights")
    assert (lights is not None) == lit
    if lights is not None:
        corners = np.array([vertex.co[:2] for vertex in lights.data.vertices])
        assert corners.mean(axis=0) == pytest.approx(
            shot.ground.point([38.840], [-120.555])[0, :2], abs=150.0
        )
        assert not lights.visible_shadow
