"""Landmarks, actions and frame times of VR sessions, without a session."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import panel_scene
import pytest
import views
from firetwin.blender import owned
from firetwin.scene.camera import ground_raycast
from firetwin.scene.live import switch
from firetwin.ui import go_to
from firetwin.ui.vr import controllers, display, landmark_list, moves, session, teleport
from firetwin.ui.vr.panel import FIRETWIN_PT_vr
from mathutils import Matrix, Quaternion, Vector


@pytest.fixture
def panel(panel_blend):
    """A built scene."""
    yield from panel_scene.opened(panel_blend)


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
    ground.z = ground_raycast.terrain_height(owned.find_stage(scene), ground)
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
    ground = landmark_list.pose(bpy.context.scene, "Ignition").place
    assert settings.base_scale == 1000.0
    assert settings.clip_start < 0.1  # m of the room, in which the ground is half a metre below the eyes
    assert settings.clip_end == pytest.approx(500.0)
    assert settings.base_pose_location[2] == pytest.approx(ground.z + 500.0)
    session.restore()
    assert tuple(settings.base_pose_location) == (1.0, 2.0, 3.0)
    assert settings.clip_end == 123.0
    assert settings.base_scale == 1.0


@pytest.mark.parametrize(("wanted", "before"), [(True, False), (True, True), (False, False)])
def test_the_live_scene_is_shown_during_a_session(panel, monkeypatch, wanted, before):
    shown = [before]
    monkeypatch.setattr(switch, "has_live", lambda scene: True)
    monkeypatch.setattr(switch, "is_live", lambda scene: shown[-1])
    monkeypatch.setattr(switch, "show_live", lambda scene, on: shown.append(on))
    panel.vr_live = wanted
    session.prepare(bpy.context)
    assert shown[-1] is (wanted or before)
    session.restore()
    assert shown[-1] is before
    assert len(shown) == (3 if wanted and not before else 1)


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


class State(SimpleNamespace):
    """State of a session whose left controller points down from 100 m above a point."""

    def controller_aim_location_get(self, context, index):
        return (*self.point.xy, self.point.z + 100.0)

    def controller_aim_rotation_get(self, context, index):
        return (1.0, 0.0, 0.0, 0.0)  # along -z


@pytest.mark.parametrize(("scale", "height"), [("LIFE", 1.7), ("TABLE", 501.7)])
def test_teleport_places_the_eyes_above_the_ground_that_the_controller_points_at(panel, scale, height):
    panel.vr_scale = scale
    ground = landmark_list.pose(bpy.context.scene, "Ignition").place
    viewer, origin = Vector((10.0, 20.0, 3000.0)), Vector((1.0, 2.0, 3.0))
    state = State(point=ground, viewer_pose_location=viewer, navigation_location=origin.copy())
    manager = SimpleNamespace(xr_session_state=state)
    context = SimpleNamespace(scene=bpy.context.scene, window_manager=manager)
    _, end = teleport._find_ray(context)
    assert (ground - end - Vector((0.0, 0.0, landmark_list.EYE))).length < 1e-2
    teleport._go(context, end)
    eyes = viewer + state.navigation_location - origin
    assert (eyes - end - Vector((0.0, 0.0, height))).length < 1e-3
    assert display._Drawing.is_cut
    display.stop()


def test_a_controller_that_points_at_the_sky_has_no_ray(panel):
    state = State(point=Vector((1e9, 0.0, 0.0)))
    manager = SimpleNamespace(xr_session_state=state)
    assert teleport._find_ray(SimpleNamespace(scene=bpy.context.scene, window_manager=manager)) is None


def test_the_first_frame_after_a_cut_is_black_even_if_it_is_late():
    display.stop()
    display.fade()
    black = []
    for now in (50.0, 50.1, 50.2, 50.4):
        display._begin_frame(now)
        black.append(display._Drawing.black)
    assert black == pytest.approx([1.0, 2 / 3, 1 / 3, 0.0])


@pytest.mark.parametrize(("seconds", "slow"), [(None, False), (0.0139, False), (0.02, True)])
def test_a_frame_time_longer_than_72_hertz_is_a_warning(seconds, slow):
    words, found = display.describe(seconds)
    assert found is slow
    assert words.startswith("Frame time: ")


@pytest.mark.parametrize(
    ("seconds", "live", "shading", "words"),
    [
        (0.0139, False, "SOLID", ()),
        (0.02, False, "RENDERED", ("live scene",)),
        (0.02, True, "RENDERED", ("shading Solid", "hide smoke or trees")),
        (0.02, True, "SOLID", ("hide smoke or trees",)),
    ],
)
def test_the_panel_warns_of_slow_frames_with_a_remedy(panel, monkeypatch, seconds, live, shading, words):
    layout = MagicMock()
    layout.column.return_value = layout
    monkeypatch.setattr(session, "is_running", lambda: True)
    monkeypatch.setattr(display, "frame_time", lambda: seconds)
    monkeypatch.setattr(switch, "is_live", lambda scene: live)
    context = views.context(bpy.context.scene, 2000)
    context.space_data.shading.type = shading
    FIRETWIN_PT_vr.draw(SimpleNamespace(layout=layout), context)
    texts = [call.kwargs["text"] for call in layout.label.mock_calls]
    assert texts[0] == display.describe(seconds)[0]
    assert len(texts) == (2 if words else 1)
    assert all(word in texts[-1] for word in words)
    assert ("shading" in texts[-1]) == ("shading Solid" in words)


def test_a_snap_turn_turns_about_the_viewer(panel, monkeypatch):
    """Blender moves the room: the viewer stays in place, and looks 30 degrees to the left."""
    viewer, state = Vector((5.0, 7.0, 2.0)), SimpleNamespace(navigation_rotation=Quaternion())
    state.viewer_pose_location, state.navigation_location = viewer.copy(), Vector((1.0, 2.0, 3.0))
    manager, turn = SimpleNamespace(xr_session_state=state), SimpleNamespace(direction=1)
    context = SimpleNamespace(scene=bpy.context.scene, window_manager=manager)
    moves.FIRETWIN_OT_vr_turn.execute(turn, context)
    assert state.navigation_rotation.to_euler().z == pytest.approx(panel.vr_turn)
    way = viewer - Vector((1.0, 2.0, 3.0))
    now = state.navigation_location + state.navigation_rotation @ way
    assert (now - viewer).length < 1e-5
