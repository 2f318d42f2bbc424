"""A rebuild reuses equal tiles and makes the others again."""

from dataclasses import replace
from pathlib import Path

import bpy
import pytest
from firetwin.blender import owned, state
from firetwin.jobs.tiles import selection
from firetwin.scene import build as scene_build
from firetwin.scene.tiles import build as tiles_build
from firetwin.scene.tiles import reuse
from firetwin.shot.shot import Shot
from firetwin.shot.tiles import tile_cut
from lying_server import Reply, serving
from tiles_scene import *  # noqa: F403

pytestmark = pytest.mark.usefixtures("plain_tiles")
KINDS = ("meshes", "materials", "images", "node_groups")


def build(shot, stage):
    tiles_build.build(shot, stage, tile_cut.of_shot(shot), None)
    return blocks()


def blocks():
    """Names by session uid, of each kind of data-block."""
    return {kind: {each.session_uid: each.name for each in getattr(bpy.data, kind)} for kind in KINDS}


def built_tiles():
    return {obj.data[reuse.TILE]: obj.data for obj in owned.stage(bpy.context.scene).objects_of("Tiles")}


def new(before, after, kind):
    return after[kind].keys() - before[kind].keys()


def test_the_same_cut_makes_nothing_new(tiled, stage):
    before = build(tiled, stage)
    assert len(stage.objects_of("Tiles")) > 1
    assert before["images"]
    assert build(tiled, stage) == before
    assert not any(block.use_fake_user for block in (*bpy.data.meshes, *bpy.data.materials))


def test_nothing_is_fetched_or_decoded_again(tiled, monkeypatch):
    from firetwin.jobs.tiles import decode as job

    def decode(contents, progress):
        assert all(Path(each.out).exists() for each in contents)
        return {}

    monkeypatch.setattr(job, "run", decode)
    before = tile_cut.of_shot(tiled)
    selection.make(tiled)
    assert tile_cut.of_shot(tiled) == before


def test_of_a_server_nothing_is_fetched_again(tiled, prepared_tiles, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "kept"))
    with serving() as server:
        for path in (prepared_tiles / "set").rglob("*.*"):
            name = path.relative_to(prepared_tiles / "set").as_posix()
            server.answers[f"/{name}"] = Reply(200, path.read_bytes(), {"Cache-Control": "max-age=3600"})
        sources = (f"{server.url}/tileset.json",)
        settings = replace(tiled.settings, tiles=replace(tiled.settings.tiles, sources=sources))
        shot = Shot(settings, tiled.run)
        selection.make(shot)
        asked = len(server.asked)
        cut = tile_cut.of_shot(shot)
        selection.make(shot)
        assert len(server.asked) == asked > len(cut.tiles)
        assert tile_cut.of_shot(shot) == cut
    assert cut.tiles == tile_cut.of_shot(tiled).tiles  # named by their content, as in a folder


def test_one_changed_tile_is_one_new_mesh(tiled, stage):
    before = build(tiled, stage)
    cut = tile_cut.of_shot(tiled)
    other = cut.folder / f"{'0' * 32}.tile"
    other.write_bytes((cut.folder / cut.tiles[1]).read_bytes())
    changed = replace(cut, tiles=(cut.tiles[0], other.name, *cut.tiles[2:]))
    tiles_build.build(tiled, stage, changed, None)
    after = blocks()
    assert len(new(before, after, "meshes")) == len(new(after, before, "meshes")) == 1
    assert after["materials"] == before["materials"]
    assert after["images"] == before["images"]


def test_what_left_the_cut_or_the_settings_is_removed(tiled, shot, stage):
    before = build(tiled, stage)
    cut = tile_cut.of_shot(tiled)
    tiles_build.build(tiled, stage, replace(cut, tiles=cut.tiles[:-1]), None)
    after = blocks()
    assert not new(before, after, "meshes")
    assert len(after["meshes"]) == len(before["meshes"]) - 1
    assert len(stage.objects_of("Tiles")) == len(cut.tiles) - 1
    scene_build.build(shot, stage.scene, ("terrain",))
    assert not stage.objects_of("Tiles")
    assert not [each for each in bpy.data.meshes if reuse.TILE in each]


