"""An artist's edits of cameras: read into the settings, preserved by a rebuild, rendered equally."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import compat, owned
from firetwin.scene.camera import build as cameras
from firetwin.scene.camera import ground_raycast, read_edits
from firetwin.scene.terrain import build as ground
from firetwin.shot.cameras.rigs.drone import Drone
from firetwin.shot.cameras.rigs.poses import Poses
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.settings import Camera, scene_file
from firetwin.shot.shot import Shot
from mathutils import Euler

FRAMES = 96
SIZE = (640, 360)


@pytest.fixture
def film(settings, run):
    """A drone and a satellite over many frames."""
    both = (*settings.cameras, Camera("high", Satellite(swath=8000.0)))
    render = replace(settings.render, resolution=SIZE)
    time = replace(settings.time, frames=FRAMES)
    return Shot(replace(settings, cameras=both, time=time, render=render), run)


@pytest.fixture
def drone(film, stage):
    stage.scene.frame_end = FRAMES
    return cameras.build(film, stage)[0]


def _pull(film, stage, told=None):
    tell = (lambda text: None) if told is None else told.append
    return read_edits.update_cameras(stage.scene, film.settings.cameras, SIZE, FRAMES, tell)


def _again(film, found):
    return Shot(replace(film.settings, cameras=found), film.run)


def _matrices(scene, thing):
    found = []
    for frame in range(1, FRAMES + 1):
        scene.frame_set(frame)
        found.append(np.array(thing.matrix_world))
    return np.array(found)


def _fly(thing):
    """Fly and turn and zoom by hand: four keys, as I sets them."""
    places = ((0, 0, 3500), (800, 300, 3200), (1500, 1500, 2900), (900, 2600, 3000))
    thing.animation_data_clear()
    thing.rotation_mode = "XYZ"
    for k, (frame, place) in enumerate(zip((1, 33, 64, FRAMES), places, strict=True)):
        thing.location, thing.rotation_euler = place, Euler((0.9 + 0.1 * k, 0.05 * k, 0.4 * k))
        thing.data.lens = 24.0 + 8.0 * k
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_euler", frame=frame)
        thing.data.keyframe_insert("lens", frame=frame)


def test_what_is_untouched_stays_as_the_file_says(film, stage, drone):
    assert _pull(film, stage) == film.settings.cameras


def test_a_camera_flown_by_hand_comes_back_from_the_file(film, stage, drone, plain_looks, tmp_path):
    """Within a quarter of a pixel (0.034 degrees): measured place and angle are printed."""
    _fly(drone)
    ground.build(film, stage, None)
    before, lenses = _matrices(stage.scene, drone), []
    told = []
    read_back = _pull(film, stage, told)
    assert isinstance(read_back[0].rig, Poses)
    assert not told
    assert read_back[1] == film.settings.cameras[1]
    assert len(read_back[0].rig.keys) <= FRAMES / 2
    whole = replace(_again(film, read_back).settings, path=tmp_path / "scene.toml")
    whole.path.write_text(scene_file.text(whole), encoding="utf-8")
    shot = Shot(scene_file.read(whole.path), film.run)
    assert cameras.build(shot, stage)[0] == drone  # the same object, not another one
    after = _matrices(stage.scene, drone)
    moved = np.linalg.norm(after[:, :3, 3] - before[:, :3, 3], axis=1).max()
    apart = np.linalg.norm(after[:, :3, :3] - before[:, :3, :3], axis=(1, 2)).max()
    turned = np.degrees(apart / np.sqrt(2.0))  # of small angles
    print(f"{len(read_back[0].rig.keys)} poses, {moved:.5f} m, {turned:.6f} degrees off")
    assert moved < 0.5
    assert turned < 0.034
    for frame in (1, 64, FRAMES):
        stage.scene.frame_set(frame)
        lenses.append(drone.data.lens)
    assert lenses == pytest.approx([24.0, 40.0, 48.0], rel=1e-4)
    fixed = _pull(shot, stage)
    assert fixed == shot.settings.cameras  # nothing is left to take over


def test_a_still_pose_is_one_key_and_exact_to_the_last_bit(film, stage, drone):
    drone.animation_data_clear()
    drone.location = (1234.5678, -987.654, 3210.123)
    drone.rotation_quaternion = Euler((1.1, 0.02, 2.3)).to_quaternion()
    found = _pull(film, stage)
    assert len(found[0].rig.keys) == 1
    place, turn = tuple(drone.location), tuple(drone.rotation_quaternion)
    cameras.build(_again(film, found), stage)
    assert tuple(drone.location) == place
    assert np.abs(np.array(drone.rotation_quaternion) @ np.array(turn)) == pytest.approx(1.0, abs=2e-7)
    assert not compat.fcurves(drone)


def test_a_lens_alone_leaves_the_way_as_it_is(film, stage, drone):
    drone.data.lens, drone.data.sensor_width = 12.29, 17.3
    rig = _pull(film, stage)[0].rig
    assert isinstance(rig, Drone)
    assert (rig.focal_length, rig.sensor_width) == (pytest.approx(12.29), pytest.approx(17.3))
    assert rig.keys == film.settings.cameras[0].rig.keys


def test_the_chip_is_as_wide_as_the_cameras_own_pictures(film, stage, drone):
    tall = replace(film.settings.cameras[0], resolution=(360, 640))
    drone.data.sensor_fit, drone.data.sensor_height = "VERTICAL", 24.0
    (found,) = read_edits.update_cameras(stage.scene, (tall,), SIZE, FRAMES)
    assert found.rig.sensor_width == pytest.approx(24.0 * 360 / 640)


def test_a_new_name_is_kept_and_names_the_files(film, stage, drone):
    drone.name = "Über the ridge!"
    stage.scene.camera = drone
    found = _pull(film, stage)
    assert [each.name for each in found] == ["ber-the-ridge", "high"]
    assert found[0].rig == film.settings.cameras[0].rig
    built = cameras.build(_again(film, found), stage)
    assert built[0] == drone
    assert drone.name == "Über the ridge!"
    assert stage.scene.camera == drone
    assert len(bpy.data.cameras) == 2


def test_a_rebuild_keeps_what_the_settings_do_not_say(film, stage, drone):
    drone.data.dof.use_dof, drone.data.dof.aperture_fstop = True, 1.4
    drone["mine"] = 7
    assert cameras.build(film, stage)[0] == drone
    assert drone.data.dof.use_dof
    assert drone["mine"] == 7


def test_what_hangs_on_something_is_followed_and_left_alone(film, stage, drone):
    """A camera that an artist lets look at an empty: its own keys stay, the file says where it looks."""
    empty = bpy.data.objects.new("aim", None)
    stage.scene.collection.objects.link(empty)
    empty.location = (500.0, 500.0, 1500.0)
    aim = drone.constraints.new("TRACK_TO")
    aim.target, aim.track_axis, aim.up_axis = empty, "TRACK_NEGATIVE_Z", "UP_Y"
    found = _pull(film, stage)
    before, curves = _matrices(stage.scene, drone), len(compat.fcurves(drone))
    shot = _again(film, found)
    back = shot.paths[0].rotation[:, :, 2]
    assert np.abs(back - before[:, :3, 2]).max() < 1e-3
    cameras.build(shot, stage)
    assert (len(compat.fcurves(drone)), len(drone.constraints)) == (curves, 1)


def test_what_a_file_cannot_say_is_told(film, stage, drone):
    drone.data.type = "ORTHO"
    told = []
    assert _pull(film, stage, told)[0] == film.settings.cameras[0]
    assert told == ['camera "drone": edits of a camera of type ortho cannot be saved in a scene file']


def test_the_ground_is_met_where_it_is(film, stage, drone, plain_looks):
    ground.build(film, stage, None)
    place = film.ground.point(38.84, -120.55, 100.0)[0]
    assert ground_raycast.height_above_terrain(stage, [place]) == pytest.approx(100.0, abs=3.0)
    assert ground_raycast.clearance_offset(stage, place - [0.0, 0.0, 95.0], 10.0) == pytest.approx(
        5.0, abs=3.0
    )
    assert ground_raycast.terrain_height(stage, (1.0e6, 0.0)) is None
    assert owned.has_data(stage.scene)
