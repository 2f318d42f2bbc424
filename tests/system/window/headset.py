"""A VR session with Monado's remote headset, whose head and controllers this process moves.

The packet is `struct r_remote_data` of Monado 25 (src/xrt/drivers/remote/r_interface.h): 376 bytes, little
endian, with the head's centre and a record for each controller. After a connection Monado sends its own.
"""

from __future__ import annotations

import os
import socket
import struct
import time
from collections.abc import Iterator

import bpy
from hands import call, check, picture, ready, say, settings, soon, view
from mathutils import Vector

_SIZE, _HEADER = 376, b"mndrmt3\0"
_HEAD = 8 + 2 * 48 + 16  # position of the head's centre, after two views and its rotation
_LEFT, _RIGHT = 136, 256
_TRIGGER, _SQUEEZE, _FORCE, _STICK, _ACTIVE = 72, 76, 80, 84, 105
_CENTIMETRE = 0.01


class Headset:
    """Connection to Monado's remote driver."""

    def __init__(self) -> None:
        self._link = socket.create_connection(("127.0.0.1", 4242), 10)
        data = b""
        while len(data) < 2 * _SIZE:
            data += self._link.recv(2 * _SIZE - len(data))
        self._data = bytearray(data[_SIZE:])
        check(bytes(self._data[:8]) == _HEADER, "Monado speaks the known protocol")
        for hand in (_LEFT, _RIGHT):
            self._data[hand + _ACTIVE] = 1
        self._send()

    def _send(self) -> None:
        self._link.sendall(self._data)

    def head(self, east: float, up: float, south: float) -> None:
        """Move the head (m) in the room."""
        struct.pack_into("<3f", self._data, _HEAD, east, up, south)
        self._send()

    def press(self, hand: int, at: int, *values: float) -> None:
        """Set a control of a controller."""
        struct.pack_into(f"<{len(values)}f", self._data, hand + at, *values)
        self._send()


def _running() -> bool:
    return bpy.types.XrSessionState.is_running(bpy.context)


def _state() -> bpy.types.XrSessionState:
    return bpy.context.window_manager.xr_session_state


def _viewer() -> Vector:
    return Vector(_state().viewer_pose_location)


def _stands_at(name: str) -> bool:
    """Return whether the viewer is within 1 cm of the landmark."""
    from bl_ext.user_default.firetwin.ui.vr import landmark_list

    found = landmark_list.pose(bpy.context.scene, name)
    return found is not None and (_viewer() - found.place).length < _CENTIMETRE


def _click(headset: Headset, hand: int, at: int) -> Iterator[object]:
    """Press a control for a moment."""
    headset.press(hand, at, 1.0)
    yield 1.5
    headset.press(hand, at, 0.0)
    yield 1.5


def headset() -> Iterator[object]:
    """Start VR, walk through landmarks and time with the controllers, and stop."""
    if not os.environ.get("XR_RUNTIME_JSON"):
        say("SKIPPED: VR session, because Monado is not installed here")
        return
    yield from ready()
    scene, wm = bpy.context.scene, bpy.context.window_manager
    hidden = [thing for thing in scene.objects if thing.type == "VOLUME" and not thing.hide_get()]
    view().spaces.active.shading.type = "SOLID"
    before = tuple(wm.xr_session_settings.base_pose_location), wm.xr_session_settings.clip_end
    remote = Headset()
    check(call(bpy.ops.firetwin.vr_session) == {"FINISHED"}, "VR starts")
    yield soon(lambda: _running() and _viewer().length > 0, 60)
    yield 2
    check(_running(), "Blender's session runs")
    name = settings().vr_landmark
    say(f"at {name}: {tuple(round(value, 3) for value in _viewer())}")
    check(_stands_at(name), f"the viewer stands at {name} within 1 cm")
    place = _viewer()
    remote.head(0.25, 1.6, 0.0)
    yield 2
    moved = (_viewer() - place).length
    check(abs(moved - 0.25) < _CENTIMETRE, f"a step of 0.25 m aside moves the viewer by {moved:.3f} m")
    remote.head(0.0, 1.6, 0.0)
    yield 1
    yield from _landmarks(remote)
    yield from _times(remote)
    yield from _moves(remote)
    picture("60-vr")
    check(call(bpy.ops.firetwin.vr_session) == {"FINISHED"}, "VR stops")
    yield soon(lambda: not _running(), 60)
    yield 2
    after = tuple(wm.xr_session_settings.base_pose_location), wm.xr_session_settings.clip_end
    check(after == before, "the session settings are as before")
    say(f"{len(hidden)} volumes were drawn")


def _landmarks(remote: Headset) -> Iterator[object]:
    """The grips cut to the next landmark and back."""
    first = settings().vr_landmark
    yield from _click(remote, _RIGHT, _FORCE)
    second = settings().vr_landmark
    check(second != first, f"the right grip goes from {first} to {second}")
    check(_stands_at(second), f"the viewer stands at {second} within 1 cm")
    yield from _click(remote, _LEFT, _FORCE)
    check(settings().vr_landmark == first and _stands_at(first), f"the left grip goes back to {first}")


def _times(remote: Headset) -> Iterator[object]:
    """The right trigger plays and pauses; the right thumbstick moves time."""
    scene, screen = bpy.context.scene, bpy.context.window_manager.windows[0].screen
    yield from _click(remote, _RIGHT, _TRIGGER)
    check(screen.is_animation_playing, "the right trigger plays")
    yield from _click(remote, _RIGHT, _TRIGGER)
    check(not screen.is_animation_playing, "and pauses")
    scene.frame_set(1)
    remote.press(_RIGHT, _STICK, 1.0, 0.0)
    yield soon(lambda: scene.frame_current > 1, 30)
    remote.press(_RIGHT, _STICK, 0.0, 0.0)
    yield 1.5
    later = scene.frame_current
    check(later > 1, f"the right thumbstick moves time from frame 1 to {later}")
    remote.press(_RIGHT, _STICK, -1.0, 0.0)
    yield soon(lambda: scene.frame_current < later, 30)
    remote.press(_RIGHT, _STICK, 0.0, 0.0)
    yield 1.5
    check(scene.frame_current < later, f"and back to frame {scene.frame_current}")


def _moves(remote: Headset) -> Iterator[object]:
    """The left thumbstick turns in steps and flies."""
    place, turned = _viewer(), _state().viewer_pose_rotation.copy()
    remote.press(_LEFT, _STICK, 1.0, 0.0)
    yield 1.5
    remote.press(_LEFT, _STICK, 0.0, 0.0)
    yield 1.5
    angle = _state().viewer_pose_rotation.rotation_difference(turned).angle
    check(abs(angle - settings().vr_turn) < 1e-3, f"the left thumbstick turns by {angle:.4f} rad")
    check((_viewer() - place).length < _CENTIMETRE, "and the viewer stays in place")
    remote.press(_LEFT, _STICK, 0.0, 1.0)
    began = time.monotonic()
    yield soon(lambda: (_viewer() - place).length > 0.5, 30)
    remote.press(_LEFT, _STICK, 0.0, 0.0)
    yield 1
    say(f"flew {(_viewer() - place).length:.1f} m in {time.monotonic() - began:.1f} s")
    check((_viewer() - place).length > 0.5, "pushed forwards, it flies")
