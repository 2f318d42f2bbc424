"""The German interface names every operator, panel and menu."""

import bpy
import firetwin
from firetwin.shot import schema
from firetwin.shot.sections import Time
from firetwin.shot.settings import Render
from firetwin.ui import keys, translations

KINDS = bpy.types.Operator | bpy.types.Panel | bpy.types.Menu


def test_every_name_has_a_translation_and_none_is_left_over():
    names = {cls.bl_label for cls in firetwin.ui.classes if issubclass(cls, KINDS)}
    assert names == set(translations.GERMAN)


def test_translated_settings_exist():
    labels = {keys.label(part.name) for part in (*schema.fields(Render), *schema.fields(Time))}
    assert set(translations.SETTINGS) <= labels


def test_codecs_have_their_names():
    codec = next(part for part in schema.fields(Render) if part.name == "film_codec")
    assert [label for _, label, _ in keys.items(codec.key)] == ["H.264", "H.265", "ProRes"]


def test_blender_translates_them(factory):
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    try:
        assert bpy.app.translations.pgettext_iface("Build scene") == "Build scene"
        assert ("Operator", "Build scene") in translations.table()["de_DE"]
    finally:
        firetwin.unregister()
