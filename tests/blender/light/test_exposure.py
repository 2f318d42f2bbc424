"""Exposure metering: glow by night, shade of smoke, and smoothness over time."""

import shutil
from dataclasses import replace
from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin.run.sun import Moon
from firetwin.scene import glow
from firetwin.shot import sections
from firetwin.shot import settings as scene_settings
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.satellite import Satellite
from firetwin.shot.fire import emissions
from firetwin.shot.fire.fire import Fire
from firetwin.shot.fire.smoke_scale import Scale
from firetwin.shot.light import exposure, exposure_meter, sky
from firetwin.shot.shot import Shot

MIDDLE = 38.845, -120.55
DAY, NIGHT = datetime(2014, 9, 17, 21, 30, tzinfo=UTC), datetime(2014, 9, 18, 6, 30, tzinfo=UTC)


def fire(run_folder, folder, start, heat=0.1):
    """The run with another start and a part of its heat: the King Fire has a tenth, 44 GW."""
    shutil.copytree(run_folder, folder)
    text = (folder / "run.toml").read_text()
    (folder / "run.toml").write_text(text.replace("2014-09-17T21:00:00Z", start))
    np.save(folder / "heat_flux.npy", heat * np.load(folder / "heat_flux.npy"))
    return runs.open(folder)


@pytest.fixture(scope="session")
def run(run_folder, tmp_path_factory):
    return fire(run_folder, tmp_path_factory.mktemp("day") / "run", "2014-09-17T21:00:00Z")


@pytest.fixture(scope="session")
def night_run(run_folder, tmp_path_factory):
    return fire(run_folder, tmp_path_factory.mktemp("night") / "run", "2014-09-18T06:00:00Z")


@pytest.fixture(scope="session")
def firestorm(run_folder, tmp_path_factory):
    """Ten King Fires by night."""
    return fire(run_folder, tmp_path_factory.mktemp("storm") / "run", "2014-09-18T06:00:00Z", heat=1.0)


@pytest.fixture(autouse=True)
def large(monkeypatch):
    """The run's few cells hold the heat of a fire of 15 km, and the smoke that all looks were chosen for."""
    crowns = np.array([0.0, 0.0, 0.0, 1.0])
    monkeypatch.setattr(Shot, "scale", Scale())
    monkeypatch.setattr(Fire, "smoke", emissions.Mix(crowns, emissions.PLAIN / emissions.KINDS[3].gain))


@pytest.fixture
def filmed(settings):
    """Settings of one camera that looks at the fire from these kilometres south of it."""

    def make(*kilometres, moment=NIGHT, frames=1, at=(0.0, 1.0), light=None, **smoke):
        keys = tuple(
            CameraKey(when, MIDDLE[0] - away / 111.0, MIDDLE[1], 700.0, "point", *MIDDLE, 300.0)
            for when, away in zip(at, kilometres, strict=False)
        )
        return replace(
            settings,
            time=sections.Time(start=moment, end=moment if frames == 1 else None, frames=frames),
            smoke=sections.SmokeSettings(**smoke),
            light=light or settings.light,
            cameras=(scene_settings.Camera("drone", Drone(keys=keys)),),
        )

    return make


def stops(settings, run):
    shot = Shot(settings, run)
    return exposure.at(shot, np.arange(1, shot.frames.count + 1))


def test_the_nearer_the_fire_by_night_the_shorter_the_exposure(filmed, night_run):
    far, near, close = (stops(filmed(away), night_run)[0] for away in (14.0, 4.0, 1.5))
    assert far > max(near, close) + 0.3


@pytest.mark.parametrize(("moon", "ground"), [(0.0, 0.008), (1.0, 0.02)])
@pytest.mark.parametrize("away", [1.5, 14.0])
def test_unlit_ground_is_dark_but_readable_in_a_picture_exposed_for_flames(
    filmed, night_run, moon, ground, away
):
    shot = Shot(filmed(away), night_run)
    exposed = 2.0 ** stops(filmed(away), night_run)[0]
    unlit = exposure_meter.clear(sky.State(200.0, -30.0, Moon(150.0, 40.0, moon)))[0] * exposed
    flame = glow.brightness(shot) * exposure_meter.luminance(glow.FLAME) * exposed
    assert 0.15 * ground < unlit < ground
    assert flame > 100.0 * unlit


def test_dusk_is_exposed_to_be_seen(filmed, run_folder, tmp_path):
    """Half an hour after sunset level ground is brighter than a night of 4 stops would show it."""
    run = fire(run_folder, tmp_path / "run", "2014-09-18T02:15:00Z")
    settings = filmed(14.0, moment=datetime(2014, 9, 18, 2, 30, tzinfo=UTC))
    shot = Shot(settings, run)
    assert -6.0 < exposure._sun(shot, 1) < -4.0
    ground = exposure_meter.clear(sky.state(shot, shot.frames.time(1)))[0]
    assert 0.008 < ground * 2.0 ** stops(settings, run)[0] < 0.06


def test_without_smoke_nothing_glows_and_the_night_is_exposed_for_its_moon(filmed, night_run):
    moonlit = stops(filmed(1.5, enabled=False), night_run)[0]
    assert moonlit > stops(filmed(1.5), night_run)[0] + 1.0
    assert 3.0 < moonlit <= 4.0


