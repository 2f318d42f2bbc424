"""Tilesets that are made: vertices against PROJ, seams, errors, skirts and buildings."""

import io
import json
import struct
import sys

import numpy as np
import pyproj
import pytest
from firetwin import ellipsoid
from firetwin.ellipsoid import enu_axes
from firetwin.errors import InputError
from firetwin.run import buildings
from firetwin.run.buildings import placement
from firetwin.tiles.make import building_mesh, glb, lattice, pictures, terrain_tile, tileset
from firetwin_core import sensor
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples
from PIL import Image

TO_EARTH = pyproj.Transformer.from_crs(4979, 4978)
SQUARE = np.array([[-120.5, 38.9], [-120.4995, 38.9], [-120.4995, 38.9004], [-120.5, 38.9004]])


def surface(rows=90, columns=70, seed=1):
    rng = np.random.default_rng(seed)
    y, x = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    height = 1500 + 300 * np.sin(y / 9) * np.cos(x / 7) + rng.normal(0, 20, y.shape)
    latitude, longitude = np.linspace(38.7, 39.2, rows), np.linspace(-120.9, -120.2, columns)
    return lattice.Surface(latitude, longitude, height.astype(np.float32))


class Grey:
    resolution = 500.0

    def __call__(self, latitude, longitude):
        return np.full((len(latitude), len(longitude), 3), 90, np.uint8)


def chunks(data):
    """The JSON and the bytes of a .glb, by the specification's header."""
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    about = json.loads(data[20 : 20 + size])
    count, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    return about, data[28 + size : 28 + size + count]


