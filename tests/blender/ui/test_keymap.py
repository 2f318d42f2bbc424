"""Shortcuts: no key of Blender is taken, users can change them, and a flight sets camera keys."""

import importlib.util
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import pytest
from firetwin.ui import fly, keymap

AROUND = ("3D View", "3D View Generic", "Object Mode", "Object Non-modal", "Frames", "Window", "Screen")
"""Key maps of Blender in which a key works in the 3D view in object mode."""


pytestmark = pytest.mark.usefixtures("registered")


def of_blender():
    """Keys and modifiers of Blender's own key configuration, by key map."""
    folder = next(
        Path(path) for path in bpy.utils.preset_paths("keyconfig") if (Path(path) / "keymap_data").is_dir()
    )
    spec = importlib.util.spec_from_file_location(
        "blender_default", folder / "keymap_data/blender_default.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return {
        name: {_chord(item[1]) for item in content["items"]}
        for name, _, content in module.generate_keymaps(module.Params())
    }


def _chord(event):
    return event["type"], *(bool(event.get(name)) for name in ("ctrl", "alt", "shift"))


def test_no_shortcut_of_blender_is_taken():
    ours = {_chord({"type": key} | more) for *_, key, more in keymap.SHORTCUTS}
    maps = of_blender()
    theirs = set().union(*(maps[name] for name in AROUND))
    assert ("G", False, False, False) in theirs
    assert not ours & theirs


def test_shortcuts_are_in_the_key_configuration_of_add_ons():
    items = bpy.context.window_manager.keyconfigs.addon.keymaps["3D View"].keymap_items
    assert [item.idname for item in items] == [operator for operator, *_ in keymap.SHORTCUTS]


def added_by_add_ons():
    """Key maps of add-ons and their operators."""
    keymaps = bpy.context.window_manager.keyconfigs.addon.keymaps
    return {place.name: [item.idname for item in place.keymap_items] for place in keymaps}


@pytest.mark.parametrize("when", ["never", "before", "after"])
def test_key_maps_are_left_as_they_were(when):
    """Another add-on adds a key to the same key map before or after Firetwin, or never."""

    def other():
        place = bpy.context.window_manager.keyconfigs.addon.keymaps.new("3D View", space_type="VIEW_3D")
        return place, place.keymap_items.new("view3d.view_all", "F13", "PRESS")

    keymap.unregister()
    without = added_by_add_ons()
    assert "3D View" not in without
    theirs = other() if when == "before" else None
    keymap.register()
    theirs = other() if when == "after" else theirs
    keymap.unregister()
    try:
        assert added_by_add_ons() == without | ({"3D View": ["view3d.view_all"]} if theirs else {})
    finally:
        if theirs:
            theirs[0].keymap_items.remove(theirs[1])
            bpy.context.window_manager.keyconfigs.addon.keymaps.remove(theirs[0])
        keymap.register()
    assert added_by_add_ons()["3D View"] == [operator for operator, *_ in keymap.SHORTCUTS]


def flight(monkeypatch, running=("VIEW3D_OT_walk",)):
    """An operator that watches a flight, and its context."""
    monkeypatch.setattr(keymap, "key_of", lambda operator: "K")
    context = MagicMock()
    context.window.modal_operators = [SimpleNamespace(bl_idname=name) for name in running]
    watch = SimpleNamespace(report=MagicMock(), _set_key=MagicMock())
    return watch, context


@pytest.mark.parametrize(
    ("running", "key", "result", "keyed"),
    [
        (("VIEW3D_OT_walk",), "K", {"RUNNING_MODAL"}, 1),
        (("VIEW3D_OT_fly",), "W", {"PASS_THROUGH"}, 0),
        ((), "K", {"FINISHED", "PASS_THROUGH"}, 0),
    ],
)
def test_the_key_sets_camera_keys_during_a_flight(monkeypatch, running, key, result, keyed):
    watch, context = flight(monkeypatch, running)
    event = SimpleNamespace(type=key, value="PRESS")
    assert fly.FIRETWIN_OT_fly.modal(watch, context, event) == result
    assert watch._set_key.call_count == keyed
