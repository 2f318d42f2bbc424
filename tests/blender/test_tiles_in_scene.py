"""3-D Tiles in the scene: made of the run's own ground, chosen, decoded, and built in its place."""

import json
import re
from dataclasses import asdict, replace

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.errors import InputError, UsageError
from firetwin.imaging.credits import Credits
from firetwin.jobs import decode_tiles, make_tiles, tiles
from firetwin.render import credits, fingerprint
from firetwin.scene.terrain import build as ground_build
from firetwin.scene.terrain import material
from firetwin.scene.tiles import build as tiles_build
from firetwin.scene.tiles import pictures
from firetwin.shot import passes, tile_cut
from firetwin.tiles import geoid
from firetwin.tiles.volumes import ecef


@pytest.fixture(autouse=True)
def plain_tiles(monkeypatch):
    """Tiles get a material of one colour: the ground's own is slow to make."""

    def build(shot, stage, images, photos=(), maps=None, skin=""):
        made, tree = nodes.material(skin or "Firetwin Ground")
        colour = tree.input(material.TILE_COLOUR, (1.0, 1.0, 1.0), "Colour")
        tree.surface(tree.output("ShaderNodeBsdfDiffuse", {"Color": colour}))
        return made

    monkeypatch.setattr(material, "build", build)


@pytest.fixture
def tiled(shot, tmp_path, monkeypatch):
    """A shot on tiles of its own ground, prepared within this process."""

    def decode(contents, progress):
        return decode_tiles.in_process([asdict(each) for each in contents], progress, print)

    monkeypatch.setattr(decode_tiles, "_limit", lambda: None)
    monkeypatch.setattr(decode_tiles, "run", decode)
    make_tiles.run(shot, make_tiles.TilesRequest(tmp_path / "set", credit="Somebody", geoid=-24.9))
    known = replace(shot.settings.tiles, sources=(str(tmp_path / "set"),), error=2.0, geoid=-24.9)
    found = shot._with_settings(replace(shot.settings, tiles=known, cache=tmp_path / "cache"))
    told = tiles.make(found)
    assert told[0] == "credits of tiles, which pictures show: Somebody"
    assert re.fullmatch(r"the tiles' ground is 0\.0 m above .* 90 % of places\)", told[1])
    return found


def test_tiles_stand_in_place_of_the_ground(tiled, stage, shot):
    whole = ground_build.build(shot, stage, None).data
    before = len(whole.polygons)
    left = ground_build.build(tiled, stage, None).data
    cut = tile_cut.of_shot(tiled)
    tiles_build.build(tiled, stage, cut, None)
    built = stage.objects_of("Tiles")
    assert len(built) == len(cut.tiles) > 0
    assert len(left.polygons) < before
    data = built[0].data
    assert {"elevation", "grid", tiles_build.COLOUR, tiles_build.UV} <= set(data.attributes.keys())
    names = [each.name for each in data.materials]
    assert names == ["Firetwin Tiles", "Firetwin Tiles 1"]
    found = data.materials[1].node_tree.nodes
    assert [node.image.source for node in found if node.type == "TEX_IMAGE"] == ["TILED"]
    groups = [
        next(node.node_tree for node in each.node_tree.nodes if node.type == "GROUP")
        for each in data.materials
    ]
    assert groups[0] == groups[1]
    assert all(
        next(node for node in each.node_tree.nodes if node.type == "GROUP").inputs[0].is_linked
        for each in data.materials
    )
    height = np.empty(len(data.vertices), np.float32)
    data.attributes["elevation"].data.foreach_get("value", height)
    place = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", place)
    place = place.reshape(-1, 3) + np.array(built[0].location)
    _, _, expected = tiled.ground.frame.reverse(place.astype(float))
    assert np.abs(height - expected).max() < 0.01


def test_a_scene_names_whom_its_tiles_are_of(tiled, stage):
    tiles_build.build(tiled, stage, tile_cut.of_shot(tiled), None)
    assert credits.of_scene(stage) == Credits(("Somebody",))


def test_inputs_of_pictures_follow_tiles_and_credits(tiled):
    """A picture that was made with other tiles, or other credits, is not the same."""
    (camera,) = [each.name for each in tiled.cameras]
    pairs = {(camera, "rgb"), (camera, "masks")}
    before = fingerprint.of_pairs(tiled, pairs)
    cut = tile_cut.of_shot(tiled.for_camera(camera))
    assert before[camera, "rgb"]["tiles"]["credits"] == ["Somebody"]
    for change in ({"credits": ("Another",)}, {"logo": ("A Service",)}, {"tiles": cut.tiles[1:]}):
        tile_cut.write(replace(cut, **change), tile_cut.location(tiled.for_camera(camera)))
        after = fingerprint.of_pairs(tiled, pairs)
        assert all(after[pair] != before[pair] for pair in pairs)
    (cut.folder / f"{cut.name}.json").unlink()
    assert "tiles" not in fingerprint.of_pairs(tiled, pairs)[camera, "rgb"]


