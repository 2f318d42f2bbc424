"""Smoke and heat of a fire are in the air or have left, over terrain and in nests: sums over snapshots."""

import closure
import numpy as np
import pytest
from firetwin.run import info
from firetwin.shot.satellites import imager

MOST = 0.005  # relative error of each sum
QUICK = [
    ("front in wind", "hills"),
    ("strong wind", "flat"),
    ("starts late", "slope"),
    ("fluxes alone", "hills"),
    ("one cell of 1e7 W/m2", "slope"),
]


@pytest.mark.parametrize(("fire", "terrain"), QUICK)
def test_smoke_and_heat_of_a_fire_are_in_the_air_or_have_left(tmp_path, fire, terrain):
    sums = closure.measure(closure.make_shot(tmp_path / "run", fire, terrain, spin_up=125.0), count=150)
    assert abs(sums.smoke) < MOST
    assert abs(sums.nest) < MOST
    assert abs(sums.run) < MOST
    assert abs(sums.air) < MOST


@pytest.mark.parametrize("fire", ["front in wind", "calm", "fluxes alone", "goes out"])
def test_power_of_a_fire_is_linear_between_model_times(tmp_path, fire):
    """Without the factor, heat is 2 to 7 % more if cells burn during only two model times."""
    shot = closure.make_shot(tmp_path / "run", fire, "flat")
    first, last = float(shot.run.times[6]), float(shot.run.times[7])
    power = np.array([shot.fire.sources(time).power.sum() for time in np.linspace(first, last, 9)])
    np.testing.assert_allclose(power, np.linspace(power[0], power[-1], 9), rtol=1e-6)
    assert power[0] == pytest.approx(closure.heat_of_run(shot, first - 1e-6, first + 1e-6) / 2e-6, rel=1e-6)


def test_cells_over_high_ground_are_thinner(tmp_path):
    (box, nest) = closure.domains(closure.make_shot(tmp_path / "run", "front in wind", "slope"))
    depth = np.gradient(box.heights(), axis=0) * box.box.spacing**2
    np.testing.assert_allclose(box.volumes(), depth, rtol=1e-9)
    assert np.ptp(box.volumes()[0]) > 0.05 * box.volumes()[0].mean()
    assert nest.volumes().sum() < box.volumes().sum()


@pytest.mark.parametrize("fire", ["front in wind", "crowns", "fluxes alone"])
def test_scar_and_satellite_picture_have_the_area_and_heat_of_the_run(tmp_path, fire):
    shot = closure.make_shot(tmp_path / "run", fire, "hills")
    now, cell = shot.frames.last, 30.0
    scar = np.count_nonzero((shot.ground.burned >= 0.5) & (shot.ground.arrival <= now)) * cell**2
    passed = np.count_nonzero(shot.run.fuel_arrival_time() <= now) * cell**2
    assert scar == pytest.approx(passed, rel=MOST)
    if fire != "fluxes alone":  # whose burned area counts the heat of partly burned cells
        assert scar == pytest.approx(info.burned(shot.run, [now])[0], rel=MOST)
    instrument = imager.INSTRUMENTS["viirs"]
    grid = imager.grid_of(instrument, shot.run, -137.0)
    shown = imager.picture(instrument, grid, shot.fire, now).heat
    assert shown == pytest.approx(closure.heat_of_run(shot, now - 0.5, now + 0.5), rel=MOST)
