"""Cameras in the window: from the view, keyed, aimed, on curves; navigation to places and times."""

import bpy
import numpy as np
import panel_scene
import pytest
import small_stations
from firetwin.blender import owned
from firetwin.errors import Error
from firetwin.scene.camera import ground_raycast, read_edits
from firetwin.shot.cameras import rigs, targets
from firetwin.shot.cameras.lenses import LENSES
from firetwin.shot.cameras.rigs.poses import Poses
from firetwin.shot.stations import station_signs
from firetwin.ui import (
    camera_list,
    camera_targets,
    coordinates,
    events,
    go_to,
    landmarks,
    navigation,
    place_names,
    scene_file,
)
from mathutils import Euler, Matrix, Vector

EYE = Matrix.Translation((-500.0, -2500.0, 2400.0)) @ Euler((1.2, 0.0, -0.2)).to_matrix().to_4x4()


@pytest.fixture
def panel(panel_blend, plain_looks, tmp_path, monkeypatch):
    """A built scene of the panel, and a view that looks from EYE."""
    monkeypatch.setattr(navigation, "camera_from_view", lambda context: (EYE.copy(), 30.0, 36.0))
    for settings in panel_scene.opened(panel_blend):
        settings.output = str(tmp_path / "out")
        yield settings


def _back(thing, frame):
    bpy.context.scene.frame_set(frame)
    return thing.matrix_world.translation.copy(), -thing.matrix_world.col[2].to_3d()


def test_every_kind_of_camera_can_be_made_from_a_view(panel):
    stage = owned.stage(bpy.context.scene)
    seen = navigation.create_view(stage, EYE, 30.0, 36.0)
    assert seen.tilt == pytest.approx(90.0 - np.degrees(1.2), abs=0.1)
    assert seen.above == pytest.approx(
        2400.0 - ground_raycast.terrain_height(stage, EYE.translation), abs=1.0
    )
    for kind, made in rigs.kinds().items():
        assert isinstance(made.from_view(seen), made), kind


def test_a_camera_from_the_view_sees_what_the_view_sees(panel):
    scene = bpy.context.scene
    for kind, name, off in (
        ("poses", "poses", 0.01),
        ("drone", "drone2", 0.01),
        ("lookout", "lookout", 20.0),
        ("orbit", "orbit", 30.0),
    ):
        assert bpy.ops.firetwin.camera_add(kind=kind) == {"FINISHED"}
        camera = camera_list.get(panel.cameras[-1])
        assert (camera.name, camera.kind) == (name, kind)
        thing = owned.stage(scene).camera(name)
        assert scene.camera == thing
        place, ahead = _back(thing, 1)
        assert np.linalg.norm(place - EYE.translation) < off
        assert np.degrees(ahead.angle(-EYE.col[2].to_3d())) < (0.001 if kind == "poses" else 1.0)
        assert thing.data.lens == pytest.approx(30.0)


def test_keys_are_set_where_the_view_is_and_never_in_the_ground(panel, monkeypatch):
    scene = bpy.context.scene
    bpy.ops.firetwin.camera_add(kind="poses")
    stage, thing = owned.stage(scene), scene.camera
    ground = ground_raycast.terrain_height(stage, (0.0, 0.0))
    low = Matrix.Translation((0.0, 0.0, ground - 50.0)) @ Euler((1.4, 0.0, 0.5)).to_matrix().to_4x4()
    bpy.ops.firetwin.camera_key()
    scene.frame_set(3)
    monkeypatch.setattr(navigation, "camera_from_view", lambda context: (low, 30.0, 36.0))
    bpy.ops.firetwin.camera_key(clearance=20.0)
    place, ahead = _back(thing, 3)
    assert place.z == pytest.approx(ground + 20.0, abs=0.01)
    assert ahead.angle(-low.col[2].to_3d()) < 1e-4
    assert (_back(thing, 1)[0] - EYE.translation).length < 0.01
    assert bpy.ops.firetwin.build(part="cameras") == {"FINISHED"}
    rig = camera_list.get(panel.cameras[-1]).rig
    assert isinstance(rig, Poses)
    assert (rig.keys[0].at, rig.keys[-1].at) == (0.0, 1.0)
    assert (_back(thing, 3)[0] - place).length < 0.01


