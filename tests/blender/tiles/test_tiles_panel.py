"""The panel of tiles: boxes at once, coarse tiles, numbers, credits, and everything gone again."""

import pickle
import shutil
from dataclasses import replace

import bpy
import firetwin
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.errors import InputError
from firetwin.jobs import worker
from firetwin.jobs.tiles import bounding_boxes
from firetwin.jobs.worker import StoppedError
from firetwin.scene.tiles import preview, reuse
from firetwin.shot import schema
from firetwin.shot.sections import TileSettings
from firetwin.shot.terrain import tile_heights
from firetwin.shot.tiles import tile_cut
from firetwin.ui import job, keys, scene_file, tile_credits, tile_facts, tiles_panel
from tiles_scene import *  # noqa: F403

pytestmark = pytest.mark.usefixtures("decoded_here", "plain_tiles")


@pytest.fixture
def here(monkeypatch):
    """Jobs run within this process."""

    def run(work, progress=None, tell=None, stop=None, **_):
        if stop is not None and stop.asked:
            raise StoppedError
        found = pickle.loads(pickle.dumps(work))(progress=progress or (lambda *_: None), tell=tell or print)
        return pickle.loads(pickle.dumps(found))

    monkeypatch.setattr(worker, "run", run)


@pytest.fixture
def tiled_panel(panel, here, settings, prepared_tiles, tmp_path, monkeypatch):
    """The panel of a small shot with a tileset of its ground next to the scene file."""
    shutil.copytree(prepared_tiles / "set", tmp_path / "set")
    monkeypatch.setattr(tile_heights, "_MOST", 200)  # points of heights, which nothing here looks at
    panel.output = str(tmp_path / "out")
    bare = replace(settings.forest, trees=False)
    named = replace(settings.tiles, sources=("set",), max_screen_space_error=2.0, geoid=-24.9)
    scene_file.fill(panel.id_data, replace(settings, tiles=named, forest=bare))
    assert not panel.problem
    return bpy.context.scene.firetwin


def preview_objects():
    return owned.stage(bpy.context.scene).objects_of(preview.PART)


def test_a_source_beside_the_scene_file_is_found_from_the_panel(tiled_panel, tmp_path):
    assert scene_file.read_settings(bpy.context.scene).tiles.sources == (str(tmp_path / "set"),)


@pytest.mark.parametrize(
    "text", ['"a/b", "https://x/t.json"', "a/b,https://x/t.json", ' a/b, "https://x/t.json']
)
def test_sources_are_typed_with_or_without_quotation_marks(panel, text):
    (part,) = (each for each in schema.fields(TileSettings) if each.name == "sources")
    panel.tiles.sources = text
    assert keys.take(panel.tiles, part) == ("a/b", "https://x/t.json")


def test_boxes_are_one_object_of_lines(tiled_panel):
    assert bpy.ops.firetwin.tiles_preview(boxes=True) == {"FINISHED"}
    (obj,) = preview_objects()
    facts = tile_facts.read(tiled_panel.tile_facts)
    assert len(facts["sources"]) == 1
    assert facts["credits"] == ["Somebody"]
    assert len(obj.data.vertices) % 8 == 0 < len(obj.data.vertices)
    assert len(obj.data.edges) == 12 * len(obj.data.vertices) // 8
    assert not obj.data.polygons
    assert obj.hide_render
    place = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", place)
    assert np.abs(place.reshape(-1, 3)[:, 2] - 1400.0).max() < 1500.0  # about the heights of the run
    assert 3000.0 < np.ptp(place.reshape(-1, 3)[:, 0]) < 20_000.0
    edges = np.empty(2 * len(obj.data.edges), np.int32)
    obj.data.edges.foreach_get("vertices", edges)
    assert np.bincount(edges).tolist() == [3] * len(obj.data.vertices)


