"""Trees and roofs of photogrammetry: the ground below them, flattening, planting, and the border of tiles."""

from dataclasses import replace

import numpy as np
import photogrammetry
import pytest
from firetwin.errors import InputError
from firetwin.jobs.tiles import selection
from firetwin.scene.tiles import flatten, skirt
from firetwin.shot.cameras import flight
from firetwin.shot.settings import tile_heights_file
from firetwin.shot.shot import Shot
from firetwin.shot.tiles import tile_cut, tile_terms, tile_vegetation
from firetwin.tiles import decoded
from firetwin.tiles.policies import Policy
from firetwin.tiles.sources._source import Source
from tiles_scene import *  # noqa: F403

HALF, OFF = 120.0, 1.5  # m


@pytest.fixture
def seen(shot, tmp_path, decoded_here):
    """Makes shots on photogrammetry between the camera and its target; and that scene."""

    middle = shot.bare_ground.point(38.838, -120.553)[0, :2]
    surface = photogrammetry.scene(shot.bare_ground.up, middle, HALF, OFF)
    folder = photogrammetry.write(tmp_path / "set", shot.ground.frame, surface)

    def make(vegetation="scene", height_source="elevation"):
        known = replace(shot.settings.tiles, sources=(str(folder),), geoid=0.0, vegetation=vegetation)
        terrain = replace(shot.settings.terrain, height_source="elevation")
        settings = replace(shot.settings, tiles=known, cache=tmp_path / "cache", terrain=terrain)
        first = Shot(settings, shot.run)
        selection.make(first, uses=tile_terms.of_scene(settings))
        if height_source == "elevation":
            return first
        settings = replace(settings, terrain=replace(terrain, height_source=height_source))
        heights = tile_cut.heights_file(tile_cut.location(first))
        tile_heights_file.location(settings, shot.run).write_bytes(heights.read_bytes())
        second = Shot(settings, shot.run)
        selection.make(second)
        return second

    return make, surface


def the_tile(shot):
    cut = tile_cut.of_shot(shot)
    (name,) = cut.tiles
    return decoded.read(cut.folder / name)


def vertices_of(made, tile):
    """Numbers (ny, nx) of a tile's vertices, by their places."""
    place = tile.position + tile.origin
    order = np.lexsort([np.round(place[:, 0], 1), np.round(place[:, 1], 1)])
    return order.reshape(made.east.shape)


def test_ground_below_the_wood_and_the_houses(seen):
    make, surface = seen
    heights = tile_cut.heights(make())
    inside = (surface.growth > 2.0) | surface.roof
    east, north = surface.east[inside], surface.north[inside]
    off = heights.up(east, north) - surface.ground[inside]
    assert np.abs(off).max() < 1.0
    assert np.percentile(np.abs(off), 95) < 0.5
    assert (heights.top(east, north) - surface.ground[inside]).min() > 1.0
    assert heights.building(surface.east[surface.roof], surface.north[surface.roof]).mean() > 0.9
    assert not heights.building(surface.east[surface.growth > 2.0], surface.north[surface.growth > 2.0]).any()


def test_growth_is_pushed_down_and_houses_stay(seen):
    make, surface = seen
    shot = make("scene")
    tile = the_tile(shot)
    flat = flatten.flatten(shot, tile)
    number = vertices_of(surface, tile)
    above = (flat.position[:, 2] + flat.origin[2])[number] - surface.ground
    assert above[surface.growth > 0.0].max() < flatten.LEAST + 0.5
    assert (flat.position[number[surface.roof]] == tile.position[number[surface.roof]]).all()
    bare = ~surface.roof & (surface.growth == 0.0)
    assert (flat.position[number[bare]] == tile.position[number[bare]]).all()
    np.testing.assert_allclose(np.linalg.norm(flat.normal, axis=1), 1.0, atol=1e-5)
    wood = number[surface.growth > 3.0]
    slope = np.gradient(surface.ground, photogrammetry.STEP)
    steepest = np.hypot(*slope).max()
    assert flat.normal[wood, 2].min() > 0.8 / np.hypot(1.0, steepest)
    assert flatten.flatten(make("tileset"), tile) is tile


