"""3D Tiles in the scene: made of the run's own ground, chosen, decoded, and built in its place."""

import json
from dataclasses import replace

import numpy as np
import pytest
from firetwin.ellipsoid import ecef
from firetwin.errors import InputError, UsageError
from firetwin.imaging.credits import Credits
from firetwin.jobs.tiles import make, selection, source
from firetwin.render import credits, fingerprint
from firetwin.scene.terrain import build as ground_build
from firetwin.scene.tiles import build as tiles_build
from firetwin.scene.tiles import mesh
from firetwin.shot import passes
from firetwin.shot.tiles import tile_cut
from firetwin.tiles import geoid
from tiles_scene import *  # noqa: F403

pytestmark = pytest.mark.usefixtures("plain_tiles")


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
    assert {"elevation", "grid", mesh.COLOUR, mesh.UV} <= set(data.attributes.keys())
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
    assert credits.read_scene(stage) == Credits(("Somebody",))


def test_inputs_of_pictures_follow_tiles_and_credits(tiled):
    """A picture that was made with other tiles, or other credits, is not the same."""
    (camera,) = [each.name for each in tiled.cameras]
    pairs = {(camera, "rgb"), (camera, "masks")}
    before = fingerprint.compute_pairs(tiled, pairs)
    cut = tile_cut.of_shot(tiled.for_camera(camera))
    assert before[camera, "rgb"]["credits"]["data"] == ["Somebody"]
    for change in ({"credits": ("Another",)}, {"logo": ("A Service",)}, {"tiles": cut.tiles[1:]}):
        tile_cut.write(replace(cut, **change), tile_cut.location(tiled.for_camera(camera)))
        after = fingerprint.compute_pairs(tiled, pairs)
        assert all(after[pair] != before[pair] for pair in pairs)
    (cut.folder / f"{cut.name}.json").unlink()
    assert "tiles" not in fingerprint.compute_pairs(tiled, pairs)[camera, "rgb"]


def test_sidecars_name_credits_and_missing_tiles(tiled, tmp_path):
    (camera,) = [each.name for each in tiled.cameras]
    shot = tiled.for_camera(camera)
    cut = replace(tile_cut.of_shot(shot), missing=("x.glb: gone",))
    tile_cut.write(cut, tile_cut.location(shot))
    passes.finish("pose", {"json": tmp_path / "p.json"}, {}, shot, camera, 1)
    said = json.loads((tmp_path / "p.json").read_text())
    assert (said["credits"], said.get("services")) == (["Somebody"], None)
    assert said["tiles"] == {"missing": ["x.glb: gone"], "error": cut.error}


def test_tiles_that_were_not_prepared_are_an_error(tiled):
    moved = replace(tiled.settings.tiles, max_screen_space_error=3.0)
    with pytest.raises(InputError, match="were not prepared"):
        tile_cut.of_shot(tiled.with_settings(replace(tiled.settings, tiles=moved)))


def test_a_wrong_geoid_is_told_with_the_right_one(tiled):
    wrong = replace(tiled.settings.tiles, geoid=-20.0)
    told = selection.make(moved := tiled.with_settings(replace(tiled.settings, tiles=wrong)))
    assert "is 4.9 m below the scene's own" in told[1]
    assert told[1].endswith("write tiles.geoid = -24.9")
    low, median, high = tile_cut.of_shot(moved).difference
    assert low <= median <= high
    assert median == pytest.approx(-4.9, abs=0.05)


def test_a_geoid_that_is_left_out_is_found_or_an_error(tiled, monkeypatch):
    left_out = tiled.with_settings(replace(tiled.settings, tiles=replace(tiled.settings.tiles, geoid=None)))
    frame = tiled.ground.frame

    class Egm96:
        plane = staticmethod(lambda frame: (-24.9, 1e-5, -2e-5))

    monkeypatch.setattr(geoid, "find", lambda: Egm96)
    height, matrix = source.to_scene(left_out)
    here = np.array([[9000.0, -7000.0, 50.0]])
    place = ecef(*np.radians(np.array(frame.reverse(here))[:2, 0]), np.float64(frame.reverse(here)[2][0]))
    assert height == -24.9
    np.testing.assert_allclose(
        (matrix @ [*place, 1.0])[:3], [9000, -7000, 50 + 24.9 - 0.09 - 0.14], atol=1e-6
    )
    monkeypatch.setattr(geoid, "find", lambda: None)
    with pytest.raises(InputError, match=r"tiles\.geoid is left out.*as a number"):
        selection.make(left_out)
    with pytest.raises(UsageError, match=r"--geoid: .*as a number"):
        make.run(tiled, make.TilesRequest(tiled.settings.cache / "x"))
