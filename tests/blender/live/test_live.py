"""The live scene in the panel: built, switched, and built again with the scene."""

import bpy
import panel_scene
import pytest
from firetwin.scene.live import build, switch


@pytest.fixture
def panel(panel_blend, plain_looks, monkeypatch):
    """A built scene of the panel; its live scenes are small."""
    monkeypatch.setattr(build, "TRIANGLES", 8000)
    yield from panel_scene.opened(panel_blend)


def live():
    return bpy.data.objects.get("Firetwin Live Ground")


def test_it_is_built_shown_and_switched(panel):
    scene = bpy.context.scene
    with pytest.raises(RuntimeError, match="Build the live scene first"):
        bpy.ops.firetwin.show_live()
    assert bpy.ops.firetwin.live() == {"FINISHED"}
    assert switch.is_live(scene)
    for on in (False, True):
        assert bpy.ops.firetwin.show_live() == {"FINISHED"}
        assert switch.is_live(scene) == on


@pytest.mark.parametrize("on", [False, True])
def test_builds_of_what_it_shows_build_it_again(panel, on):
    bpy.ops.firetwin.live()
    switch.show_live(bpy.context.scene, on)
    first = live().session_uid
    bpy.ops.firetwin.build(part="light")
    assert live().session_uid == first
    bpy.ops.firetwin.build(part="terrain")
    assert live().session_uid != first
    assert switch.is_live(bpy.context.scene) == on


def test_builds_make_none_on_their_own(panel):
    bpy.ops.firetwin.build(part="terrain")
    assert not switch.has_live(bpy.context.scene)


def test_removing_the_scene_removes_it(panel):
    bpy.ops.firetwin.live()
    bpy.ops.firetwin.remove()
    assert live() is None
    assert not [image for image in bpy.data.images if image.name.startswith("Firetwin Live")]
