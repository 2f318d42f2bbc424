"""Cameras of other programs: exported poses come back to 1 cm and 0.01 degrees."""

import json
import sys
import zipfile
from functools import partial

import child_work
import numpy as np
import pytest
from firetwin import cli
from firetwin.camera_import import foreign, job, kml, move, placing
from firetwin.errors import InputError
from firetwin.geometry import quaternion
from firetwin.jobs import worker
from firetwin.progress import silent
from firetwin.shot.cameras import rotation
from firetwin.shot.source import ShotSource
from hypothesis import given
from hypothesis import strategies as st

SCENE = """\
# our fire
run = '{run}'
time = {{ frames = 24, fps = 12 }}
terrain = {{ near_radius = 0.0, apron = 0.0 }}

[[cameras]]
name = "chase"  # follows it
kind = "drone"
focal_length = 35.0
keys = [
  {{ at = 0.0, latitude = 38.904, longitude = -120.599, height = 150.0, target = "fire" }},
  {{ at = 1.0, latitude = 38.906, longitude = -120.594, height = 250.0, target = "fire" }},
]
"""


@pytest.fixture
def scene(make_run, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.format(run=make_run()))
    return path


def shot(scene):
    return ShotSource(str(scene)).shot()


def imported(scene, file, *options):
    assert cli.main(["import", str(file), "--out", str(scene), *options]) == 0
    return shot(scene)


def same(shot, names=("chase", "chase-2")):
    """Check that two cameras of a shot have equal paths."""
    one, two = (next(each for each in shot.paths if each.camera.name == name) for name in names)
    assert np.linalg.norm(one.position - two.position, axis=1).max() < 0.01
    turn = np.einsum("nij,nik->njk", one.rotation, two.rotation)
    assert np.degrees(np.abs(quaternion.quaternions(turn)[:, 1:]).max() * 2.0) < 0.01
    assert two.halves[:, 0] == pytest.approx(one.halves[:, 0], rel=2e-4)


def test_a_tour_of_google_earth_comes_back(scene, tmp_path):
    out = tmp_path / "out"
    assert cli.main(["export", str(scene), "--to", "kmz", "--out", str(out), "--geoid", "-24.5"]) == 0
    text = scene.read_text()
    made = imported(scene, out / "scene.kmz", "--name", "chase-2")
    same(made)
    assert scene.read_text().startswith(text)
    poses = made.settings.cameras[1].rig
    assert len(poses.keys) < 24


FLIGHT = """\
<?xml version="1.0"?>
<kml xmlns="http://www.opengis.net/kml/2.2" xmlns:gx="http://www.google.com/kml/ext/2.2"><Document>
<name>Not this</name><gx:Tour><name>Down the canyon</name><gx:Playlist>
<gx:FlyTo><gx:duration>5</gx:duration><Camera><longitude>-120.597</longitude><latitude>38.904</latitude>
<altitude>2000</altitude><heading>90</heading><tilt>80</tilt><roll>10</roll>
<altitudeMode>absolute</altitudeMode><gx:horizFov>90</gx:horizFov></Camera></gx:FlyTo>
<gx:Wait><gx:duration>0.5</gx:duration></gx:Wait>
<gx:FlyTo><gx:duration>1</gx:duration><LookAt><longitude>-120.594</longitude><latitude>38.906</latitude>
<heading>0</heading><tilt>0</tilt><range>500</range></LookAt></gx:FlyTo>
</gx:Playlist></gx:Tour></Document></kml>
"""