def test_a_camera_looks_at_an_empty_that_follows_the_fire_or_stands_at_a_place(panel, tmp_path):
    scene = bpy.context.scene
    for target, name in (("fire", "Aim at fire"), ("point", "Aim at point")):
        assert bpy.ops.firetwin.camera_aim(target=target) == {"FINISHED"}
        empty = scene.objects[name]
        for frame in (1, 3):
            place, ahead = _back(scene.camera, frame)
            assert ahead.angle(empty.matrix_world.translation - place) < 1e-3
    assert len(scene.camera.constraints) == 1
    (tmp_path / "places.csv").write_text("name,latitude,longitude\nStation 61,38.84,-120.55\n")
    panel.labels.file = str(tmp_path / "places.csv")
    assert bpy.ops.firetwin.camera_aim(target="station", place="station 61") == {"FINISHED"}
    empty = scene.objects["Aim at station 61"]
    assert (empty.location - go_to.find_position(scene, "38.84 -120.55")).length < 0.01
    place, ahead = _back(scene.camera, 2)
    assert ahead.angle(empty.matrix_world.translation - place) < 1e-3
    with pytest.raises(RuntimeError, match='no place is called "elsewhere"'):
        bpy.ops.firetwin.camera_aim(target="station", place="elsewhere")
    assert len(scene.camera.constraints) == 1
    bpy.ops.firetwin.camera_aim(target="none")
    assert not scene.camera.constraints
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert "Aim at fire" in scene.objects  # the artist's own


def test_a_way_becomes_a_curve_that_the_camera_follows(panel):
    scene, thing = bpy.context.scene, bpy.context.scene.camera
    thing.animation_data_clear()
    places = {1: (0.0, 0.0, 3000.0), 2: (900.0, 200.0, 3100.0), 3: (1200.0, 1500.0, 2900.0)}
    for frame, place in places.items():
        thing.location = place
        thing.keyframe_insert("location", frame=frame)
    assert bpy.ops.firetwin.camera_path() == {"FINISHED"}
    hook = thing.constraints[camera_targets.PATH]
    for frame, place in places.items():
        assert np.linalg.norm(_back(thing, frame)[0] - Matrix.Translation(place).translation) < 2.0
    hook.target.data.splines[0].bezier_points[1].co.z += 500.0
    before = [_back(thing, frame)[0] for frame in (1, 2, 3)]
    assert before[1].z > 3400.0
    assert bpy.ops.firetwin.build() == {"FINISHED"}
    assert thing.constraints[camera_targets.PATH] == hook  # the rebuild leaves it alone
    keys = camera_list.get(panel.cameras[0]).rig.keys
    frame = read_edits.local_frame(owned.stage(scene))
    flown = frame.forward(*np.array([(k.latitude, k.longitude, k.height) for k in keys]).T.copy())
    assert np.linalg.norm(flown - np.array([tuple(place) for place in before]), axis=1).max() < 0.01


def test_lenses_say_what_they_are_and_reach_the_table(panel):
    for name, lens in LENSES.items():
        assert bpy.ops.firetwin.camera_lens(preset=name) == {"FINISHED"}
        assert 1.0 < lens.focal_length < 1000.0
        assert lens.source
    bpy.ops.firetwin.camera_lens(preset="thermal_drone")
    bpy.ops.firetwin.build(part="cameras")
    rig = camera_list.get(panel.cameras[0]).rig
    assert (rig.focal_length, rig.sensor_width) == (13.6, 7.68)


