"""Biomes: choice by land, changes by settings, and completeness."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from firetwin.run import fuel_category as categories
from firetwin.run import opening as runs
from firetwin.scene.forest import (
    biomes,
    cover,
    field_lines,
    models,
    patterns,
    planted_rows,
    stand_structure,
    understorey,
)
from firetwin.scene.forest.biomes import Land, Season
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.sections import Forest, TerrainSettings
from firetwin.shot.sections import biome_names as named
from firetwin.shot.settings import Camera, Settings
from firetwin.shot.shot import Shot
from small_run import FX, FY, NT, NX, NY

EVERY = sorted(named.names())


@pytest.fixture
def shot(make_run):
    """shot(fields=..., **forest): the small run, filmed from 30 m."""

    def made(fields=None, **forest):
        run = runs.open(make_run(**(fields or {})))
        key = CameraKey(0.0, 38.902, -120.594, 30.0, "point", 38.905, -120.594, 1.0)
        settings = Settings(
            terrain=TerrainSettings(near_radius=1500.0, apron=0.0),
            forest=Forest(**forest),
            cameras=(Camera("one", Drone(keys=(key,))),),
        )
        return Shot(settings, run)

    return made


def filled(value):
    return np.full((FY, FX), value, np.float32)


@pytest.mark.parametrize(
    ("land", "name"),
    [
        (Land(38.9, -120.5, 0.1, 0.0, 0.9), "sierra_conifer"),  # King Fire
        (Land(38.6, -98.9, 1.0, 0.0, 0.0), "grassland"),  # Kansas
        (Land(8.4, 20.6, 1.0, 0.0, 0.0), "savanna"),
        (Land(46.2, 1.3, 1.0, 0.0, 0.0), "pasture"),  # Limousin
        (Land(34.4, -118.3, 0.15, 0.85, 0.0), "chaparral"),  # above Los Angeles
        (Land(43.3, 6.3, 0.15, 0.6, 0.25), "maquis"),  # Provence
        (Land(57.6, -111.9, 0.1, 0.15, 0.75), "boreal"),  # Alberta
        (Land(61.0, 15.0, 0.0, 0.2, 0.8), "boreal"),
        (Land(38.9, -120.5, 0.0, 0.0, 0.0), "sierra_conifer"),  # nothing is known
        (Land(49.9, -119.6, 0.0, 0.1, 0.9), "sierra_conifer"),  # Kelowna
        (Land(-33.9, 150.3, 0.1, 0.1, 0.8), "eucalypt"),  # Blue Mountains
        (Land(-37.5, 145.3, 0.2, 0.0, 0.8), "eucalypt"),  # Victoria
        (Land(-34.0, 18.4, 0.1, 0.8, 0.1), "maquis"),  # fynbos of the Cape
        (Land(-12.8, 132.5, 0.9, 0.0, 0.1), "savanna"),  # Arnhem Land
        (Land(39.9, -8.2, 0.1, 0.2, 0.7), "mediterranean_oak"),  # central Portugal
        (Land(38.9, 23.3, 0.1, 0.1, 0.8), "mediterranean_oak"),  # Euboea
        (Land(-35.6, -71.5, 0.1, 0.2, 0.7), "mediterranean_oak"),  # Maule
        (Land(50.8, 14.3, 0.0, 0.1, 0.9), "broadleaf"),  # Bohemia
        (Land(35.7, -83.5, 0.0, 0.1, 0.9), "broadleaf"),  # Gatlinburg
        (Land(44.4, -0.9, 0.0, 0.2, 0.8), "broadleaf"),  # Landes: planted, which only the user knows
        (Land(37.5, 140.5, 0.0, 0.1, 0.9), "broadleaf"),  # Honshu
        (Land(-9.0, -55.0, 0.1, 0.0, 0.9), "rainforest"),  # Amazon
        (Land(-15.8, -47.9, 0.8, 0.1, 0.1), "savanna"),  # Cerrado
        (Land(62.0, 130.0, 0.0, 0.1, 0.9), "boreal"),  # Yakutia
        (Land(46.4, 9.8, 0.1, 0.1, 0.8), "boreal"),  # Engadin
        (Land(48.5, -81.3, 0.0, 0.1, 0.9), "broadleaf"),  # Timmins: mixed forest
        (Land(50.5, -90.0, 0.0, 0.1, 0.9), "boreal"),  # Ontario
        (Land(-29.5, 30.0, 1.0, 0.0, 0.0), "grassland"),  # KwaZulu-Natal
    ],
)
def test_place_and_fuel_choose_the_biome(land, name):
    assert biomes.chosen(land) == name


def test_conifers_of_the_sierra_grow_in_western_north_america_alone():
    for latitude in range(-55, 75, 3):
        for longitude in range(-180, 180, 4):
            land = Land(latitude + 0.5, longitude + 0.5, 0.1, 0.1, 0.8)
            name = biomes.chosen(land)
            assert name != "plantation"
            if name == "sierra_conifer":
                assert land.within(16.0, 60.0, -142.0, -95.0)
            assert (name == "eucalypt") == land.within(-45.0, -10.5, 112.0, 155.0)
            assert biomes.known()[name].suits(land) > 0.3


def test_every_file_is_a_biome_and_a_choice():
    assert set(biomes.known()) == set(named.names()) == set(named.choices()) - {"auto"}
    assert all(len(about) > 10 for about in named.names().values())


def test_without_categories_loads_tell_what_land_it_is(shot):
    assert biomes.choose(shot({"canopy_fuel": filled(0.0), "surface_fuel": filled(1.5)})).name == "chaparral"


def test_a_category_outweighs_the_load(make_run):
    number = filled(2.0)
    number[0], number[1] = np.nan, 98.0
    folder = make_run(canopy_fuel=filled(0.0), surface_fuel=filled(1.5), fuel_category=number)
    land = biomes.land(runs.open(folder))
    assert (land.grass, land.shrub) == pytest.approx((6 / 7, 1 / 7))  # water is not land


def test_the_sample_fires_september_is_dry_and_as_it_was():
    """Exactly 0: the Sierra's colours are those that it had before it was one biome of several."""
    day = date(2014, 9, 17).timetuple().tm_yday
    assert biomes.known()["sierra_conifer"].season.greenness(day, 38.9) == 0.0
    assert biomes.known()["sierra_conifer"].open_land is None


