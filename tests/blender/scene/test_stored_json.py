"""Tables stored in a .blend file: a text of others counts as none, and panels still draw."""

import bpy
import firetwin
import pytest
from firetwin.allocation.panel import text as allocation_text
from firetwin.blender import owned
from firetwin.scene import credits
from firetwin.scene.camera import edit_detection
from firetwin.ui import auto_framing, changed_settings, events, landmarks, place_names, run, tile_facts, time

FACTS = '{"name": "a", "moments": [["", "b"]], "places": [["c", "d", 1, ""]], "sources": [7], "rows": 1}'
ODD = [
    FACTS,
    "no JSON",
    "[" * 100_000,
    "7",
    "[1, 2]",
    '{"ignition": 7, "frames": [1], "head": {}}',
    '[["a"], 7]',
]


@pytest.fixture
def panel(scene):
    firetwin.register()
    yield scene.firetwin
    firetwin.unregister()


@pytest.mark.parametrize("text", ODD, ids=range(len(ODD)))
def test_texts_of_others_count_as_none(panel, text):
    panel.landmarks = panel.built = panel.usual = text
    assert landmarks.list_names(panel) == []
    assert landmarks.find(panel, "head") is None
    changed_settings.compare(panel)
    assert panel.changed == ""
    changed_settings.store_digests(panel, {"terrain": "a"}, ("terrain",))
    assert auto_framing.framing_messages(panel) == []
    panel.facts = panel.tile_facts = text
    assert events.list_events(panel) == time.dated_events(panel) == []
    assert place_names.list_labels(panel) == ()
    assert run.parse_facts(text)["rows"] == tile_facts.read(text)["sources"] == []
    assert run.parse_facts(text)["name"] == ("a" if text == FACTS else "")
    assert "suggest again" in allocation_text.describe(text).head[0]
    obj = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    edit_detection.store_state(obj)
    obj["firetwin_made"] = text
    assert edit_detection.changed_parts(obj) >= {"name", "pose"}


@pytest.mark.parametrize("text", ODD, ids=range(len(ODD)))
def test_odd_credits_count_as_none(scene, text):
    root, part = bpy.data.collections.new("root"), bpy.data.collections.new("part")
    stage = owned.Stage(scene, root)
    root.children.link(part)
    part.objects.link(bpy.data.objects.new("tile", None))
    for value in (text, 7):
        part[credits.PROPERTY] = value
        assert not credits.read_scene(stage)
