"""Visibility by the cameras of a shot in their filmed frames, and occluders."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.geometry.grids import dilate
from firetwin.run import opening as runs
from firetwin.shot.cameras.rigs.orbit import Orbit
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Camera, Render, Settings
from firetwin.shot.shot import Shot
from firetwin.shot.surface import mesh_tolerance, shadow_casters
from firetwin_core import lod
from small_run import FX, FY, NX, NY

ORBIT = Orbit(latitude=38.905, longitude=-120.592, radius=900.0, height=300.0, speed=20.0)


@pytest.fixture
def film(make_run):
    """A shot of nine frames over half an hour with these cameras; rough ground, fine near them."""
    rng = np.random.default_rng(4)
    high = {"elevation": np.full((NY, NX), 1200.0, np.float32)}
    high["fuel_elevation"] = rng.uniform(1100.0, 1300.0, (FY, FX)).astype(np.float32)
    run = runs.open(make_run(**high))

    def shot(*cameras, **changes):
        settings = Settings(
            time=Time(
                start=datetime(2014, 9, 17, 4, 45, tzinfo=UTC),
                end=datetime(2014, 9, 17, 4, 50, tzinfo=UTC),
                frames=9,
            ),
            terrain=TerrainSettings(near_radius=1500.0, apron=0.0),
            forest=Forest(trees=False),
            cameras=cameras,
        )
        return Shot(replace(settings, **changes), run)

    return shot


def test_frames_that_are_not_filmed_do_not_count(film):
    whole, some = film(Camera("a", ORBIT)), film(Camera("a", ORBIT, frames="1,3"))
    (path,) = whole.paths
    assert np.ptp(path.position, axis=0).max() > 100.0
    away = [np.linalg.norm(path.position - path.position[8], axis=1)[[0, 2]].min(), 0.0]
    for shot, least in zip((some, whole), away, strict=True):
        assert shot.visibility.distance(path.position[8:]) == pytest.approx([least], abs=1e-6)
        assert shot.visibility.distance_from(shot.paths[0], path.position[8:]) == pytest.approx(
            [least], abs=1e-6
        )
    aim = path.position + 50.0 * -path.rotation[:, :, 2]
    alone = lod.visible_mask(aim, 0.0, lod.ViewSet(path.position[[0, 2]], path.rotation[[0, 2]], path.half))
    assert some.visibility.visible_mask(aim, 0.0).tolist() == alone.tolist()
    assert whole.visibility.visible_mask(aim, 0.0).all()
    assert [some.visibility.view_set(frame) is None for frame in (1, 2, 3)] == [False, True, False]


def test_satellites_can_be_asked_alone(film):
    """Their visible spheres and those that perspective cameras see are all visible spheres."""
    shot = film(Camera("a", ORBIT), Camera("above", Satellite(swath=2000.0)))
    places = np.random.default_rng(5).uniform((-3e3, -3e3, 1.1e3), (3e3, 3e3, 1.4e3), (3000, 3))
    near, all_of_them = (shot.visibility.visible_mask(places, 5.0, pixel=pixel) for pixel in (0.0, np.inf))
    flat = shot.visibility.visible_mask(places, 5.0, pixel=np.inf, perspective=False)
    assert (near | flat).tolist() == all_of_them.tolist()
    assert (near & ~flat).any()
    assert (flat & ~near).any()
    assert not shot.visibility.visible_mask(places, 5.0, perspective=False).any()
    whole = film(*shot.settings.cameras, render=Render(cull=False))
    assert whole.visibility.visible_mask(places, 5.0, pixel=np.inf, perspective=False).all()
    assert not whole.visibility.visible_mask(places, 5.0, perspective=False).any()


def test_satellites_count_by_their_pixels_and_are_near_to_nothing(film):
    shot = film(Camera("above", Satellite(swath=640.0)))
    width = shot.settings.render.resolution[0]
    edge = np.array([[310.0, 0.0, 1200.0], [330.0, 0.0, 1200.0]]) + shot.paths[0].target[0] * [1, 1, 0]
    assert shot.visibility.visible_mask(edge, 0.0, pixel=1.01 * 640.0 / width).tolist() == [True, False]
    assert not shot.visibility.visible_mask(edge, 0.0, pixel=640.0 / width).any()
    assert np.isinf(shot.visibility.distance(edge)).all()


def test_what_is_under_a_place_is_found_along_its_vertical(film):
    ground = film(Camera("a", ORBIT)).ground
    rows, columns = ground.shape
    rng = np.random.default_rng(8)
    row, column = rng.uniform(0, rows - 1, 500), rng.uniform(0, columns - 1, 500)
    for above in (0.0, 300.0):
        found = ground.under(ground.point(*ground.places(row, column), above))
        np.testing.assert_allclose(found, (row, column), rtol=0, atol=1e-6)


def test_without_skipping_all_counts_as_seen_and_is_drawn_as_from_near_by(film):
    place = np.random.default_rng(5).uniform(-3000.0, 3000.0, (200, 3))
    place[-1] = np.nan
    some, whole = (film(Camera("a", ORBIT), render=Render(cull=skip)) for skip in (True, False))
    seen = some.visibility.visible_mask(place, 5.0)
    assert 0 < seen.sum() < 150
    assert whole.visibility.visible_mask(place, 5.0).tolist() == [True] * 199 + [False]
    near = whole.visibility.distance(place) <= 1400.0
    assert whole.visibility.visible_mask(place, 600.0, reach=800.0).tolist() == near.tolist()
    np.testing.assert_array_equal(some.visibility.distance(place), whole.visibility.distance(place))
    np.testing.assert_array_equal(some.visibility.lod_distance(place), some.visibility.distance(place))
    assert not whole.visibility.lod_distance(place).any()
    assert some.visibility.view_set(1) is not None
    assert whole.visibility.view_set(1) is None
    tolerance = [mesh_tolerance.wanted(shot).tolerance for shot in (some, whole)]
    assert np.all(tolerance[1] <= tolerance[0] + 1e-6)
    assert tolerance[1].max() < 0.03 < tolerance[0].max()


@pytest.mark.parametrize("rig", [ORBIT, Satellite(swath=1000.0)])
def test_ground_is_drawn_no_more_exactly_than_heights_are_known(film, rig):
    shot = film(Camera("a", rig), terrain=TerrainSettings(near_radius=1500.0, apron=0.0, error=1.0e-6))
    assert np.unique(mesh_tolerance.wanted(shot).tolerance)[0] == np.float32(0.02)


@pytest.mark.parametrize("shape", [(1, 1), (1, 4), (4, 1)])
def test_few_blocks_may_shade_each_other(film, shape):
    place = np.stack(
        [*np.meshgrid(*(100.0 * np.arange(count) for count in shape[::-1])), np.zeros(shape)], -1
    )
    seen = np.zeros(shape, bool)
    shot = film(Camera("a", ORBIT))
    assert not shadow_casters.with_shade(shot, place, np.zeros(shape), seen).any()
    seen[0, 0] = True
    assert shadow_casters.with_shade(shot, place, np.zeros(shape), seen)[0, 0]


@pytest.mark.parametrize("bearing", [0.0, 90.0, 225.0])
def test_ground_that_shades_what_is_seen_counts(bearing):
    """A wall throws its shadow away from the sun; it counts as far as that is long."""
    side, block, wall, height = 41, 100.0, 300.0, 30.0
    place = block * (np.arange(side) - side // 2)
    centre = np.stack([*np.meshgrid(place, place), np.zeros((side, side))], axis=-1)
    toward = np.array([np.sin(np.radians(bearing)), np.cos(np.radians(bearing))])
    long = wall / np.tan(np.radians(height))
    for away in (0.5, 0.9, 2.2):
        centre[..., 2] = 0.0
        column, row = np.round(toward * away * long / block).astype(int) + side // 2
        centre[row, column, 2] = wall
        seen = np.zeros((side, side), bool)
        seen[side // 2, side // 2] = True
        low = dilate(-centre[..., 2], 1) * -1.0
        rest = np.flatnonzero(~seen)
        shading = np.zeros((side, side), bool)
        shading.ravel()[rest] = shadow_casters._reaches(
            centre, np.full((side, side), 1.0), low, dilate(seen, 1), rest, bearing, height
        )
        assert shading[row, column] == (away < 1.0), away
        shading[row, column] = False
        assert (
            shading.sum() < 60
        )  # a few blocks around visible ones, because all count as wider than they are


def test_no_drawn_ground_is_under_its_floor(film):
    """However finely cells are drawn: any place of a cell is over the lowest corner of its floor."""
    ground = film(Camera("a", ORBIT)).ground
    assert len(ground.eyes) > 0
    rng = np.random.default_rng(8)
    rows, columns = ground.shape
    row, column = rng.uniform(0, rows - 1, 40_000), rng.uniform(0, columns - 1, 40_000)
    corners = np.lib.stride_tricks.sliding_window_view(ground.floor()[..., 2], (2, 2)).min(axis=(2, 3))
    drawn = ground.point(*ground.places(row, column))[:, 2]
    gap = drawn - corners[row.astype(int), column.astype(int)]
    assert gap.min() > -1e-6
    flat = film(Camera("a", ORBIT), terrain=TerrainSettings(near_radius=0.0, apron=0.0)).ground
    coarse = flat.frame.forward_grid(flat.fields.latitude, flat.fields.longitude, flat.fields.elevation)
    np.testing.assert_array_equal(flat.floor(), coarse)