def test_seasons_turn_with_the_hemisphere():
    season = Season(peak=150.0, lasts=100.0, low=0.1, high=0.9)
    assert season.greenness(150.0, 45.0) == pytest.approx(0.9)
    assert season.greenness(150.0 + 182.6, 45.0) == pytest.approx(0.1)
    assert season.greenness(150.0, -45.0) == pytest.approx(0.1)
    days = np.arange(1, 366)
    green = np.array([season.greenness(day, 45.0) for day in days])
    assert np.abs(np.diff(green)).max() < 0.03  # day by day, over new year too
    assert green[0] == pytest.approx(green[-1], abs=0.03)


def test_settings_outweigh_place_date_and_fuel(shot):
    here = biomes.choose(shot(biome="maquis", greenness=0.7, shrub_cover=0.9, tree_cover=0.2))
    assert (here.name, here.green) == ("maquis", 0.7)
    assert (here.biome.shrub_cover, here.biome.tree_cover) == (0.9, 0.2)


def april(make_run, **fields):
    """Greenness of a shot in April of a run of grassland with these fields."""
    fields = {"canopy_fuel": filled(0.0), "surface_fuel": filled(0.4)} | fields
    folder = make_run(**fields)
    text = (folder / "run.toml").read_text().replace("2014-09-16", "2014-05-20")
    (folder / "run.toml").write_text(text)
    settings = Settings(terrain=TerrainSettings(apron=0.0), forest=Forest(biome="grassland"))
    return Shot(settings, runs.open(folder))


def test_grass_that_burns_is_cured(make_run):
    assert biomes.choose(april(make_run)).green == pytest.approx(0.12)


def test_grass_without_a_fire_is_as_green_as_the_date(make_run):
    shot = april(make_run, heat_flux=np.zeros((NT, NY, NX), np.float32))
    assert biomes.choose(shot).green > 0.8


