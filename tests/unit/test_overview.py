"""A run without a scene file is shown by cameras that see its fire."""

import numpy as np
import pytest
from firetwin.shot import fit, overview
from firetwin.shot.choice import Choice
from firetwin_core import InputError
from firetwin_core import run as runs
from small_run import FX, FY, small_fields


@pytest.fixture
def arrival():
    values = np.full((FY, FX), np.nan, np.float32)
    values[2, 3], values[5, 7] = 0.0, 60.0
    return values


def test_the_camera_stands_windward_and_looks_at_the_middle(make_run, arrival):
    run = runs.open(
        make_run(fuel_arrival_time=arrival)
    )  # the wind blows to the east and a little to the south
    drone, satellite = overview.cameras(run)
    (key,) = drone.rig.keys
    assert key.target_longitude == pytest.approx(np.mean(run.fuel_longitude[[3, 7]]))
    assert key.target_latitude == pytest.approx(np.mean(run.fuel_latitude[[2, 5]]))
    assert key.longitude < key.target_longitude
    assert key.latitude > key.target_latitude
    east = (key.target_longitude - key.longitude) * 111.32 * np.cos(np.radians(38.9))
    south = (key.latitude - key.target_latitude) * 111.0
    assert east / south == pytest.approx(2.0, rel=0.01)
    assert satellite.kind == "satellite"
    assert satellite.rig.swath >= 4000


def test_without_wind_it_stands_in_the_south_west(make_run, arrival):
    run = runs.open(make_run(fuel_arrival_time=arrival, wind_east=None, wind_north=None))
    key = overview.cameras(run)[0].rig.keys[0]
    assert key.longitude < key.target_longitude
    assert key.latitude < key.target_latitude


def test_a_run_that_burns_nothing_is_seen_whole(make_run):
    run = runs.open(make_run(fuel_arrival_time=np.full((FY, FX), np.nan, np.float32)))
    key = overview.cameras(run)[0].rig.keys[0]
    assert key.target_latitude == pytest.approx(np.mean(run.fuel_latitude[[0, -1]]))


def test_a_choice_is_a_scene_file_with_other_things_in_its_place(make_run, tmp_path):
    folder = make_run()
    (tmp_path / "scene.toml").write_text('run = "elsewhere"\n')
    shot = Choice(str(tmp_path / "scene.toml"), str(folder), str(tmp_path / "c"), "eevee", "cpu").shot()
    assert shot.run.name == "Small"
    assert (shot.settings.render.engine, shot.settings.render.device) == ("eevee", "cpu")
    assert shot.settings.cache == tmp_path / "c"
    assert not shot.settings.cameras
    with pytest.raises(InputError, match="elsewhere"):
        Choice(str(tmp_path / "scene.toml")).shot()


def test_a_run_alone_has_cameras_that_fit_it(make_run):
    shot = Choice(run=str(make_run())).shot()
    fit.check(shot.settings, shot.run)
    assert [camera.name for camera in shot.settings.cameras] == ["overview", "satellite"]
    assert shot.settings.smoke.method == "puffs"  # solving the air of a whole run is not done unasked
    assert Choice(run=str(shot.settings.run), smoke="flow").shot().settings.smoke.method == "flow"
    assert Choice(**Choice(run="here", engine="eevee").plain()) == Choice(run="here", engine="eevee")


def test_a_camera_that_ridges_hide_is_told_and_stays(make_run, tmp_path):
    """A ridge stands between a low lookout and the fire."""
    fields = small_fields()
    elevation = np.full_like(fields["elevation"], 500.0)
    elevation[:, 2] = 1500.0
    arrival = np.full((FY, FX), np.nan, np.float32)
    arrival[:, 8:] = np.linspace(0.0, 100.0, FY)[:, None]
    folder = make_run(elevation=elevation, fuel_arrival_time=arrival)
    scene = tmp_path / "scene.toml"

    def shot(raised):
        scene.write_text(
            f'run = "{folder}"\n[time]\nframes = 2\n[ground]\nnear_radius = 0.0\napron = 0.0\n'
            f'[[cameras]]\nname = "lookout"\nover_ridges = {raised}\n'
            'keys = [{latitude = 38.9045, longitude = -120.6, height = 60.0, target = "fire"}]\n'
        )
        return Choice(str(scene)).shot()

    low, high = shot("false"), shot("true")
    above = [s.paths[0].position[0][2] - s.ground.up(*s.paths[0].position[0][:2])[0] for s in (low, high)]
    assert above[0] == pytest.approx(60.0, abs=1.0)
    assert above[1] > 500.0
    (text,) = low.warnings()
    assert "2 of 2 frames" in text
    would = float(text.split(";")[1].split()[0].replace(",", ""))
    assert would == pytest.approx(above[1], abs=1.0)
    (text,) = high.warnings()
    assert f"{above[1] - above[0]:,.0f} m higher" in text