def positions(data):
    """Earth-centred positions (n, 3) of a .glb, as a reader of the specification finds them."""
    about, stored = chunks(data)
    accessor = about["accessors"][about["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    view = about["bufferViews"][accessor["bufferView"]]
    local = np.frombuffer(stored, "<f4", 3 * accessor["count"], view["byteOffset"]).reshape(-1, 3)
    x, y, z = (local.astype(float) + about["nodes"][0]["translation"]).T
    return np.column_stack([x, -z, y])


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(2, 90), st.integers(2, 90), st.integers(0, 3))
def test_every_point_of_the_surface_is_a_vertex_of_the_leaves(rows, columns, levels):
    given_surface = surface(rows, columns)
    made = lattice.Lattice(given_surface, levels)
    assert (made.height[:rows, :columns] == given_surface.height).all()
    assert np.allclose(made.latitude[:rows], given_surface.latitude, rtol=0, atol=1e-12)
    assert all(
        0 <= size - count < 1 << levels
        for size, count in zip(made.height.shape, (rows, columns), strict=True)
    )


@pytest.mark.parametrize("level", [0, 1, 2])
def test_the_error_of_a_tile_is_that_of_its_triangles(level):
    grid = lattice.Lattice(surface(), 2)
    row, column = (1 << level) - 1, 0
    rows, columns = grid.block(level, row, column)
    height, stride, worst = grid.height[rows, columns].astype(float), grid.stride(level), 0.0
    for i in range(height.shape[0]):
        for j in range(height.shape[1]):
            y, x = min(i // stride, grid.cells[0] - 1), min(j // stride, grid.cells[1] - 1)
            v, u = i / stride - y, j / stride - x
            corner = {(a, b): height[(y + a) * stride, (x + b) * stride] for a in (0, 1) for b in (0, 1)}
            if u + v <= 1:
                at = corner[0, 0] * (1 - u - v) + corner[0, 1] * u + corner[1, 0] * v
            else:
                at = corner[1, 1] * (u + v - 1) + corner[1, 0] * (1 - u) + corner[0, 1] * (1 - v)
            worst = max(worst, abs(at - height[i, j]))
    sag = grid.error(level, row, column) - worst
    assert 0.0 < sag < 0.4 * 4 ** (2 - level)  # chords of 1 km sag by 2 cm, of 4 km by 31 cm
    assert worst == 0.0 or level < 2


def test_neighbours_share_their_borders_and_vertices_are_those_of_proj(tmp_path):
    given_surface = surface()
    grid = lattice.Lattice(given_surface, 2)
    tileset.Maker(grid, Grey(), [], tmp_path / "out").run()
    side = grid.cells[1] + 1
    west, east = (positions((tmp_path / "out" / "2" / f"1_{k}.glb").read_bytes()) for k in (1, 2))
    grids = [each[: (grid.cells[0] + 1) * side].reshape(-1, side, 3) for each in (west, east)]
    assert np.linalg.norm(grids[0][:, -1] - grids[1][:, 0], axis=1).max() < 0.004
    rows, columns = grid.block(2, 1, 1)
    lat, lon = np.meshgrid(grid.latitude[rows], grid.longitude[columns], indexing="ij")
    expected = np.stack(TO_EARTH.transform(lat, lon, grid.height[rows, columns].astype(float)), axis=-1)
    assert np.linalg.norm(grids[0] - expected, axis=-1).max() < 0.004


def test_skirts_reach_below_every_other_level_of_the_edge():
    grid = lattice.Lattice(surface(), 2)
    low, _ = terrain_tile.heights(grid, 2, 1, 1)
    mesh = terrain_tile.mesh(grid, 2, 1, 1, b"")
    count = (grid.cells[0] + 1) * (grid.cells[1] + 1)
    depth = np.linalg.norm(mesh.position[count:] - mesh.position[terrain_tile._border(grid.cells)], axis=1)
    rows, columns = grid.block(2, 1, 1)
    south = grid.height[rows.start].astype(float)
    at = np.arange(len(south))
    others = [np.interp(at, at[:: grid.stride(level)], south[:: grid.stride(level)]) for level in (0, 1)]
    gap = max(np.abs(each - south)[columns].max() for each in others)
    assert depth.min() > gap
    assert low < grid.height[rows, columns].min()


def test_triangles_look_outwards():
    made = lattice.Lattice(surface(), 2)
    mesh = terrain_tile.mesh(made, 1, 0, 1, b"")
    corners = mesh.position[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = corners.mean(axis=1) - mesh.position.mean(axis=0)
    ground = 2 * made.cells[0] * made.cells[1]
    assert (np.sum(normal[:ground] * mesh.normal[mesh.triangles[:ground, 0]], axis=1) > 0).all()
    assert (np.sum(normal[ground:] * outward[ground:], axis=1) > 0).mean() > 0.99


def test_a_tileset_names_errors_that_grow_upwards_and_boxes_that_hold_their_children(tmp_path):
    out = tmp_path / "out"
    summary = tileset.Maker(lattice.Lattice(surface(), 2), Grey(), [], out, "made up").run()
    whole = json.loads((out / "tileset.json").read_text())
    seen, waiting = 0, [whole["root"]]
    while waiting:
        tile = waiting.pop()
        seen += 1
        w, s, e, n, low, high = tile["boundingVolume"]["region"]
        about, stored = chunks((out / tile["content"]["uri"]).read_bytes())
        assert about["asset"]["copyright"] == "made up"
        view = about["bufferViews"][about["images"][0]["bufferView"]]
        picture = stored[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        level = int(tile["content"]["uri"].split("/")[0])
        assert Image.open(io.BytesIO(picture)).size == ((128, 128) if level == 0 else (64, 64))
        lat, lon, height = TO_EARTH.transform(
            *positions((out / tile["content"]["uri"]).read_bytes()).T, direction="INVERSE"
        )
        assert np.radians(lat).min() > s - 1e-9
        assert np.radians(lat).max() < n + 1e-9
        assert np.radians(lon).min() > w - 1e-9
        assert np.radians(lon).max() < e + 1e-9
        assert low - 0.01 < height.min()
        assert height.max() < high + 0.01
        for child in tile.get("children", []):
            assert child["geometricError"] <= tile["geometricError"]
            inner = child["boundingVolume"]["region"]
            assert np.all(np.array(inner[:2] + inner[4:5]) >= np.array([w, s, low]))
            assert np.all(np.array(inner[2:4] + inner[5:]) <= np.array([e, n, high]))
            waiting.append(child)
    assert seen == summary.tiles == 21
    assert summary.errors[-1] == 0.0


def stand(outlines, ground):
    """Buildings of outlines in degrees."""
    north, east = ellipsoid.metres_per_degree(38.9)
    return buildings.place_on_ground(outlines, ground, (east, north))


def test_buildings_are_added_by_the_leaf_that_holds_them(tmp_path):
    found = stand([buildings.Footprint(SQUARE, (), 7.0)], lambda at: 1000.0 + 2e4 * (at[:, 1] - 38.9))
    summary = tileset.Maker(lattice.Lattice(surface(), 2), None, found, tmp_path / "out").run()
    assert summary.buildings == 1
    text = (tmp_path / "out" / "tileset.json").read_text()
    assert text.count('"ADD"') == 1
    (path,) = (tmp_path / "out" / "buildings").iterdir()
    assert f"buildings/{path.name}" in text
    height = TO_EARTH.transform(*positions(path.read_bytes()).T, direction="INVERSE")[2]
    assert height.min() == pytest.approx(1000.0 - placement.SKIRT, abs=0.01)
    assert height.max() == pytest.approx(1004.0 + 7.0, abs=1.0)


def test_a_building_is_a_closed_block_with_its_hole():
    hole = SQUARE[::-1] * 0.5 + SQUARE.mean(axis=0) * 0.5
    (block,) = stand([buildings.Footprint(SQUARE, (hole,), 6.0)], lambda at: np.zeros(len(at)))
    mesh = building_mesh.mesh([block])
    corners = mesh.position[mesh.triangles]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).round(3)
    keys = {tuple(map(tuple, each)) for each in edges}
    unmatched = [a for a in keys if a[::-1] not in keys]
    assert len(unmatched) == 8  # the base alone is open
    normal = mesh.normal[mesh.triangles[-1, 0]]
    up = enu_axes(np.radians(38.9), np.radians(-120.5))[2]
    assert normal @ up > 0.999


def test_a_folder_with_something_else_is_refused(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="nor a tileset of Firetwin"):
        tileset.refuse_others(tmp_path)
    assert [each.name for each in tmp_path.iterdir()] == ["mine.txt"]


def test_a_glb_of_many_vertices_has_wide_indices():
    count = 70_000
    triangles = np.array([[0, 1, count - 1]])
    position = np.random.default_rng(1).normal(size=(count, 3))
    about, stored = chunks(glb.encode(glb.Mesh(np.zeros(3), position, position, triangles), ""))
    accessor = about["accessors"][about["meshes"][0]["primitives"][0]["indices"]]
    view = about["bufferViews"][accessor["bufferView"]]
    assert np.frombuffer(stored, "<u4", 3, view["byteOffset"]).tolist() == [0, 1, count - 1]


def test_pictures_are_png_without_pillow(monkeypatch, tmp_path):
    def colours(latitude, longitude):
        value = np.arange(len(latitude) * len(longitude) * 3, dtype=np.uint8)
        return value.reshape(len(latitude), len(longitude), 3)

    axis = np.array([0.0, 1.0])
    assert pictures.kind(pictures.draw(colours, axis, axis, 8)) == "image/jpeg"
    monkeypatch.setitem(sys.modules, "PIL", None)
    data = pictures.draw(colours, axis, axis, 8)
    assert pictures.kind(data) == "image/png"
    (tmp_path / "a.png").write_bytes(data)
    found = np.rint(sensor.read_image(tmp_path / "a.png") * 255)
    np.testing.assert_array_equal(found, colours(np.zeros(8), np.zeros(8))[::-1])