def test_sidecars_name_credits_and_missing_tiles(tiled, tmp_path):
    (camera,) = [each.name for each in tiled.cameras]
    shot = tiled.for_camera(camera)
    cut = replace(tile_cut.of_shot(shot), missing=("x.glb: gone",))
    tile_cut.write(cut, tile_cut.location(shot))
    passes.known()["pose"].finish({"json": tmp_path / "p.json"}, {}, shot, camera, 1)
    said = json.loads((tmp_path / "p.json").read_text())["tiles"]
    expected = {"credits": ["Somebody"], "services": [], "missing": ["x.glb: gone"], "error": cut.error}
    assert said == expected


def test_pictures_that_are_too_small_for_credits_are_refused(tiled):
    small = replace(tiled.settings, render=replace(tiled.settings.render, resolution=(16, 16)))
    with pytest.raises(InputError, match="do not fit into a picture of 16 x 16"):
        tiles.make(tiled._with_settings(small))


def test_building_twice_makes_no_second_set(tiled, stage):
    cut = tile_cut.of_shot(tiled)
    counts = []
    for _ in range(2):
        tiles_build.build(tiled, stage, cut, None)
        counts.append((len(stage.objects_of("Tiles")), len(bpy.data.meshes), len(bpy.data.images)))
    assert counts[0] == counts[1]


def test_tiles_that_were_not_prepared_are_an_error(tiled):
    moved = replace(tiled.settings.tiles, error=3.0)
    with pytest.raises(InputError, match="were not prepared"):
        tile_cut.of_shot(tiled._with_settings(replace(tiled.settings, tiles=moved)))


def test_a_wrong_geoid_is_told_with_the_right_one(tiled):
    wrong = replace(tiled.settings.tiles, geoid=-20.0)
    told = tiles.make(moved := tiled._with_settings(replace(tiled.settings, tiles=wrong)))
    assert "is 4.9 m below the scene's own" in told[1]
    assert told[1].endswith("write tiles.geoid = -24.9")
    low, median, high = tile_cut.of_shot(moved).difference
    assert low <= median <= high
    assert median == pytest.approx(-4.9, abs=0.05)


def test_a_geoid_that_is_left_out_is_found_or_an_error(tiled, monkeypatch):
    left_out = tiled._with_settings(replace(tiled.settings, tiles=replace(tiled.settings.tiles, geoid=None)))
    frame = tiled.ground.frame

    class Egm96:
        plane = staticmethod(lambda frame: (-24.9, 1e-5, -2e-5))

    monkeypatch.setattr(geoid, "find", lambda: Egm96)
    height, matrix = tiles._to_scene(left_out)
    here = np.array([[9000.0, -7000.0, 50.0]])
    place = ecef(*np.radians(np.array(frame.reverse(here))[:2, 0]), np.float64(frame.reverse(here)[2][0]))
    assert height == -24.9
    np.testing.assert_allclose(
        (matrix @ [*place, 1.0])[:3], [9000, -7000, 50 + 24.9 - 0.09 - 0.14], atol=1e-6
    )
    monkeypatch.setattr(geoid, "find", lambda: None)
    with pytest.raises(InputError, match=r"tiles\.geoid is left out.*as a number"):
        tiles.make(left_out)
    with pytest.raises(UsageError, match=r"--geoid: .*as a number"):
        make_tiles.run(tiled, make_tiles.TilesRequest(tiled.settings.cache / "x"))


def test_pictures_have_parts_of_their_own():
    names = [f"{k}.jpg" for k in range(1001)] + ["a.png", "0.jpg"]
    slots = pictures.arrange(names)
    assert len(set(slots.values())) == len(slots) == 1002
    assert {slots["0.jpg"].image, slots["1000.jpg"].image, slots["a.png"].image} == {0, 1, 2}
    uv = slots["13.jpg"].moved(np.array([[-0.2, 0.5], [1.0, 1.0]], np.float32))
    assert np.allclose(uv, [[3.0, 1.5], [4.0, 2.0]], atol=1e-4)
    assert (np.floor(uv) == [3.0, 1.0]).all()
