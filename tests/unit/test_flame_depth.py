"""Flame depth of the front for any cell size, and cooling of the ground behind it."""

import numpy as np
import pytest
from firetwin.run import areas
from firetwin.shot.fire import air_temperature, emissions, flame_depth
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin_core import run as runs
from small_run import NT, RUN_TOML

NORTH, EAST = areas.metres_per_degree(38.9)
N, PACE = 24, 0.5  # fuel cells along a side; m/s


def shot_of(make_run, cell, load, canopy=0.0, flank=1.0):
    """A front that goes east at `PACE`, and north of the middle so much slower, over cells of `cell` m."""
    fine = (np.arange(N) - 0.5 * (N - 1)) * cell
    coarse = fine.reshape(-1, 2).mean(axis=1)
    north, east = np.meshgrid(fine, fine, indexing="ij")
    arrival = (east - east.min()) / (PACE * np.where(north > 0.0, flank, 1.0)) + 1.0
    shape = (NT, N // 2, N // 2)
    folder = make_run(
        toml=RUN_TOML.replace("synthetic = true", "synthetic = false").replace("60.0", f"{arrival.max()}"),
        latitude=38.9 + coarse / NORTH,
        longitude=-120.6 + coarse / EAST,
        elevation=np.zeros(shape[1:], np.float32),
        fuel_latitude=38.9 + fine / NORTH,
        fuel_longitude=-120.6 + fine / EAST,
        surface_fuel=np.full((N, N), load, np.float32),
        canopy_fuel=np.full((N, N), canopy, np.float32),
        fuel_arrival_time=arrival.astype(np.float32),
        heat_flux=np.ones(shape, np.float32),
        temperature=None,
        wind_east=None,
        wind_north=None,
    )
    settings = Settings(
        time=Time(frames=3),
        terrain=TerrainSettings(near_radius=0.0, apron=2000.0),
        forest=Forest(trees=False),
    )
    return Shot(settings, runs.open(folder))


@pytest.mark.parametrize("cell", [10.0, 30.0, 370.0])
@pytest.mark.parametrize(
    ("load", "canopy", "stands"), [(0.3, 0.0, 15.0), (2.0, 0.0, 45.0), (2.0, 1.0, 120.0)]
)
def test_flames_are_as_deep_as_the_front_is_fast_whatever_the_cells(make_run, cell, load, canopy, stands):
    shot = shot_of(make_run, cell, load, canopy)
    assert flame_depth.head(shot.front, *shot.frames.span) == pytest.approx(PACE * stands, rel=0.02)


def test_flanks_are_thinner_than_the_head(make_run):
    shot = shot_of(make_run, 20.0, 0.3, flank=0.1)
    front, margin = shot.front, shot.bare_ground.fields.margin
    inner = slice(margin + 4, margin + N - 4)
    deep = (front.speed * front.residence)[inner, inner]
    assert deep[:4] == pytest.approx(7.5, rel=0.02)
    assert deep[-4:] == pytest.approx(0.75, rel=0.02)
    assert shot.front_scale == pytest.approx(0.15)  # patterns of grass are finer than a crown fire's


def test_a_grass_scar_cools_in_minutes_and_a_forests_in_hours():
    grass, timber = (emissions.KINDS[kind].residence for kind in (emissions.GRASS, emissions.LITTER))
    age = np.array([60.0, 300.0, 900.0, 3600.0])
    above = air_temperature.cooling(age, grass)
    assert (np.diff(above) < 0.0).all()
    assert above[0] > 30.0
    assert above[1] < 20.0
    assert above[2] < 10.0
    assert air_temperature.cooling(3600.0, timber) > 30.0
    assert air_temperature.cooling(3600.0, timber) == air_temperature.cooling(3600.0)
    assert air_temperature.cooling(1.0, grass) == air_temperature.cooling(1.0, timber)
