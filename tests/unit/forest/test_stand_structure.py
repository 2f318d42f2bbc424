"""Openings of a stand: gaps, edges where the cells' are, trees alone beyond them, none in lakes."""

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.scene.forest import plot, stand, stand_structure
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.sections import Forest, TerrainSettings
from firetwin.shot.settings import Camera, Settings
from firetwin.shot.shot import Shot
from firetwin.shot.terrain import noise
from small_run import FX, FY

HALF = FX // 2


@pytest.fixture
def shot(make_run):
    """A hillside with forest in the west and nothing in the east, or as `canopy` (fy, fx) says."""

    def make(canopy=None, *, level=False, **forest):
        if canopy is None:
            canopy = np.where(np.arange(FX) < HALF, 1.0, 0.0) * np.ones((FY, 1))
        slope = 1000.0 + (0.0 if level else 30.0) * np.arange(FX) * np.ones((FY, 1))
        arrays = {
            "canopy_fuel": canopy,
            "surface_fuel": np.where(canopy > 0.0, 1.0, 0.0),
            "fuel_elevation": slope,
        }
        folder = make_run(**{name: each.astype(np.float32) for name, each in arrays.items()})
        run = runs.open(folder)
        place = float(np.mean(run.fuel_latitude)), float(np.mean(run.fuel_longitude))
        key = CameraKey(0.0, *place, 900.0, "point", place[0] + 0.01, place[1], 0.0)
        settings = Settings(
            terrain=TerrainSettings(near_radius=0.0, apron=0.0),
            forest=Forest(budget=200_000, **forest),
            cameras=(Camera("a", Drone(keys=(key,), focal_length=8.0)),),
        )
        return Shot(settings, run)

    return make


def places(shot, columns, rows=(1.0, FY - 2.0), count=20_000):
    """Places (n, 3) spread evenly over columns and rows (from, to) of the fuel grid."""
    random, ground = np.random.default_rng(3), shot.ground
    fields = ground.fields
    row, column = (random.uniform(*ends, count) for ends in (rows, columns))
    latitude = np.interp(row, np.arange(FY), fields.latitude)
    longitude = np.interp(column, np.arange(FX), fields.longitude)
    return ground.point(latitude, longitude)


def test_gaps_take_a_small_part_of_the_forest(shot):
    film = shot(np.ones((FY, FX)))
    part = stand_structure.retained(film, places(film, (1.0, FX - 2.0)))
    assert 0.80 < part.mean() < 0.95
    assert np.mean(part > 0.99) > 0.7
    assert np.mean(part < 0.2) > 0.03


def test_edges_stand_where_the_cells_do_and_are_ragged(shot):
    film = shot()
    inside, border, beyond = (
        stand_structure.retained(film, places(film, ends))
        for ends in ((1.0, HALF - 1.1), (HALF - 0.52, HALF - 0.48), (HALF + 0.1, FX - 2.0))
    )
    assert border.mean() == pytest.approx(0.5 * (inside.mean() + beyond.mean()), abs=0.08)
    assert border.std() > 0.25
    assert 0.05 < beyond.mean() < 0.3


def test_single_trees_stand_beyond_the_edge(shot):
    film = shot()
    _, column = film.ground.under(stand.grow(film).position)
    alone, forest = np.sum(column > HALF + 0.5), np.sum(column < HALF - 1.5)
    assert 0.005 * forest < alone < 0.15 * forest


@pytest.mark.parametrize(("forest", "level"), [(1.0, True), (0.0, False)], ids=["lake", "desert"])
def test_lakes_and_deserts_have_no_lone_trees(shot, forest, level):
    canopy = np.where(np.arange(FX) < HALF, forest, 0.0) * np.ones((FY, 1))
    (own,) = plot.plots(shot(canopy, level=level), stand.TALLEST, 5000.0)
    assert np.all(own.canopy_fuel[:, HALF + 1 :] == 0.0)


def test_what_is_unknown_stays_unknown(shot):
    axes = np.arange(FY, dtype=float), np.arange(FX, dtype=float)
    fuel = np.where(np.arange(FX) < HALF, 1.0, np.nan) * np.ones((FY, 1))
    everywhere = np.ones(fuel.shape, bool)
    assert np.all(np.isnan(stand_structure.with_lone(shot(), fuel, *axes, everywhere)[:, HALF:]))


def test_lone_trees_are_known_where_they_are_asked_for_and_beside(shot):
    axes = np.arange(FY, dtype=float), np.arange(FX, dtype=float)
    fuel = np.where(np.random.default_rng(3).uniform(size=(FY, FX)) < 0.02, 1.0, 0.0)
    some = np.zeros(fuel.shape, bool)
    some[FY // 2, HALF - 2 : HALF + 2] = True
    film = shot()
    whole, part = (stand_structure.with_lone(film, fuel, *axes, at) for at in (np.ones_like(some), some))
    beside = slice(FY // 2 - 1, FY // 2 + 2), slice(HALF - 3, HALF + 3)
    assert np.any((whole != fuel)[beside])
    assert np.array_equal(part[beside], whole[beside])
    assert np.all((part == whole) | (part == fuel))


def test_trees_are_alike_in_patches_and_evenly_spread():
    random = np.random.default_rng(1)
    place, chance = random.uniform(0.0, 4000.0, (40_000, 3)), random.uniform(0.0, 1.0, 40_000)
    uniform = stand_structure.clustered_uniform(place, 110.0, chance, 5)
    assert np.histogram(uniform, 10, (0.0, 1.0))[0] / 4000.0 == pytest.approx(1.0, abs=0.25)
    other = noise.uniform(np.arange(40_000), 0, 7)
    beside, apart = (
        stand_structure.clustered_uniform(place + np.array([m, 0.0, 0.0]), 110.0, other, 5)
        for m in (5.0, 900.0)
    )
    assert np.corrcoef(uniform, beside)[0, 1] > 0.4
    assert abs(np.corrcoef(uniform, apart)[0, 1]) < 0.1
