"""A VR session with Monado's remote headset: landmarks, time, turns, flights, teleport, and a table top."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator

import bpy
from eyes import Eyes
from hands import alone, call, check, idle, picture, ready, say, settings, soon, view
from mathutils import Quaternion, Vector
from remote_headset import FORCE, LEFT, RIGHT, STICK, TRIGGER, Headset

_CENTIMETRE = 0.01
_STAND = 1.7  # m, eyes above the ground
_HALF = 0.5  # m, eyes above a table top


def _running() -> bool:
    return bpy.types.XrSessionState.is_running(bpy.context)


def _state() -> bpy.types.XrSessionState:
    return bpy.context.window_manager.xr_session_state


def _viewer() -> Vector:
    return Vector(_state().viewer_pose_location)


def _off(name: str) -> float:
    """Return the distance between the viewer and a landmark, m of the scene."""
    from bl_ext.user_default.firetwin.ui.vr import landmark_list

    found = landmark_list.pose(bpy.context.scene, name)
    if found is None:
        return float("inf")
    raised = 1000.0 * _HALF if settings().vr_scale == "TABLE" else 0.0
    return (_viewer() - found.place - Vector((0.0, 0.0, raised))).length


def headset() -> Iterator[object]:
    """Start VR, walk through landmarks and time with the controllers, and stop; then again as a table top."""
    if not os.environ.get("XR_RUNTIME_JSON"):
        say("SKIPPED: VR session, because Monado is not installed here")
        return
    yield from ready()
    wm = bpy.context.window_manager
    view().spaces.active.shading.type = "SOLID"
    yield from _build_live()
    before = tuple(wm.xr_session_settings.base_pose_location), wm.xr_session_settings.clip_end
    remote = Headset()
    yield from _start("life size", 1.0)
    place = _viewer()
    yield from _aside(remote, 1.0)
    yield from _landmarks(remote)
    yield from _times(remote)
    yield from _moves(remote)
    call(bpy.ops.firetwin.vr_landmark, name="Ignition")
    yield 1.5
    yield from _teleport(remote, 1.0)
    picture("60-vr")
    yield from _stop()
    settings().vr_scale = "TABLE"
    yield from _start("table top", 1000.0)
    check((_viewer() - place).length > 100.0, "eyes are far above the ground of the scene")
    yield from _aside(remote, 1000.0)
    yield from _landmarks(remote)
    yield from _teleport(remote, 1000.0)
    yield from _stop()
    settings().vr_scale = "LIFE"
    after = tuple(wm.xr_session_settings.base_pose_location), wm.xr_session_settings.clip_end
    check(after == before, "the session settings are as before")


def _build_live() -> Iterator[object]:
    """Build the live scene, and show the film scene again."""
    from bl_ext.user_default.firetwin.scene.live import switch

    scene = bpy.context.scene
    if not switch.has_live(scene):
        call(bpy.ops.firetwin.live)
        yield 1
        yield idle
        yield 2
    check(switch.has_live(scene), "the live scene is built")
    if switch.is_live(scene):
        call(bpy.ops.firetwin.show_live)
    call(bpy.ops.firetwin.viewport_measure)
    yield 1
    call(bpy.ops.firetwin.show_live)
    call(bpy.ops.firetwin.viewport_measure)
    yield 1
    from bl_ext.user_default.firetwin.ui.viewport import facts, overlay

    for live in (False, True):
        say("; ".join(overlay.lines(facts.facts(scene), live, None)))
    settings().viewport_overlay = True
    yield from alone("FIRETWIN_PT_viewport", lambda: picture("59-viewport"))
    settings().viewport_overlay = False
    call(bpy.ops.firetwin.show_live)
    check(not switch.is_live(scene), "the film scene is shown before VR")


def _start(what: str, scale: float) -> Iterator[object]:
    """Start VR, and look at it: the landmark, the picture of an eye, and the time between frames."""
    from bl_ext.user_default.firetwin.scene.live import switch
    from bl_ext.user_default.firetwin.ui.vr import display

    check(call(bpy.ops.firetwin.vr_session) == {"FINISHED"}, f"VR starts: {what}")
    yield soon(lambda: _running() and _viewer().length > 0, 60)
    yield 2
    check(_running(), "Blender's session runs")
    check(switch.is_live(bpy.context.scene), "the live scene is shown in VR")
    name = settings().vr_landmark
    say(f"at {name}: {tuple(round(value, 3) for value in _viewer())}")
    check(_off(name) < _CENTIMETRE * scale, f"the viewer stands at {name} within 1 cm of the room")
    yield soon(lambda: display.frame_time() is not None, 60)
    words, slow = display.describe(display.frame_time())
    say(words)
    check(slow, "without a GPU, the panel warns of slow frames")
    eyes = Eyes()
    yield soon(lambda: len(eyes.seen) >= 2, 60)
    eyes.save(f"61-eye-{what.replace(' ', '-')}")
    eyes.close()


def _stop() -> Iterator[object]:
    """Stop VR."""
    from bl_ext.user_default.firetwin.scene.live import switch

    check(call(bpy.ops.firetwin.vr_session) == {"FINISHED"}, "VR stops")
    yield soon(lambda: not _running(), 60)
    yield 15  # Monado still ends it; another one would be one too many
    check(not _running(), "Blender's session has ended")
    check(not switch.is_live(bpy.context.scene), "the film scene is shown again")


def _aside(remote: Headset, scale: float) -> Iterator[object]:
    """A step in the room is a step in the scene, times the scale."""
    place = _viewer()
    remote.head(0.25, 1.6, 0.0)
    yield 2
    moved = (_viewer() - place).length / scale
    check(
        abs(moved - 0.25) < _CENTIMETRE,
        f"a step of 0.25 m aside moves the viewer by {moved:.3f} m * {scale:g}",
    )
    remote.head(0.0, 1.6, 0.0)
    yield 1


def _landmarks(remote: Headset) -> Iterator[object]:
    """The grips cut to the next landmark, out of black, and back."""
    first = settings().vr_landmark
    eyes = Eyes()
    yield from remote.click(RIGHT, FORCE)
    yield soon(lambda: max(alpha for _, alpha in eyes.seen) > 0.5 > eyes.seen[-1][1], 30)
    second = settings().vr_landmark
    check(second != first, f"the right grip goes from {first} to {second}")
    check(_off(second) < 1.0, f"the viewer is {_off(second):.3f} m from {second}")
    seen = [round(alpha, 2) for _, alpha in eyes.seen]
    eyes.close()
    check(max(seen) == 1.0 > seen[-1] + 0.5, f"the cut fades from black; opacity of each picture: {seen}")
    yield from remote.click(LEFT, FORCE)
    check(settings().vr_landmark == first and _off(first) < 1.0, f"the left grip goes back to {first}")


def _times(remote: Headset) -> Iterator[object]:
    """The right trigger plays and pauses; the right thumbstick moves time."""
    scene, screen = bpy.context.scene, bpy.context.window_manager.windows[0].screen
    yield from remote.click(RIGHT, TRIGGER)
    check(screen.is_animation_playing, "the right trigger plays")
    yield from remote.click(RIGHT, TRIGGER)
    check(not screen.is_animation_playing, "and pauses")
    scene.frame_set(1)
    remote.press(RIGHT, STICK, 1.0, 0.0)
    yield soon(lambda: scene.frame_current > 1, 30)
    remote.press(RIGHT, STICK, 0.0, 0.0)
    yield 1.5
    later = scene.frame_current
    check(later > 1, f"the right thumbstick moves time from frame 1 to {later}")
    remote.press(RIGHT, STICK, -1.0, 0.0)
    yield soon(lambda: scene.frame_current < later, 30)
    remote.press(RIGHT, STICK, 0.0, 0.0)
    yield 1.5
    check(scene.frame_current < later, f"and back to frame {scene.frame_current}")


def _moves(remote: Headset) -> Iterator[object]:
    """The left thumbstick turns in steps and flies."""
    place, turned = _viewer(), _state().viewer_pose_rotation.copy()
    remote.press(LEFT, STICK, 1.0, 0.0)
    yield 1.5
    remote.press(LEFT, STICK, 0.0, 0.0)
    yield 1.5
    angle = _state().viewer_pose_rotation.rotation_difference(turned).angle
    check(abs(angle - settings().vr_turn) < 1e-3, f"the left thumbstick turns by {angle:.4f} rad")
    check((_viewer() - place).length < _CENTIMETRE, "and the viewer stays in place")
    remote.press(LEFT, STICK, 0.0, 1.0)
    began = time.monotonic()
    yield soon(lambda: (_viewer() - place).length > 0.5, 30)
    remote.press(LEFT, STICK, 0.0, 0.0)
    yield 1
    say(f"flew {(_viewer() - place).length:.1f} m in {time.monotonic() - began:.1f} s")
    check((_viewer() - place).length > 0.5, "pushed forwards, it flies")


def _teleport(remote: Headset, scale: float) -> Iterator[object]:
    """The left trigger teleports to the ground that the controller points at."""
    from bl_ext.user_default.firetwin.blender import owned
    from bl_ext.user_default.firetwin.scene.camera import ground_raycast

    remote.point(LEFT, 0.5, -0.2, 1.3, -0.2)
    yield 2
    before, start = _viewer(), Vector(_state().controller_aim_location_get(bpy.context, 0))
    ray = Quaternion(_state().controller_aim_rotation_get(bpy.context, 0)) @ Vector((0.0, 0.0, -1.0))
    point = ground_raycast.cast_ray(owned.find_stage(bpy.context.scene), start, ray)
    check(point is not None, "the left controller points at the ground")
    say(f"which is {(point - start).length / scale:.2f} m away")
    remote.press(LEFT, TRIGGER, 1.0)
    yield 3
    eyes = Eyes()
    yield soon(lambda: len(eyes.seen) >= 2, 60)
    eyes.save(f"62-eye-pointing-{scale:g}")
    eyes.close()
    remote.press(LEFT, TRIGGER, 0.0)
    yield soon(lambda: _viewer() != before, 30)
    yield 1
    now, eye = _viewer(), Vector((0.0, 0.0, _STAND if scale == 1.0 else _STAND + scale * _HALF))
    off = (now - point - eye).length / scale
    say(f"moved {(now - before).length / scale:.2f} m")
    check(off < _CENTIMETRE, f"the left trigger teleports to this point within {100 * off:.1f} cm")
