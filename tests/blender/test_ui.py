"""The add-on registers and unregisters without a trace, and its operator tells what is wrong."""

import bpy
import firetwin
import pytest


@pytest.fixture
def registered():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    firetwin.register()
    yield
    if hasattr(bpy.types.Scene, "firetwin"):
        firetwin.unregister()


def names():
    return {name for name in dir(bpy.types) if name.startswith("FIRETWIN")}


def test_unregister_leaves_nothing(registered):
    assert names() == {"FIRETWIN_OT_build", "FIRETWIN_PT_project"}
    firetwin.unregister()
    assert not names()
    assert not hasattr(bpy.types.Scene, "firetwin")
    firetwin.register()
    assert names()


def test_build_needs_a_scene_file(registered):
    assert not bpy.ops.firetwin.build.poll()
    bpy.context.scene.firetwin.scene_file = "//missing.toml"
    assert bpy.ops.firetwin.build.poll()


def test_a_missing_scene_file_is_one_clear_report(registered, tmp_path):
    bpy.context.scene.firetwin.scene_file = str(tmp_path / "missing.toml")
    before = set(bpy.data.objects)
    with pytest.raises(RuntimeError, match=r"missing\.toml"):
        bpy.ops.firetwin.build()
    assert set(bpy.data.objects) == before
