"""Point clouds in the scene: points of the ground's material, as large as their spacing."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
import tile_files as made
from firetwin.jobs.tiles import selection
from firetwin.scene.tiles import build as tiles_build
from firetwin.scene.tiles import mesh, points
from firetwin.shot.tiles import tile_cut
from firetwin.tiles.place import ecef_to_frame
from tiles_scene import *  # noqa: F403
from tilesets import as_bytes, tile, tileset

pytestmark = pytest.mark.usefixtures("plain_tiles", "decoded_here")
SIDE = 40


@pytest.fixture
def cloud(shot, tmp_path):
    """A shot of a cloud of red points, 2 m apart, and of a triangle in the same tile."""
    x, y = (v.ravel() * 2.0 for v in np.meshgrid(np.arange(SIDE), np.arange(SIDE)))
    position = np.column_stack([x, y, 0.0 * x + 1500.0]).astype(np.float32)
    binary = position.tobytes() + np.tile(np.array([255, 0, 0], np.uint8), len(x)).tobytes()
    table = {
        "POINTS_LENGTH": len(x),
        "POSITION": {"byteOffset": 0},
        "RGB": {"byteOffset": position.nbytes},
    }
    both = made.cmpt(made.pnts(table, binary), made.b3dm(made.square().glb()))
    ball = {"sphere": [0, 0, 1500, 5000]}
    matrix = np.linalg.inv(ecef_to_frame(shot.ground.frame)).T.ravel().tolist()
    folder = tmp_path / "cloud"
    folder.mkdir()
    (folder / "tileset.json").write_bytes(
        as_bytes(tileset(tile(0.0, "a.cmpt", volume=ball, transform=matrix)))
    )
    (folder / "a.cmpt").write_bytes(both)
    known = replace(shot.settings.tiles, sources=(str(folder),), geoid=0.0)
    found = shot.with_settings(replace(shot.settings, tiles=known, cache=tmp_path / "cache"))
    selection.make(found)
    return found


def test_points_and_triangles_of_a_tile_are_objects(cloud, stage):
    tiles_build.build(cloud, stage, tile_cut.of_shot(cloud), None)
    shown, cloudy = sorted(stage.objects_of("Tiles"), key=lambda obj: obj.name)
    assert (len(shown.data.vertices), len(shown.data.polygons)) == (4 + 4, 2 + 8)  # with a skirt
    assert (len(cloudy.data.vertices), len(cloudy.data.polygons)) == (SIDE**2, 0)
    geometry = cloudy.evaluated_get(bpy.context.evaluated_depsgraph_get()).evaluated_geometry()
    cloud_points = geometry.pointcloud
    assert len(cloud_points.points) == SIDE**2
    assert {"elevation", "grid", mesh.COLOUR, points.RADIUS} <= set(cloud_points.attributes.keys())
    colour = np.empty(4 * SIDE**2, np.float32)
    cloud_points.attributes[mesh.COLOUR].data.foreach_get("color", colour)
    assert np.allclose(colour.reshape(-1, 4), [1.0, 0.0, 0.0, 1.0])
    assert cloud_points.points[0].radius == pytest.approx(points.COVERING * 2.0, rel=0.3)
    assert [each.name for each in cloud_points.materials] == ["Firetwin Tiles"]


def test_points_are_where_the_ground_says(cloud, stage):
    tiles_build.build(cloud, stage, tile_cut.of_shot(cloud), None)
    obj = next(obj for obj in stage.objects_of("Tiles") if not len(obj.data.polygons))
    height, place = np.empty(SIDE**2, np.float32), np.empty(3 * SIDE**2, np.float32)
    obj.data.attributes["elevation"].data.foreach_get("value", height)
    obj.data.vertices.foreach_get("co", place)
    _, _, expected = cloud.ground.frame.reverse(place.reshape(-1, 3).astype(float) + np.array(obj.location))
    assert np.abs(height - expected).max() < 0.01


def test_points_are_kept_by_a_rebuild(cloud, stage):
    cut = tile_cut.of_shot(cloud)
    uids = []
    for _ in range(2):
        tiles_build.build(cloud, stage, cut, None)
        uids.append({obj.data.session_uid for obj in stage.objects_of("Tiles")})
    assert uids[0] == uids[1]
    assert len(bpy.data.node_groups) == 2