def test_where_it_burns_is_the_burned_area_and_around(seen):
    make, made = seen
    shot = make("scene_near_burn")
    east, north = made.east.ravel(), made.north.ravel()
    place = np.column_stack([east, north])
    ours = tile_vegetation.is_of_scene(shot, place)
    row, column = shot.ground.indices(*shot.ground.geodetic(east, north))
    burned = shot.ground.burned[np.round(row).astype(int), np.round(column).astype(int)] > 0
    assert ours[burned].all()
    everywhere = np.argwhere(shot.ground.burned > 0.0)
    away = np.hypot(
        *(
            (row[::9, None] - everywhere[:, 0]) * shot.ground.cell[0],
            (column[::9, None] - everywhere[:, 1]) * shot.ground.cell[1],
        )
    ).min(axis=1)
    assert not ours[::9][away > tile_vegetation.MARGIN + 2.5 * max(shot.ground.cell)].any()


def test_no_tree_stands_in_a_house_or_in_the_tiles_wood(seen):
    make, surface = seen
    place = np.column_stack([surface.east.ravel(), surface.north.ravel(), surface.ground.ravel()])
    roof = surface.roof.ravel()
    ours, theirs = (tile_vegetation.may_grow(make(each), place) for each in ("scene", "tileset"))
    assert ours[~roof].mean() > 0.9
    assert ours[roof].mean() < 0.1
    edge = np.zeros(surface.east.shape, bool)
    edge[[0, 1, -2, -1]] = edge[:, [0, 1, -2, -1]] = True
    assert not theirs[~edge.ravel()].any()
    beyond = place + np.array([4.0 * HALF, 0.0, 0.0])
    assert tile_vegetation.may_grow(make("tileset"), beyond).all()


def test_things_stand_on_the_ground_and_cameras_clear_the_crowns(seen):
    make, surface = seen
    shot = make("tileset", height_source="tiles")
    inner = (
        np.maximum(np.abs(surface.east - surface.east.mean()), np.abs(surface.north - surface.north.mean()))
        < 0.7 * HALF
    )
    tall = inner & (surface.growth > 5.0)
    top = shot.ground.top(surface.east[tall], surface.north[tall])
    assert np.abs(top - surface.height[tall]).max() < 3.0  # between points of the wood's rough surface
    place = np.column_stack([surface.east[tall], surface.north[tall], surface.height[tall] - 1.0])[:1]
    assert flight.short(shot.ground, place, np.array([10.0]))[0] > 7.0


def test_skirts_are_at_the_border_alone(seen):
    make, made = seen
    shot = make()
    tile = the_tile(shot)
    made_tile = skirt.add_skirt(shot, tile)
    rows, columns = made.east.shape
    assert len(made_tile.triangle) - len(tile.triangle) == 2 * 2 * (rows - 1 + columns - 1)
    foot = made_tile.position[len(tile.position) :] + made_tile.origin
    ground = shot.ground.up(foot[:, 0], foot[:, 1])
    assert (foot[:, 2] < ground - 1.9).all()
    corners = made_tile.position[made_tile.triangle[len(tile.triangle) :]].astype(float)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    away = corners.mean(axis=1) - tile.position.mean(axis=0)
    assert (np.einsum("ij,ij->i", outward[:, :2], away[:, :2]) > 0.0).all()


def test_what_may_not_be_changed_is_refused(seen, monkeypatch):
    make, _ = seen
    monkeypatch.setattr(
        "firetwin.tiles.policies.OPEN", policy := Policy("Somebody's tiles", may_flatten=False)
    )
    monkeypatch.setattr(Source, "policy", policy)
    make("tileset")
    with pytest.raises(InputError, match=r"Somebody's tiles does not allow .* leave out tiles\.vegetation"):
        make("scene")
