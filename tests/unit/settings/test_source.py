"""Shot sources: a scene file with overrides; messages on ridges."""

import numpy as np
import pytest
from firetwin.shot.source import ShotSource
from firetwin_core import InputError
from small_run import FX, FY, RUN_TOML, small_fields


def test_a_choice_is_a_scene_file_with_other_things_in_its_place(make_run, tmp_path):
    folder = make_run()
    (tmp_path / "scene.toml").write_text('run = "elsewhere"\n')
    shot = ShotSource(str(tmp_path / "scene.toml"), str(folder), str(tmp_path / "c"), "eevee", "cpu").shot()
    assert shot.run.name == "Small"
    assert (shot.settings.render.engine, shot.settings.render.device) == ("eevee", "cpu")
    assert shot.settings.cache == tmp_path / "c"
    assert not shot.settings.cameras
    with pytest.raises(InputError, match="elsewhere"):
        ShotSource(str(tmp_path / "scene.toml")).shot()


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
            f'run = "{folder.as_posix()}"\n[time]\nframes = 2\n[terrain]\nnear_radius = 0.0\napron = 0.0\n'
            f'[[cameras]]\nname = "lookout"\nover_ridges = {raised}\n'
            'keys = [{latitude = 38.9045, longitude = -120.6, height = 60.0, target = "fire"}]\n'
        )
        return ShotSource(str(scene)).shot()

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


POLES = """
run = "run"
[terrain]
apron = {apron}
"""


@pytest.mark.parametrize("latitude", [89.95, -89.97, 87.0])
def test_a_run_whose_ground_would_reach_a_pole_is_refused(make_run, tmp_path, latitude):
    fields = small_fields()
    moved = {name: fields[name] - 38.9 + latitude for name in ("latitude", "fuel_latitude")}
    make_run(toml=RUN_TOML.replace('event = "king_fire"\n', ""), **moved)
    (tmp_path / "scene.toml").write_text(POLES.format(apron=110_000.0))
    with pytest.raises(InputError, match=r"scene.toml:4:1: the run lies at 8\d.* choose a smaller apron"):
        ShotSource(str(tmp_path / "scene.toml")).shot()
    if latitude == 87.0:
        (tmp_path / "scene.toml").write_text(POLES.format(apron=2000.0))
        assert np.isfinite(ShotSource(str(tmp_path / "scene.toml")).shot().ground.floor()).all()


def test_credits_that_do_not_fit_are_refused_before_the_build(make_run, tmp_path):
    make_run()
    (tmp_path / "earth.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    words = "owner " * 2000
    camera = '{ kind = "globe", name = "g", latitude = 38.9, longitude = -120.6 }'
    text = f'run = "run"\ncameras = [{camera}]\n[terrain]\nglobe = "earth.png"\nglobe_credit = "{words}"\n'
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(InputError, match='camera "g": the credits'):
        ShotSource(str(tmp_path / "scene.toml")).shot()