def test_coarse_tiles_are_shown_and_those_of_the_film_are_ready(tiled_panel):
    assert bpy.ops.firetwin.tiles_preview() == {"FINISHED"}
    shown = [obj for obj in preview_objects() if obj.data.polygons]
    assert shown
    assert any(not obj.data.polygons for obj in preview_objects())
    assert [each.name for each in shown[0].data.materials] == ["Firetwin Tile Preview", "Firetwin Tiles 1"]
    lines = dict(tile_facts.read(tiled_panel.tile_facts)["lines"])
    assert "triangles" in lines["Film"]
    assert lines["Error"] == "2 pixels"
    assert "ready: Build scene shows them" in job.Job.last.messages[-1].text
    assert len(bpy.data.scenes) == 1


@pytest.mark.slow  # two builds of the terrain
def test_a_build_replaces_the_preview(tiled_panel):
    bpy.ops.firetwin.tiles_preview()
    assert bpy.ops.firetwin.build(part="terrain") == {"FINISHED"}
    assert not preview_objects()
    assert len(bpy.data.scenes) == 1
    assert owned.stage(bpy.context.scene).objects_of("Tiles")
    assert "Built" in dict(tile_facts.read(tiled_panel.tile_facts)["lines"])
    meshes = {each.session_uid for each in bpy.data.meshes if reuse.TILE in each}
    assert bpy.ops.firetwin.build(part="terrain") == {"FINISHED"}
    assert meshes == {each.session_uid for each in bpy.data.meshes if reuse.TILE in each} != set()
    bpy.ops.firetwin.remove()
    assert not tiled_panel.tile_facts
    assert not tile_credits.shown()


def test_credits_are_drawn_while_there_are_tiles(tiled_panel):
    assert not tile_credits.shown()
    bpy.ops.firetwin.tiles_preview(boxes=True)
    assert tiled_panel.tile_credits == "Somebody"
    assert tile_credits.shown()
    bpy.ops.firetwin.tiles_clear()
    assert not tile_credits.shown()
    assert not preview_objects()
    bpy.ops.firetwin.tiles_preview(boxes=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not tile_credits.shown()
    assert bpy.context.scene.firetwin.tile_credits == ""
    firetwin.unregister()
    assert not tile_credits.shown()
    assert not any(
        getattr(each, "__module__", "") == tile_credits.__name__
        for name in ("load_post", "undo_post", "redo_post")
        for each in getattr(bpy.app.handlers, name)
    )


def test_without_a_source_the_tooltip_says_what_is_missing(panel):
    assert not bpy.ops.firetwin.tiles_preview.poll()
    with pytest.raises(RuntimeError, match="Name a tileset in Sources"):
        bpy.ops.firetwin.tiles_preview()


def test_a_source_that_cannot_be_read_is_told(tiled_panel, monkeypatch):
    def refuse(*_, **__):
        raise InputError("city", 0, 0, "network access is not allowed; allow it in Preferences > System")

    monkeypatch.setattr(bounding_boxes, "run", refuse)
    with pytest.raises(RuntimeError, match="network access is not allowed"):
        bpy.ops.firetwin.tiles_preview()
    assert not preview_objects()
    assert not tiled_panel.tile_facts


def test_a_stop_between_the_steps_ends_the_preview(tiled_panel):
    """In the window an undo follows (see `working`); here the tiles shown so far stay."""
    work = job.Job("Preview tiles", tiles_panel.steps(bpy.context, False))
    while work.what != "drawing the boxes":
        work.advance()
    work.stop.now()
    with pytest.raises(StoppedError):
        work.run()
    assert all(not obj.data.polygons for obj in preview_objects())


def test_missing_tiles_are_listed_by_name(tiled_panel, tmp_path):
    cut = tile_cut.TileCut(tmp_path, "cut", ("a",), (), tuple(f"{k}.glb is not there" for k in range(9)), 2.0)
    tile_facts.remember_cut(tiled_panel, cut, "Film")
    missing = tile_facts.read(tiled_panel.tile_facts)["missing"]
    assert missing[:2] == ["9 tiles are missing", "0.glb is not there"]
    assert len(missing) == 6
