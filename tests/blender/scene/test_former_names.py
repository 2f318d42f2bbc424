"""Settings of .blend files that were saved while sections had other names."""

import bpy
import firetwin
import pytest
from firetwin.blender import compat, owned
from firetwin.ui import former_names


@pytest.fixture
def panel(scene):
    firetwin.register()
    yield scene.firetwin
    firetwin.unregister()


def test_a_file_of_the_last_version_keeps_its_settings(panel, tmp_path, capsys):
    """Such a file is made of one of this version, whose section is stored under its former name."""
    panel.terrain.error, panel.labels.enabled, panel.forest.budget = 0.7, True, 17
    stored = compat.stored_properties(bpy.context.scene)["firetwin"]
    for former, name in (("ground", "terrain"), ("places", "labels")):
        stored[former] = stored[name].to_dict()
        del stored[name]
    stored["render"] = {"skip": 0, "cull": 0}  # removed keys
    stored["ground"]["stand"] = 1
    stored["time"] = {"fps": 12}  # an integer property then
    stored["tiles"] = {"error": 3.0, "trees": 2, "exact": '{"error": 3.123456789}'}
    assert panel.terrain.error != pytest.approx(0.7)
    collection = owned.mark(bpy.data.collections.new("Firetwin Ground"), "Ground")
    bpy.context.scene.collection.children.link(collection)
    path = tmp_path / "former.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    settings = bpy.context.scene.firetwin
    assert (settings.terrain.error, settings.labels.enabled, settings.forest.budget) == (
        pytest.approx(0.7),
        True,
        17,
    )
    assert settings.time.fps == 12.0
    assert (settings.terrain.height_source, settings.tiles.vegetation) == ("tiles", "scene_near_burn")
    assert settings.tiles.max_screen_space_error == pytest.approx(3.0)
    assert settings.tiles.exact == '{"max_screen_space_error": 3.123456789}'
    assert owned.is_ours(bpy.data.collections["Firetwin Terrain"], "Terrain")
    assert "ground" not in compat.stored_properties(bpy.context.scene)["firetwin"]
    note = capsys.readouterr().err
    assert "[ground] is called [terrain] now" in note
    assert "tiles.error is called tiles.max_screen_space_error now" in note


class Group(dict):
    """Stored values of a section, as Blender gives them."""

    def to_dict(self):
        return dict(self)


@pytest.mark.parametrize("kind", ["number", "text", "list", "exact number", "nested exact"])
def test_values_of_other_types_are_left_out(panel, monkeypatch, kind):
    values = {"number": 7, "text": "exact", "list": [1, 2]}
    values |= {"exact number": Group(exact=7, error=3.0), "nested exact": Group(exact="[" * 100_000)}
    value, names = values[kind], ("ground", "places", "tiles", "time", "terrain")
    for stored in (value, Group({name: value for name in names})):
        monkeypatch.setattr(compat, "stored_properties", lambda _, stored=stored: {"firetwin": stored})
        former_names.migrate()


def test_presets_of_the_last_version_are_updated(tmp_path, monkeypatch):
    path = tmp_path / "mine.py"
    path.write_text(
        "import bpy\nfiretwin = bpy.context.scene.firetwin\n\nfiretwin.seed = 1\n"
        "firetwin.ground.stand = 'tiles'\n"
        "firetwin.render.skip = True\nfiretwin.smoke.method = 'puffs'\n"
        "firetwin.tiles.error = 3.0\nfiretwin.tiles.trees = 'theirs'\n"
        "firetwin.tiles.use_geoid = False\n"
    )
    (tmp_path / "other.py").symlink_to("/dev/zero")
    monkeypatch.setattr(bpy.utils, "preset_paths", lambda _: [str(tmp_path)])
    former_names.update_presets()
    assert path.read_text().splitlines()[3:] == [
        "firetwin.seed = 1",
        "firetwin.terrain.height_source = 'tiles'",
        "",
        "firetwin.smoke.method = 'preview'",
        "firetwin.tiles.max_screen_space_error = 3.0",
        "firetwin.tiles.vegetation = 'tileset'",
        "firetwin.tiles.use_geoid = False",
    ]


def test_nothing_is_left_when_the_extension_goes(panel):
    assert former_names.migrate in bpy.app.handlers.load_post
    firetwin.unregister()
    assert former_names.migrate not in bpy.app.handlers.load_post
    firetwin.register()
