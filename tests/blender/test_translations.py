"""The German interface names every operator, panel and menu."""

import bpy
import firetwin
from firetwin.ui import translations

KINDS = bpy.types.Operator | bpy.types.Panel | bpy.types.Menu


def test_every_name_has_a_translation_and_none_is_left_over():
    names = {cls.bl_label for cls in firetwin.ui.classes if issubclass(cls, KINDS)}
    assert names == set(translations.GERMAN)


def test_blender_translates_them(factory):
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    try:
        assert bpy.app.translations.pgettext_iface("Build scene") == "Build scene"
        assert ("Operator", "Build scene") in translations.table()["de_DE"]
    finally:
        firetwin.unregister()