def test_tiles_that_were_edited_are_made_again(tiled, stage):
    before = build(tiled, stage)
    tiles = built_tiles()
    arrays = {name: state.digest_mesh(data) for name, data in tiles.items()}
    moved, coloured, keyed, flipped = list(tiles.values())[:4]
    moved.vertices[0].co.z += 1.0
    coloured.attributes["tile_colour"].data[0].color = (1.0, 0.0, 0.0, 1.0)
    next(obj for obj in bpy.data.objects if obj.data == keyed).shape_key_add(name="Basis")
    flipped.flip_normals()
    edited = {data.session_uid for data in (moved, coloured, keyed, flipped)}
    after = build(tiled, stage)
    assert new(after, before, "meshes") == edited
    assert len(new(before, after, "meshes")) == 4
    assert {name: state.digest_mesh(data) for name, data in built_tiles().items()} == arrays


def edit_material(stage, tiled):
    nodes = bpy.data.materials["Firetwin Tiles"].node_tree.nodes
    group = next(node for node in nodes if node.type == "GROUP")
    diffuse = next(node for node in group.node_tree.nodes if node.type == "BSDF_DIFFUSE")
    diffuse.inputs["Roughness"].default_value = 0.25
    return tiled


def edit_image(stage, tiled):
    (image,) = bpy.data.images
    image.colorspace_settings.name = "Non-Color"
    return tiled


def set_haze(stage, tiled):
    return tiled.with_settings(replace(tiled.settings, light=replace(tiled.settings.light, haze=0.5)))


def widen_grid(stage, tiled):
    return Shot(replace(tiled.settings, terrain=replace(tiled.settings.terrain, apron=30_000.0)), tiled.run)


@pytest.mark.parametrize(
    ("change", "renewed"),
    [
        (edit_material, {"materials"}),
        (edit_image, {"images", "materials"}),
        (set_haze, {"materials"}),
        (widen_grid, {"meshes", "materials"}),
    ],
)
def test_a_change_renews_what_depends_on_it(tiled, stage, change, renewed):
    before = build(tiled, stage)
    changed = change(stage, tiled)
    tiles_build.build(changed, stage, tile_cut.of_shot(tiled), None)
    after = blocks()
    for kind in ("meshes", "materials", "images"):
        same = before[kind].keys() & after[kind].keys()
        assert same == (set() if kind in renewed else before[kind].keys()), kind


def test_an_object_that_was_moved_goes_back(tiled, stage):
    before = build(tiled, stage)
    obj = stage.objects_of("Tiles")[0]
    place = tuple(obj.location)
    obj.location.x += 100.0
    obj.data.materials[0] = bpy.data.materials.new("Mine")
    after = build(tiled, stage)
    assert not new(before, after, "meshes")
    again = next(each for each in stage.objects_of("Tiles") if each.data[reuse.ORIGIN][0] == place[0])
    assert tuple(again.location) == place
    assert [each.name for each in again.data.materials] == ["Firetwin Tiles", "Firetwin Tiles 1"]


def test_an_artists_copy_keeps_its_mesh(tiled, stage):
    build(tiled, stage)
    obj = stage.objects_of("Tiles")[0]
    mine = obj.copy()
    mine.name = "Mine"
    stage.scene.collection.objects.link(mine)
    uid = mine.data.session_uid
    mine.data.vertices[0].co.z += 1.0
    build(tiled, stage)
    assert bpy.data.objects["Mine"].data.session_uid == uid
    assert uid not in [data.session_uid for data in built_tiles().values()]


def test_a_file_that_was_saved_keeps_its_tiles(tiled, stage, tmp_path):
    build(tiled, stage)
    names = sorted(each.name for each in built_tiles().values())
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"), relative_remap=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    before = blocks()
    after = build(tiled, owned.stage(bpy.context.scene))
    assert after == before
    assert sorted(each.name for each in built_tiles().values()) == names


def test_undo_brings_back_what_can_be_kept(tiled, stage):
    bpy.context.preferences.edit.use_global_undo = True
    build(tiled, stage)
    count = len(built_tiles())
    bpy.ops.ed.undo_push(message="built")
    for obj in stage.objects_of("Tiles"):
        bpy.data.objects.remove(obj)
    owned.purge()
    bpy.ops.ed.undo_push(message="removed")
    bpy.ops.ed.undo()
    before = blocks()
    assert len(built_tiles()) == count
    assert build(tiled, owned.stage(bpy.context.scene)) == before