def test_views_and_waits_of_a_tour(scene, tmp_path):
    path = tmp_path / "tour.kml"
    path.write_text(FLIGHT)
    here = shot(scene)
    (tour,) = kml.tours(path, here.ground, 0.0)
    assert (tour.name, tour.times.tolist()) == ("Down the canyon", [0.0, 0.5, 1.5])
    assert tour.half[[0, 2]] == pytest.approx([1.0, np.tan(np.radians(30.0))])
    latitude, longitude, height = here.local_frame.reverse(tour.position)
    assert (latitude[0], longitude[0], height[0]) == pytest.approx((38.904, -120.597, 2000.0))
    assert rotation.angles(here.local_frame, tour.position[0], tour.rotation[0]) == pytest.approx(
        (90, 10, 10)
    )
    ground = here.ground.up(*here.local_frame.forward([38.906], [-120.594], [0.0])[:, :2].T)
    assert tour.position[2, 2] - ground[0] == pytest.approx(500.0, abs=0.1)
    made = imported(scene, path, "--times", "shot")
    camera = made.settings.cameras[1]
    assert (camera.name, camera.rig.keys[0].at, camera.rig.keys[-1].at) == ("Down-the-canyon", 0.0, 1.0)


@pytest.mark.parametrize(("old", "new", "words"), [
    ("<latitude>38.904<", "<latitude>98.9<", "98.9, -120.597 is not a latitude"),
    ("<range>500</range>", "", "a view without <range>"),
    ("<tilt>80<", "<tilt>steep<", 'the tilt is "steep"'),
    ("<kml ", '<!DOCTYPE a [<!ENTITY b "c">]><kml ', "document type"),
    ("</Document>", "", "is not whole XML"),
])  # fmt: skip
def test_a_damaged_tour_is_explained(scene, tmp_path, old, new, words):
    path = tmp_path / "tour.kml"
    path.write_text(FLIGHT.replace(old, new, 1))
    with pytest.raises(InputError, match=words):
        kml.tours(path, shot(scene).ground, 0.0)


def test_a_kmz_that_is_none_is_explained(scene, tmp_path):
    with zipfile.ZipFile(tmp_path / "tour.kmz", "w") as archive:
        archive.writestr("readme.txt", "no tour")
    (tmp_path / "text.kmz").write_text("no archive")
    for name, words in (("tour.kmz", "contains no .kml"), ("text.kmz", "not a KMZ")):
        with pytest.raises(InputError, match=words):
            kml.tours(tmp_path / name, shot(scene).ground, 0.0)


def test_a_recorded_flight_becomes_a_track(scene, tmp_path):
    (tmp_path / "flights").mkdir()
    path = tmp_path / "flights/out.gpx"
    assert cli.main(["track", str(scene), "--out", str(path)]) == 0
    made = imported(scene, path)
    assert made.settings.cameras[1].rig.track.samefile(path)
    assert 'track = "flights/out.gpx"' in scene.read_text()
    one, two = (each.position for each in made.paths)
    assert np.linalg.norm(one - two, axis=1).max() < 0.01


def test_names_are_kept_apart_or_replaced(scene, tmp_path, capsys):
    path = tmp_path / "tour.kml"
    path.write_text(FLIGHT)
    before = scene.read_text()
    assert cli.main(["import", str(path), "--out", str(scene), "--name", "chase"]) == 2
    assert 'has a camera "chase"; choose another name, or add --replace' in capsys.readouterr().err
    assert cli.main(["import", str(path), "--out", str(scene), "--camera", "Down the can"]) == 2
    assert 'has no "Down the can", but Down the canyon' in capsys.readouterr().err
    assert scene.read_text() == before
    made = imported(scene, path, "--name", "chase", "--replace")
    assert [type(each.rig).__name__ for each in made.settings.cameras] == ["Poses"]
    assert "# our fire" in scene.read_text()


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3),
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3),
)
def test_few_poses_follow_a_move(swing, drift):
    count = 40
    t = np.linspace(0.0, 1.0, count)
    place = np.outer(t, drift) * 3000.0 + np.array(swing) * np.sin(3.0 * t)[:, None] * 50.0 + [0, 0, 900.0]
    q = np.column_stack([np.ones(count), *(0.3 * s * np.sin(2.0 * t + s) for s in swing)])
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    flown = move.Move(
        "a", np.arange(1.0, count + 1), place, quaternion.matrices(q), np.full(count, 0.5), rate=24.0
    )
    from firetwin_core import geo

    frame = geo.LocalFrame(38.9, -120.6, 0.0)
    rig = move.fit(flown, flown.times, count, frame)
    assert rig.sensor_width == pytest.approx(rig.focal_length)  # half: 0.5
    for key in rig.keys:
        (there,) = frame.forward([key.latitude], [key.longitude], [key.height])
        assert np.linalg.norm(there - place[round(key.at * (count - 1))]) < 1e-3