@pytest.mark.parametrize("away", [1.5, 4.0])
def test_smoke_that_glows_keeps_its_colour_and_does_not_drown_the_picture(filmed, firestorm, away):
    shot = Shot(filmed(away), firestorm)
    _, light = exposure.radiance(shot, shot.paths[0], 1)
    exposed = np.sort(light) * 2.0 ** exposure.at(shot, np.array([1]))[0]
    assert exposed[-len(light) // 10 :].mean() < 0.35
    assert exposed.mean() < 0.11
    assert exposed[-len(light) // 10 :].mean() > 0.32 or exposed.mean() > 0.08


@pytest.mark.parametrize("away", [4.0, 14.0])
def test_by_day_it_is_about_that_of_a_clear_day_wherever_the_camera_is(filmed, run, away):
    assert stops(filmed(away, moment=DAY), run)[0] == pytest.approx(0.6, abs=0.6)


def test_young_smoke_is_darker_than_old(filmed, run):
    shot = Shot(filmed(4.0, moment=DAY), run)
    smoke = exposure_meter._smoke(shot, shot.frames.first)
    assert np.all(np.diff(smoke.bright) >= 0.0)
    assert smoke.bright[0] < 0.4 < smoke.bright[-1] == 1.0
    most = smoke.depth.max(axis=1).argmax()
    one = slice(most, most + 1)
    first = replace(smoke, place=smoke.place[one], radius=smoke.radius[one], depth=smoke.depth[one])
    south = smoke.place[most] - np.array([0.0, 9000.0, 0.0])
    north = np.tile([0.0, 1.0, 0.0], (len(south), 1))
    depth, met, bright = exposure_meter._depth(first, south, north, np.inf)
    assert np.all((depth > 0.0) & (met < 9000.0))
    assert bright[0] < bright[-1] == 1.0


def test_deep_under_smoke_it_is_dark_by_day(filmed, run):
    beside, under, clear = (
        Shot(filmed(away, moment=DAY, enabled=enabled), run)
        for away, enabled in ((14.0, True), (1.0, True), (1.0, False))
    )
    assert exposure.darkness(under, under.frames.times)[0] > 0.1
    assert exposure.darkness(beside, beside.frames.times)[0] == 0.0
    assert exposure.darkness(clear, clear.frames.times)[0] == 0.0
    assert exposure.at(under, np.array([1]))[0] > exposure.at(clear, np.array([1]))[0] + 0.5


def test_it_is_smooth_where_the_camera_jumps(filmed, firestorm):
    found = stops(filmed(14.0, 14.0, 1.5, 1.5, frames=48, at=(0.0, 0.5, 0.52, 1.0)), firestorm)
    assert found[0] > found[-1] + 0.3
    assert np.abs(np.diff(found)).max() < 0.25 * (found[0] - found[-1])


def test_ground_under_smoke_lies_in_its_shade(filmed, run):
    def ground(**smoke):
        shot = Shot(filmed(4.0, moment=DAY, **smoke), run)
        camera = shot.paths[0]
        down = replace(camera, rotation=np.eye(3)[None], position=np.array([[2500.0, 800.0, 1800.0]]))
        return exposure.radiance(shot, down, 1)[0].mean()

    assert ground() < 0.8 * ground(enabled=False)


def test_ground_behind_a_ridge_lies_in_its_shade_and_slopes_to_the_sun_are_brighter():
    land = SimpleNamespace(up=lambda x, _y: 300.0 * np.exp(-((np.asarray(x) / 150.0) ** 2)))
    sun = np.array([-np.cos(np.radians(20.0)), 0.0, np.sin(np.radians(20.0))])
    place = np.array([[-3000.0, 0.0, 0.0], [-100.0, 50.0, 0.0], [100.0, 0.0, 0.0], [500.0, 0.0, -40.0]])
    open_land, sunny, lee, shaded = exposure_meter._facing(SimpleNamespace(bare_ground=land), place, sun)
    assert open_land == pytest.approx(sun[2], rel=1e-6)
    assert sunny > 2.0 * open_land
    assert lee == shaded == 0.0
    assert exposure_meter._facing(SimpleNamespace(bare_ground=land), place + 1500.0, sun)[3] > 0.0


def test_what_the_scene_file_says_wins_at_every_frame(filmed, night_run):
    given = sections.Light(exposure=-1.25)
    assert np.all(stops(filmed(1.5, frames=3, light=given), night_run) == -1.25)


def test_all_that_a_satellite_sees_is_ground(filmed, run):
    cameras = (scene_settings.Camera("satellite", Satellite(swath=20_000.0)),)
    shot = Shot(replace(filmed(4.0, moment=DAY, enabled=False), cameras=cameras), run)
    found, _ = exposure.radiance(shot, shot.paths[0], 1)
    assert np.ptp(found) < 0.06  # slopes, and haze over valleys; the sky would be brighter than all ground


def test_from_over_the_equator_there_is_light_too(filmed, run):
    cameras = (scene_settings.Camera("satellite", Satellite(swath=20_000.0, geostationary=-137.0)),)
    settings = replace(filmed(4.0, moment=DAY, enabled=False), cameras=cameras)
    assert stops(settings, run)[0] == pytest.approx(0.5, abs=0.8)


def test_flames_are_drawn_brighter_where_the_exposure_is_shorter(filmed, night_run):
    far, close = (glow.brightness(Shot(filmed(away), night_run)) for away in (14.0, 1.5))
    assert close > 1.5 * far


def test_under_crowns_a_picture_is_exposed_longer_and_over_them_it_is_not(filmed, run):
    day = filmed(3.0, moment=DAY, enabled=False)
    (camera,) = day.cameras

    def stops(height, trees):
        keys = tuple(replace(key, height=height) for key in camera.rig.keys)
        settings = replace(day, cameras=(replace(camera, rig=replace(camera.rig, keys=keys)),))
        shot = Shot(replace(settings, forest=replace(settings.forest, trees=trees)), run)
        return float(exposure.at(shot, np.array([1.0]))[0])

    assert stops(3.0, True) > stops(3.0, False) + 0.5
    assert stops(300.0, True) == stops(300.0, False)