@pytest.mark.parametrize(
    ("text", "pair"),
    [
        ("38.82 -120.55", (38.82, -120.55)),
        ("38.82 N, 120.55 W", (38.82, -120.55)),
        ("38.82° N 120.55° W", (38.82, -120.55)),
        ("33.9S;18.4E", (-33.9, 18.4)),
        ("38°49'12\"N 120°33'00\"W", (38.82, -120.55)),
        ("38°49\u203212.0\u2033 N, 120°33\u20320\u2033 W", (38.82, -120.55)),
        ("38 49 12 N 120 33 0 W", (38.82, -120.55)),
        ("38 49.2 N; 120 33 W", (38.82, -120.55)),
        ("N 38:49:12 W 120:33", (38.82, -120.55)),
        ("33d54m S 18d24m E", (-33.9, 18.4)),
        ("N38.82 W120.55", (38.82, -120.55)),
        ("38 60 N 120 33 W", None),
        ("38 49 61 N 120 33 W", None),
        ("38 49.5 12 N 120 33 W", None),
        ("98 49 N 120 33 W", None),
        ("38 49 12 120 33 0", None),
        ("New Sweden", None),
        ("Georgetown 61", None),
        ("3882", None),
        ("98 120", None),
    ],
)
def test_coordinates_are_read_as_people_write_them(text, pair):
    found = coordinates.parse(text)
    assert found == (None if pair is None else pytest.approx(pair, abs=1e-9))


def test_one_goes_to_places_names_and_moments(panel):
    scene = bpy.context.scene
    where = go_to.find_position(scene, "38.84 -120.55")
    latitude, longitude, _ = read_edits.local_frame(owned.stage(scene)).reverse(np.array([tuple(where)]))
    assert (latitude[0], longitude[0]) == (pytest.approx(38.84, abs=1e-3), pytest.approx(-120.55, abs=1e-3))
    assert (go_to.find_position(scene, "camera drone") - scene.camera.matrix_world.translation).length < 1e-3
    assert go_to.find_position(scene, "nowhere at all") is None
    del owned.stage(scene).root[read_edits._PLACE]  # as before cameras are built
    with pytest.raises(Error, match="build the scene first"):
        go_to.find_position(scene, "38.84 -120.55")
    assert bpy.ops.firetwin.go(text="2014-09-17 13:30") == {"FINISHED"}  # by longitude UTC-8
    assert scene.frame_current == 2
    assert bpy.ops.firetwin.go(text="2014-09-17 21:58 UTC") == {"FINISHED"}
    assert scene.frame_current == 3
    assert bpy.ops.firetwin.go(text="run begins") == {"FINISHED"}  # a dated moment of the run
    assert scene.frame_current == 1
    assert bpy.ops.firetwin.go(text="nowhere at all") == {"CANCELLED"}


def test_head_ignition_and_stations_are_gone_to(panel, tmp_path):
    scene = bpy.context.scene
    path = small_stations.write(
        tmp_path / "stations.gpkg", [(1, "Base Two", 38.84, -120.55, "exercise base", "exercise")]
    )
    panel.stations.file = str(path)
    assert (
        go_to.find_position(scene, "base two") - go_to.find_position(scene, "38.84 -120.55")
    ).length < 0.01
    shot = scene_file.shot_source(panel).shot()
    latitude, longitude = station_signs.ignition_point(shot)
    assert (
        go_to.find_position(scene, "ignition") - go_to.find_position(scene, f"{latitude} {longitude}")
    ).length < 5.0
    wanted = targets.follow("head", shot.bare_ground, shot.frames.times, station_signs._ABOVE)
    for frame in (1, 3):
        scene.frame_set(frame)
        assert np.array(go_to.find_position(scene, "Head of the fire")) == pytest.approx(
            wanted[frame - 1], abs=0.1
        )
        assert go_to.find_position(scene, "head") == go_to.find_position(scene, "Head of the fire")
    assert landmarks.list_names(panel) == ["Head of the fire", "Ignition"]