def test_times_of_a_move():
    one = np.zeros((3, 3))
    tour = move.Move("t", np.array([0.0, 1.0, 2.0]), one, one, one)
    stage = move.Move("s", np.array([11.0, 12.0, 13.0]), one, one, one, rate=24.0)
    frames = {
        (each.name, times): move.film_frames(each, times, 48.0, 101).tolist()
        for each in (tour, stage)
        for times in ("own", "start", "shot")
    }
    assert frames["t", "own"] == frames["t", "start"] == [1.0, 49.0, 97.0]
    assert frames["s", "own"] == [22.0, 24.0, 26.0]
    assert frames["s", "start"] == [1.0, 3.0, 5.0]
    assert frames["t", "shot"] == frames["s", "shot"] == [1.0, 51.0, 101.0]


def test_a_place_on_the_earth_is_found_and_checked(scene, tmp_path):
    here = shot(scene)
    frame = here.local_frame
    origin = (frame.latitude, frame.longitude, frame.height - 24.5)
    np.testing.assert_allclose(placing.scene_from(here, origin, -24.5), np.eye(4), atol=2e-9)
    north = placing.scene_from(here, (frame.latitude + 0.01, *origin[1:]), -24.5)
    (there,) = frame.forward([frame.latitude + 0.01], [frame.longitude], [frame.height])
    np.testing.assert_allclose(north[:3, 3], there, atol=0.01)
    sidecar = tmp_path / placing.SIDECAR
    assert placing.read_sidecar(tmp_path / "a.usda") is None
    sidecar.write_text(json.dumps({"latitude": 1, "longitude": 2, "ellipsoidal_height_m": 3, "geoid_m": 4}))
    assert placing.read_sidecar(tmp_path / "a.usda") == ((1.0, 2.0, 3.0), 4.0)
    for text in ("[]", "{}", "1" * 5000, "[" * 100_000, '{"latitude": 200}'):
        sidecar.write_text(text)
        with pytest.raises(InputError, match=r"georeference\.json"):
            placing.read_sidecar(tmp_path / "a.usda")


def test_foreign_cameras_are_unscaled_or_refused(tmp_path):
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])

    def moves(matrix):
        camera = {"name": "a", "frames": [1.0], "matrix": [matrix.tolist()], "half": [0.5], "sensor": 36.0}
        return foreign.ForeignScene(24.0, None, [camera], []).moves(tmp_path, np.eye(4))

    np.testing.assert_allclose(moves(matrix)[0].rotation[0], np.eye(3))
    for wrong in (np.diag([-1.0, 1, 1, 1]), np.diag([0.0, 1, 1, 1]), np.full((4, 4), np.nan)):
        with pytest.raises(InputError, match='camera "a"'):
            moves(wrong)


@pytest.mark.skipif(sys.platform != "linux", reason="limits the memory")
@pytest.mark.parametrize(("work", "words"), [
    (child_work.allocate, "does not fit into the memory"),
    (child_work.abort, r"is damaged, or needs more than 0\.3 GB of memory or 120 s to read; export only"),
])  # fmt: skip
def test_memory_and_crashes_of_a_file_are_limited(tmp_path, monkeypatch, work, words):
    child_work.importable(monkeypatch)
    monkeypatch.setattr(foreign, "CAMERA_MEMORY", 1 << 28)
    monkeypatch.setattr(worker, "run", partial(worker.run, blender=False))
    with pytest.raises(InputError, match=rf"^{tmp_path}/a\.abc: {words}[^\n]*$"):
        foreign.read(tmp_path / "a.abc", work, silent)


def test_other_files_are_refused(scene, tmp_path):
    (tmp_path / "a.fbx").write_text("")
    for name, words in (("a.fbx", "is not one of"), ("none.usda", "no such file")):
        arguments = type("Arguments", (), {"file": tmp_path / name})
        with pytest.raises(InputError, match=words):
            job.run(arguments, None)
