"""Live labels: one mesh at the places of the film's labels and signs, which it replaces in 3D views."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
import small_stations
from firetwin.blender import owned
from firetwin.scene import build
from firetwin.scene.live import labels, switch
from firetwin.shot.sections import LabelSettings, StationSettings
from firetwin.shot.shot import Shot


@pytest.fixture
def labelled(settings, tmp_path):
    path = tmp_path / "places.csv"
    path.write_text("name,latitude,longitude\nNear,38.840,-120.555\nFar,38.872,-120.545\n")
    return replace(settings, labels=LabelSettings(enabled=True, file=path, size=0.1, distance=9000.0))


def values(data, name, width):
    found = np.empty(width * len(data.vertices), np.float32)
    data.attributes[name].data.foreach_get("color" if width == 4 else "vector", found)
    return found.reshape(-1, width)


def test_letters_are_at_their_places_and_have_sizes_and_distances(labelled, run, scene):
    shot, stage = Shot(labelled, run), owned.stage(scene)
    data = labels.build(shot, stage, stage.part("Live")).data
    wanted = shot.ground.point([38.840, 38.872], [-120.555, -120.545])
    assert np.unique(values(data, "place", 3), axis=0) == pytest.approx(np.unique(wanted, axis=0), abs=0.01)
    seen = np.unique(values(data, "seen", 3), axis=0)
    assert seen == pytest.approx(np.array([[0.072, 0.0, 9000.0]]))
    letter = values(data, "letter", 3)
    assert letter[:, 1].min() == 0.0  # stems begin on the ground
    assert 0.3 < np.median(letter[:, 1]) / letter[:, 1].max() <= 1.0
    inks = {tuple(ink) for ink in values(data, "ink", 4).astype(float).round(3).tolist()}
    assert inks == {(0.95, 0.95, 0.92, 1.0), (0.004, 0.004, 0.005, 1.0)}
    (look,) = data.materials
    assert look.displacement_method == "DISPLACEMENT"  # the shader turns them
    output = next(node for node in look.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
    assert output.inputs["Displacement"].is_linked


def test_signs_have_all_lines_nearby_and_the_name_far_away(settings, run, scene, tmp_path):
    rows = [(1, "Near Station", 38.840, -120.555, "fire station", "fact")]
    path = small_stations.write(tmp_path / "stations.gpkg", rows, [])
    stations = StationSettings(enabled=True, file=path, size=0.03, detail=3000.0, distance=9000.0)
    stage = owned.stage(scene)
    data = labels.build(Shot(replace(settings, stations=stations), run), stage, stage.part("Live")).data
    seen = np.round(values(data, "seen", 3), 3)
    assert np.unique(seen[:, 1:], axis=0).tolist() == [[0.0, 3000.0], [3000.0, 9000.0]]
    high = [values(data, "letter", 3)[seen[:, 1] == near, 1].max() for near in (0.0, 3000.0)]
    assert high[0] > high[1] > 0.0


def test_the_live_scene_shows_them_in_place_of_the_films(labelled, run, scene):
    shot, stage = Shot(labelled, run), owned.stage(scene)
    build.build(shot, scene, ("cameras", "labels"))
    live = switch.empty(stage)
    labels.build(shot, stage, live)
    places = bpy.data.objects["Firetwin Places"]
    for on in (True, False):
        switch.show_live(scene, on)
        assert places.hide_viewport == on
        assert not places.hide_render


def test_film_labels_stay_without_live_ones(labelled, run, scene):
    build.build(Shot(labelled, run), scene, ("cameras", "labels"))
    live = switch.empty(owned.stage(scene))
    owned.add(live, "Other", None)
    switch.show_live(scene, True)
    assert not bpy.data.objects["Firetwin Places"].hide_viewport


def test_none_without_labels_and_stations(settings, run, scene):
    stage = owned.stage(scene)
    assert labels.build(Shot(settings, run), stage, stage.part("Live")) is None