def test_grass_beside_a_forest_fire_is_half_dry(make_run):
    shot = april(make_run, canopy_fuel=filled(1.0))
    assert biomes.choose(shot).green == pytest.approx(0.4)


def test_planted_trees_stand_in_rows_and_are_of_one_height_in_a_compartment(shot):
    plantation = shot({"canopy_fuel": filled(1.0)}, biome="plantation")
    rng = np.random.default_rng(2)
    place = np.column_stack([rng.uniform(-300.0, 300.0, (4000, 2)), np.zeros(4000)])
    there = planted_rows.planted(plantation, place)
    assert there.all()
    moved = planted_rows.align(plantation, place, there)
    assert np.hypot(*(moved - place)[:, :2].T).max() <= 0.5 * planted_rows.ROW + 1e-9
    edge, row, number = field_lines.fields(field_lines.NUMPY, *place[:, :2].T, planted_rows._COMPARTMENT)
    place, moved, row, number = (each[edge > planted_rows.ROW] for each in (place, moved, row, number))
    for one in np.unique(row + 1j * number)[:4]:
        inside = row + 1j * number == one
        x, y = place[inside, :2].T
        turn = np.pi * planted_rows._lot(plantation, x, y, 0)[0]
        across = moved[inside, 1] * np.cos(turn) - moved[inside, 0] * np.sin(turn)
        off = across / planted_rows.ROW
        assert np.abs(off - np.round(off)).max() < 1e-9
        felled = planted_rows.stocked(plantation, moved[inside]) == 0.0
        assert felled[np.round(off) % 6 == 0].all()
        assert felled.mean() < 0.4
        key = np.stack([np.arange(inside.sum()), np.zeros(inside.sum(), int)], axis=-1)
        tall = planted_rows.heights(plantation, place[inside], key)
        assert tall.std() < 0.12 * tall.mean()
        assert 5.0 < tall.mean() < 30.0


@pytest.mark.parametrize("name", EVERY)
def test_every_biome_names_models_that_live_and_colours_of_land(name):
    biome, every = biomes.known()[name], models.every()
    for sort in biome.species:
        assert all(every[k].state == "living" for k in sort.models)
    for living, burned in biome.plants.models.values():
        assert len(living) == len(burned)
        assert all(every[k].state == "living" for k in living)
        assert all(every[k].state == "snag" or every[k].kind == "twigs" for k in burned)
    assert set(biome.plants.density) | set(biome.plants.height) <= set(understorey.KINDS)
    if (land := biome.open_land) is not None:
        colours = [land.bleached, land.straw, land.stale, land.green, land.lush, *land.soil, *land.shrub]
        assert 0.0 < np.min(colours) < np.max(colours) < 0.3
        assert np.mean(land.stale) < np.mean(land.straw) < np.mean(land.bleached)
        assert land.green[1] > land.green[0] > land.green[2]


def test_bushes_grow_with_the_load_and_by_category(shot):
    load = np.linspace(0.1, 3.0, FY * FX, dtype=np.float32).reshape(FY, FX)
    number = np.full((FY, FX), np.nan, np.float32)
    number[2, :4], number[3, :4], number[4, :4] = 1.0, 4.0, 122.0
    made = shot(
        {"canopy_fuel": filled(0.0), "surface_fuel": load, "fuel_category": number}, biome="grassland"
    )
    found = cover.shrubs(made)
    assert found.shape == (FY, FX)
    assert found[0, 0] == pytest.approx(biomes.choose(made).biome.shrub_cover)
    assert (np.diff(found[5:].ravel()) >= 0).all()
    assert found[7, 9] > 0.8
    grass, brush, mixed = found[2, 0], found[3, 0], found[4, 0]
    assert grass < mixed < brush
    assert categories.kinds(np.array([1, 4])).tolist() == [categories.GRASS, categories.SHRUB]


