"""Landmarks, actions and frame times of VR sessions, without a session."""

import bpy
import firetwin
import pytest
from firetwin.ui import go_to
from firetwin.ui.vr import controllers, display, landmark_list, session
from mathutils import Matrix, Vector


@pytest.fixture
def panel(panel_blend):
    """A built scene."""
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(panel_blend))
    yield bpy.context.scene.firetwin
    firetwin.unregister()


def _ahead(angle):
    return Matrix.Rotation(angle, 3, "Z") @ Vector((0.0, 1.0, 0.0))


def test_landmarks_begin_with_the_fire_and_have_each_camera(panel):
    names = landmark_list.names(bpy.context.scene)
    assert names[:2] == ["Head of the fire", "Ignition"]
    cameras = {obj.name for obj in bpy.context.scene.objects if obj.type == "CAMERA"}
    assert cameras
    assert cameras <= set(names)
    assert len(names) == len(set(names))


def test_viewers_stand_on_the_ground_and_look_at_the_head(panel):
    scene = bpy.context.scene
    scene.frame_set(panel.frames)
    found = landmark_list.pose(scene, "Ignition")
    ground, head = (go_to.find_position(scene, name) for name in ("ignition", "head"))
    assert (found.place - ground - Vector((0.0, 0.0, landmark_list.EYE))).length < 1e-3
    way = (head - ground) * Vector((1.0, 1.0, 0.0))
    assert _ahead(found.angle).angle(way) < 1e-3
    assert _ahead(landmark_list.pose(scene, "Head of the fire").angle).angle(way) < 1e-3


def test_viewers_have_the_place_and_direction_of_a_camera(panel):
    scene = bpy.context.scene
    camera = next(obj for obj in scene.objects if obj.type == "CAMERA")
    found = landmark_list.pose(scene, camera.name)
    assert (found.place - camera.matrix_world.translation).length == 0.0
    flat = -camera.matrix_world.col[2].to_3d() * Vector((1.0, 1.0, 0.0))
    assert _ahead(found.angle).angle(flat) < 1e-3
    assert landmark_list.pose(scene, "nowhere at all") is None


def test_the_next_start_is_at_the_chosen_landmark_and_settings_return(panel):
    settings = bpy.context.window_manager.xr_session_settings
    settings.base_pose_location, settings.clip_end = (1.0, 2.0, 3.0), 123.0
    panel.vr_landmark, panel.vr_scale = "Ignition", "TABLE"
    session.prepare(bpy.context)
    ground = go_to.find_position(bpy.context.scene, "ignition")
    assert settings.base_scale == 1000.0
    assert settings.base_pose_location[2] == pytest.approx(ground.z + landmark_list.EYE + 500.0)
    session.restore()
    assert tuple(settings.base_pose_location) == (1.0, 2.0, 3.0)
    assert settings.clip_end == 123.0
    assert settings.base_scale == 1.0


def test_every_action_calls_an_operator_that_has_its_options(panel):
    for name, action in controllers.ACTIONS.items():
        room, _, operator = action.operator.partition(".")
        known = getattr(getattr(bpy.ops, room), operator).get_rna_type().properties
        assert set(action.options) <= set(known.keys()), name


def test_no_control_has_two_actions():
    taken = [
        (action.hand, controller, control, side)
        for action in controllers.ACTIONS.values()
        for controller, control in action.controls.items()
        for side in (("POSITIVE", "NEGATIVE") if action.side == "ANY" else (action.side,))
    ]
    assert len(taken) == len(set(taken))


@pytest.mark.parametrize(("seconds", "slow"), [(None, False), (0.0139, False), (0.02, True)])
def test_a_frame_time_longer_than_72_hertz_is_a_warning(seconds, slow):
    words, found = display.describe(seconds)
    assert found is slow
    assert words.startswith("Frame time: ")
