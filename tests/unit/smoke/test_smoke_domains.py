"""Boxes of a flow round fires of any size, anywhere: they hold the fire, and a budget pays for them."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from firetwin.run import areas
from firetwin.run import opening as runs
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.shot.light import exposure
from firetwin.shot.sections import Time
from firetwin.shot.settings import Camera, Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import domains
from small_run import RUN_TOML

CELLS, TIMES = 40, 9


def fields(side, latitude, wind, interval, places, canopy):
    """A run of `side` m with a round fire at each of these places (parts of the side)."""
    north, east = areas.metres_per_degree(latitude)
    metres = (np.arange(CELLS) + 0.5) / CELLS * side
    x, y = np.meshgrid(metres, metres)
    whole = interval * (TIMES - 1)
    speed = 0.15 * side / whole
    arrival = np.min([np.hypot(x - a * side, y - b * side) / speed for a, b in places], axis=0)
    arrival[arrival > 0.9 * whole] = np.nan
    flux = np.zeros((TIMES, CELLS, CELLS), np.float32)
    for k in range(TIMES):
        flux[k][(arrival <= k * interval) & (arrival > (k - 1) * interval)] = 5e4
    flat = np.zeros((CELLS, CELLS), np.float32)
    blowing = np.broadcast_to(np.float32(wind), flux.shape)
    return {
        "latitude": latitude + metres / north,
        "longitude": 10.0 + metres / east,
        "elevation": flat,
        "fuel_latitude": latitude + metres / north,
        "fuel_longitude": 10.0 + metres / east,
        "surface_fuel": flat + 0.5,
        "canopy_fuel": flat + canopy,
        "heat_flux": flux,
        "temperature": None,
        "wind_east": blowing,
        "wind_north": 0.0 * blowing,
        "fuel_arrival_time": arrival.astype(np.float32),
    }


@pytest.fixture
def make_shot(make_run):
    def make(side, latitude=40.0, wind=5.0, interval=900.0, places=((0.5, 0.5),), canopy=0.0):
        toml = RUN_TOML.replace("interval_s = 60.0", f"interval_s = {interval}")
        run = runs.open(make_run(toml=toml, **fields(side, latitude, wind, interval, places, canopy)))
        degrees = float(run.latitude[CELLS // 2]), float(run.longitude[CELLS // 2])
        key = CameraKey(0.0, degrees[0] - 0.3 * side / 111e3, degrees[1], 0.1 * side, "point", *degrees)
        camera = Camera("drone", rig=Drone(keys=(key,)))
        start = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)
        time = Time(start=start, frames=3)
        settings = replace(Settings(), run=run.path, time=time, cameras=(camera,))
        return Shot(settings, run)

    return make


CASES = [
    {"side": 1000.0},
    {"side": 1000.0, "interval": 60.0, "wind": 0.0},
    {"side": 5000.0, "latitude": 69.5},
    {"side": 20_000.0, "latitude": -42.0, "canopy": 1.0},
    {"side": 40_000.0, "latitude": 2.0, "interval": 21_600.0},
    {"side": 100_000.0, "places": ((0.2, 0.2), (0.8, 0.7))},
    {"side": 500_000.0, "interval": 3600.0, "wind": 12.0},
]


@pytest.mark.parametrize("case", CASES, ids=str)
def test_any_fire_gets_boxes_round_its_heat(make_shot, case):
    shot = make_shot(**case)
    box = domains.outer_box(shot)
    for time in (shot.frames.first, shot.frames.middle, shot.frames.last):
        found = shot.fire.sources(time)
        if found.power.sum() > 0.0 and box is not None:
            place = found.position[:, :2]
            inside = ((place > box.corner) & (place < box.high)).all(axis=1)
            assert found.power[inside].sum() > 0.9 * found.power.sum()
    assert box is not None
    assert np.prod(box.shape) * (len(box.levels) - 1) < 20e6
    assert np.all(np.diff(box.levels) > 0.0)
    nest = domains.nest_box(shot, box)
    if nest is not None:
        assert np.all(np.array(nest.corner) > box.corner)
        assert np.all(np.array(nest.high) < box.high)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_any_fire_is_exposed_for(make_shot, case):
    shot = make_shot(**case)
    stops = exposure.at(shot, np.array([1.0, 2.0, 3.0]))
    assert np.isfinite(stops).all()


def test_a_weak_fire_needs_no_air_far_above_it(make_shot):
    assert domains.outer_box(make_shot(1000.0)).levels[-1] < 6000.0


def test_cells_of_the_king_fire_have_the_levels_they_were_chosen_with():
    assert np.allclose(
        domains._levels((60.0, 270.0, 48), Scale().ratio, 1.0)[:2], (0.0, 60.0 + 0.5 * 270.0 / 48)
    )