def test_one_goes_to_the_moment_when_the_fire_reaches_a_station(panel, tmp_path):
    scene = bpy.context.scene
    path = small_stations.write(
        tmp_path / "stations.gpkg",
        [
            (1, "Base Two", 38.84, -120.55, "exercise base", "exercise"),
            (2, "Far Camp", 38.801, -120.599, "exercise base", "exercise"),
        ],
    )
    panel.stations.file = str(path)
    found = {event.words: event for event in events.list_events(panel)}
    assert "the fire reaches Base Two" in found
    assert "the fire reaches Far Camp" not in found, "it never comes there"
    times = [event.time for event in events.list_events(panel)]
    assert times == sorted(times)
    event = events.find_event(panel, "reaches base two")
    assert event.place == "Base Two"
    scene.frame_set(3)
    assert bpy.ops.firetwin.go(text="the fire reaches Base Two") == {"FINISHED"}
    assert scene.frame_current == go_to.nearest_frame(panel, event.time)


def test_names_are_off_beside_tiles_whose_terms_forbid_other_gazetteers(panel, tmp_path):
    file = tmp_path / "places.csv"
    file.write_text("name,latitude,longitude\nOld Mill,38.84,-120.55\n")
    panel.labels.file = str(file)
    scene = bpy.context.scene
    assert [each.name for each in place_names.list_labels(panel)] == ["Old Mill"]
    assert go_to.find_position(scene, "old mill") is not None
    panel.tiles.sources = '"terrain_tiles", "https://tile.googleapis.com/v1/3dtiles/root.json"'
    assert place_names.list_labels(panel) == ()
    assert go_to.find_position(scene, "old mill") is None
    assert go_to.find_position(scene, "38.84 -120.55") is not None
    assert "Google" in go_to._explain_unknown(panel, "old mill")
    panel.tiles.sources = '"https://example.org/tileset.json", "half typed'
    assert [each.name for each in place_names.list_labels(panel)] == ["Old Mill"]


def test_a_view_at_a_place_is_above_the_terrain(panel, monkeypatch):
    stage = owned.stage(bpy.context.scene)
    where = go_to.find_position(bpy.context.scene, "38.84 -120.55")

    def height(turn, distance):
        eye = where + turn @ Vector((0.0, 0.0, distance))
        return eye.z - ground_raycast.terrain_height(stage, eye)

    assert height(go_to.view_from_above(stage, where, 0.3, 2000.0), 2000.0) > go_to._CLEARANCE
    flat = go_to.view_from_above(stage, where, 0.3, 2000.0)
    monkeypatch.setattr(ground_raycast, "terrain_height", lambda stage, eye: where.z + 1200.0)  # a ridge
    steep = go_to.view_from_above(stage, where, 0.3, 2000.0)
    assert (steep @ Vector((0, 0, 1))).z > (flat @ Vector((0, 0, 1))).z + 0.1


def test_vr_landmarks_need_the_viewer(panel):
    with pytest.raises(RuntimeError, match="Enable VR Scene Inspection"):
        bpy.ops.firetwin.vr_landmarks()


def test_vr_landmarks_stand_on_the_ground_and_go_with_the_head(vr_viewer, panel, tmp_path):
    scene = bpy.context.scene
    path = tmp_path / "stations.gpkg"
    small_stations.write(path, [(1, "Base Two", 38.87, -120.55, "exercise base", "exercise")])
    panel.stations.file = str(path)
    for _ in range(2):  # a second time changes none
        assert bpy.ops.firetwin.vr_landmarks() == {"FINISHED"}
    landmarks = {each.name: each for each in scene.vr_landmarks}
    assert len(scene.vr_landmarks) == len(landmarks)
    base, began = landmarks["Base Two"], go_to.find_position(scene, "ignition")
    assert (Vector(base.base_pose_location) - go_to.find_position(scene, "base two")).length < 0.01
    ahead = Matrix.Rotation(base.base_pose_angle, 3, "Z") @ Vector((0.0, 1.0, 0.0))
    way = (began - Vector(base.base_pose_location)) * Vector((1.0, 1.0, 0.0))
    assert ahead.angle(way) < 1e-3
    empty = landmarks["Head of the fire"].base_pose_object
    assert landmarks["Head of the fire"].type == "OBJECT"
    for frame in (1, 3):
        scene.frame_set(frame)
        assert (empty.matrix_world.translation - go_to.find_position(scene, "head")).length < 1.1
    assert len([obj for obj in scene.objects if obj.name.startswith("Head of the fire")]) == 1
