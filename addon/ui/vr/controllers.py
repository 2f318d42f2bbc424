"""Actions of the controllers in a VR session of a built scene, for the controllers that OpenXR itself names.

| control | right hand | left hand |
|---|---|---|
| trigger | play or pause | teleport to the ground that the controller points at |
| grip | next landmark | previous landmark |
| thumbstick, left and right | move time | turn in steps |
| thumbstick, forwards and back | | fly |

Blender has one active set of actions. In scenes that are not built, the sets of other add-ons stay active.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy

from .. import panel_state

NAME = "firetwin"
_LEFT, _RIGHT = "/user/hand/left", "/user/hand/right"
_PRESSED = 0.5  # of the trigger's or thumbstick's range
_PROFILES = {
    "index": "valve/index_controller",
    "oculus": "oculus/touch_controller",
    "vive": "htc/vive_controller",
    "wmr": "microsoft/motion_controller",
    "simple": "khr/simple_controller",
}
_TRIGGER = {
    "index": "trigger/value",
    "oculus": "trigger/value",
    "vive": "trigger/value",
    "wmr": "trigger/value",
    "simple": "select/click",
}
_GRIP = {
    "index": "squeeze/force",
    "oculus": "squeeze/value",
    "vive": "squeeze/click",
    "wmr": "squeeze/click",
    "simple": "menu/click",
}
_STICK = {"index": "thumbstick", "oculus": "thumbstick", "vive": "trackpad", "wmr": "thumbstick"}
_ACROSS = {name: f"{path}/x" for name, path in _STICK.items()}
_ALONG = {name: f"{path}/y" for name, path in _STICK.items()}


class Action(NamedTuple):
    """An action: hand, operator, mode, control of each controller, side of its axis, operator options."""

    hand: str
    operator: str
    mode: str
    controls: dict[str, str]
    side: str = "ANY"
    options: dict[str, Any] = {}


ACTIONS = {
    "play": Action(_RIGHT, "firetwin.vr_play", "PRESS", _TRIGGER),
    "teleport": Action(_LEFT, "firetwin.vr_teleport", "MODAL", _TRIGGER),
    "next": Action(_RIGHT, "firetwin.vr_landmark", "PRESS", _GRIP, options={"step": 1}),
    "previous": Action(_LEFT, "firetwin.vr_landmark", "PRESS", _GRIP, options={"step": -1}),
    "later": Action(_RIGHT, "firetwin.vr_time", "MODAL", _ACROSS, "POSITIVE", {"direction": 1}),
    "earlier": Action(_RIGHT, "firetwin.vr_time", "MODAL", _ACROSS, "NEGATIVE", {"direction": -1}),
    "turn_left": Action(_LEFT, "firetwin.vr_turn", "PRESS", _ACROSS, "NEGATIVE", {"direction": 1}),
    "turn_right": Action(_LEFT, "firetwin.vr_turn", "PRESS", _ACROSS, "POSITIVE", {"direction": -1}),
    "fly": Action(_LEFT, "wm.xr_navigation_fly", "MODAL", _ALONG, "POSITIVE", {"mode": "VIEWER_FORWARD"}),
    "fly_back": Action(_LEFT, "wm.xr_navigation_fly", "MODAL", _ALONG, "NEGATIVE", {"mode": "VIEWER_BACK"}),
}
_POSES = {"grip": "pose_is_controller_grip", "aim": "pose_is_controller_aim"}


def _add_action(actions: bpy.types.XrActionMap, name: str, action: Action) -> None:
    """Add an action and its bindings to the map."""
    item = actions.actionmap_items.new(name, True)
    item.type, item.op, item.op_mode = "FLOAT", action.operator, action.mode
    item.user_paths.new(action.hand)
    for option, value in action.options.items():
        setattr(item.op_properties, option, value)
    for controller, control in action.controls.items():
        binding = item.bindings.new(controller, True)
        binding.profile = f"/interaction_profiles/{_PROFILES[controller]}"
        binding.component_paths.new(f"/input/{control}")
        binding.threshold, binding.axis0_region = _PRESSED, action.side


def _add_pose(actions: bpy.types.XrActionMap, name: str, kind: str) -> None:
    """Add the pose of both controllers to the map."""
    item = actions.actionmap_items.new(f"controller_{name}", True)
    item.type = "POSE"
    setattr(item, kind, True)
    for hand in (_LEFT, _RIGHT):
        item.user_paths.new(hand)
    for controller, profile in _PROFILES.items():
        binding = item.bindings.new(controller, True)
        binding.profile = f"/interaction_profiles/{profile}"
        for _ in (_LEFT, _RIGHT):
            binding.component_paths.new(f"/input/{name}/pose")


def create_map(state: bpy.types.XrSessionState) -> bpy.types.XrActionMap:
    """Create the map of all actions, in place of an older one."""
    old = state.actionmaps.find(state, NAME)
    if old is not None:
        state.actionmaps.remove(state, old)
    actions = state.actionmaps.new(state, NAME, True)
    for name, action in ACTIONS.items():
        _add_action(actions, name, action)
    for name, kind in _POSES.items():
        _add_pose(actions, name, kind)
    return actions


@bpy.app.handlers.persistent
def _add_actions(_: object) -> None:
    """Create and activate the actions in a session that begins in a built scene."""
    context = bpy.context
    state = context.window_manager.xr_session_state
    if state is None or not panel_state.is_built(context.scene):
        return
    actions = create_map(state)
    if not state.action_set_create(context, actions):
        return
    for item in actions.actionmap_items:
        if not state.action_create(context, actions, item):
            return
        for binding in item.bindings:
            state.action_binding_create(context, actions, item, binding)
    state.controller_pose_actions_set(context, NAME, "controller_grip", "controller_aim")
    state.active_action_set_set(context, NAME)


def register() -> None:
    """Add the actions when a session starts, after other add-ons."""
    bpy.app.handlers.xr_session_start_pre.append(_add_actions)


def unregister() -> None:
    """Undo `register`."""
    bpy.app.handlers.xr_session_start_pre.remove(_add_actions)