def test_hollows_are_below_what_is_round_them(shot):
    y, x = np.mgrid[-1 : 1 : FY * 1j, -1 : 1 : FX * 1j]
    bowl = (1000.0 + 200.0 * np.hypot(x, y)).astype(np.float32)
    made = shot({"fuel_elevation": bowl}, biome="grassland")
    found = cover.hollows(made.ground)
    assert found[FY // 2, FX // 2] > 0.9
    assert found.min() >= -1.6
    assert found.max() <= 1.6


def test_fields_are_between_their_edges():
    rng = np.random.default_rng(3)
    x, y = rng.uniform(-4000.0, 4000.0, (2, 40_000))
    off, row, number = field_lines.fields(field_lines.NUMPY, x, y, (230.0, 160.0))
    assert off.min() >= 0.0
    assert off.max() <= 80.0 + 1e-9
    # Places a metre apart in different fields are near the edge between them.
    _, other_row, other_number = field_lines.fields(field_lines.NUMPY, x + 1.0, y, (230.0, 160.0))
    crossed = (row != other_row) | (number != other_number)
    assert 0.002 < crossed.mean() < 0.05
    assert off[crossed].max() < 2.5
    assert len(np.unique(np.stack([row, number]), axis=1).T) > 400


def test_trees_of_open_land_stand_in_groups_and_about_as_many_as_the_cover_says(shot):
    rng = np.random.default_rng(5)
    open_land = shot(
        {"canopy_fuel": filled(0.0), "surface_fuel": filled(0.5)}, biome="grassland", tree_cover=0.004
    )
    place = np.column_stack([rng.uniform(-4e5, 4e5, (20_000, 2)), np.zeros(20_000)])
    # Only noise counts here: places beyond the run have the hollow of its edge.
    part = stand_structure._scattered(open_land, 0.004, place)
    hollow = cover.hollows(open_land.ground)
    level = float(np.exp(stand_structure._HOLLOW * np.median(hollow)))
    assert 0.25 < part.mean() / (0.004 / stand_structure._FULL) / level < 4.0
    assert np.quantile(part, 0.99) > 8.0 * np.median(part)


def brush(shot):
    """Places (n, 3) of bushes of the understorey."""
    things = understorey.grow(shot)
    kind = understorey.kinds(shot)["brush"]
    return things.position[np.isin(things.model, kind.models)]


def test_there_are_more_bushes_where_more_of_the_land_is_under_them(shot):
    bare = shot({"canopy_fuel": filled(0.0), "surface_fuel": filled(0.5)})

    def count(**forest):
        return len(brush(bare.with_settings(replace(bare.settings, forest=Forest(**forest)))))

    few, many = (count(biome="grassland", shrub_cover=part) for part in (0.02, 0.6))
    assert many > 5 * max(few, 1)
    assert count(biome="maquis") > count(biome="grassland")


def test_bushes_of_pastures_are_hedges(shot):
    made = shot({"canopy_fuel": filled(0.0), "surface_fuel": filled(0.3)}, biome="pasture")
    land = biomes.choose(made).biome.open_land
    place = brush(made)
    assert len(place) > 20
    off = field_lines.fields(field_lines.NUMPY, *place[:, :2].T, land.field)[0]
    assert np.mean(off < 0.5 * land.hedge) > 0.9


def test_bushes_stand_in_groups_and_cover_about_as_much_as_is_said():
    land = biomes.known()["chaparral"].open_land
    place = np.random.default_rng(1).uniform(-20_000.0, 20_000.0, (20_000, 3)) * [1.0, 1.0, 0.0]
    noise = patterns.at(place)
    level = patterns.Numbers(np.zeros(len(place)))
    _, middling, wet = patterns.wetness(noise, level, land)
    valleys = patterns.draws(noise, middling, land).value
    assert 0.01 < valleys.mean() < 0.25
    assert wet.value[valleys > 0.5].mean() > wet.value[valleys == 0.0].mean() + 0.4
    before = -1.0
    for part in (0.0, 0.06, 0.3, 0.6, 0.85):
        cover = patterns.bushes(noise, patterns.Numbers(np.full(len(place), part)), wet, land)[1].value
        assert before < cover.mean()
        assert part / 1.8 - 0.01 <= cover.mean() <= 1.8 * part + 0.01
        before = cover.mean()
        if 0.0 < part < 0.7:
            assert cover.std() > 0.05
