"""Blender's permission to use the network: checked first, and named if it is missing."""

import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest
from firetwin import cli
from firetwin.errors import InputError
from firetwin.jobs.tiles import access as job
from firetwin.jobs.tiles.access import TileAccess
from firetwin.jobs.tiles.source import open_tileset
from firetwin.shot.sections.tiles import TileSettings
from firetwin.shot.settings import Settings
from firetwin.tiles.loader import Loader
from firetwin.tiles.sources import open_source
from lying_server import serving
from tilesets import GLB, tile, tileset, write

MANIFEST = Path(job.__file__).parents[2] / "blender_manifest.toml"


@pytest.fixture
def blender(monkeypatch):
    """Let this process be Blender with its window, online or not."""

    def make(online):
        app = SimpleNamespace(module=False, online_access=online)
        monkeypatch.setitem(job.sys.modules, "bpy", SimpleNamespace(app=app))

    return make


@pytest.mark.parametrize(
    ("option", "setting", "opened"),
    [("", "", False), ("", ".", True), ("DIR", "", True), ("DIR", "elsewhere", True)],
)
def test_a_folder_above_comes_from_the_option_or_else_from_the_scene_file(tmp_path, option, setting, opened):
    folder = write(tmp_path, {"a/tileset.json": tileset(tile(8.0, "../x.glb")), "x.glb": GLB})
    tiles = TileSettings(sources=("a",), root=setting)
    shot = SimpleNamespace(settings=Settings(path=tmp_path / "scene.toml", tiles=tiles))
    access = TileAccess(root=str(folder) if option else "")
    loader = Loader(open_tileset(shot, 0, access))
    if opened:
        loader.check([0])
    else:
        with pytest.raises(InputError, match="leaves the tileset's folder"):
            loader.check([0])


def test_blender_is_asked_and_the_preference_is_named(blender, capsys):
    blender(True)
    assert job.apply_preferences(TileAccess()) == TileAccess()
    blender(False)
    access = job.apply_preferences(TileAccess(strict=True))
    assert (access.strict, access.online, access.setting) == (True, False, job.PREFERENCE)
    with serving() as server:
        source = open_source(f"{server.url}/tileset.json", access.network())
        with pytest.raises(InputError, match="System > Network > Allow Online Access"):
            source.read(source.root)
        source.close()
        assert cli.main(["tiles", "info", f"{server.url}/tileset.json"]) == 1
        assert server.asked == []
    assert "Allow Online Access" in capsys.readouterr().err


def test_files_of_this_machine_need_no_permission(blender, tmp_path, capsys):
    blender(False)
    (tmp_path / "tileset.json").write_text(
        '{"asset": {"version": "1.1"}, "geometricError": 1, "root": {"geometricError": 0, "refine": "ADD", '
        '"boundingVolume": {"sphere": [0, 0, 0, 1]}}}'
    )
    assert cli.main(["tiles", "info", str(tmp_path)]) == 0


def test_python_without_blenders_window_has_no_such_preference(monkeypatch):
    monkeypatch.delitem(job.sys.modules, "bpy", raising=False)
    assert job.is_online()
    app = SimpleNamespace(module=True, online_access=False)
    monkeypatch.setitem(job.sys.modules, "bpy", SimpleNamespace(app=app))
    assert job.is_online()


def test_the_extension_says_what_it_uses_the_network_for():
    """Blender shows it: a short reason, without a full stop."""
    said = tomllib.loads(MANIFEST.read_text(encoding="utf-8"))["permissions"]
    assert set(said) == {"files", "network"}
    assert all(len(text) <= 64 and text[-1] != "." for text in said.values())
