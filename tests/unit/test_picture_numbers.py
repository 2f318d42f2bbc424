"""What the gallery says of pictures is so: stairs, walls and horizons, smoke of known outline, brightness."""

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("scipy")
pytest.importorskip("matplotlib")
sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))
numbers = pytest.importorskip("gallery_numbers")
land = pytest.importorskip("gallery_land")
pictures = pytest.importorskip("gallery_pictures")

HIGH, WIDE = 180, 320


@pytest.fixture
def texture():
    """Rough ground without a direction."""
    noise = np.random.default_rng(7).standard_normal((HIGH, WIDE))
    spectrum = np.fft.rfft2(noise)
    wave = np.hypot(np.fft.fftfreq(HIGH)[:, None], np.fft.rfftfreq(WIDE))
    field = np.fft.irfft2(spectrum / (wave + 0.02) ** 1.4, s=noise.shape)
    return 0.4 + 0.016 * field / field.std()


def stairs(side):
    """Half of a picture in steps of `side` pixels."""
    y, x = np.mgrid[:HIGH, :WIDE] // side
    return np.where(x + 2 * y < WIDE / side, 0.3, 0.0)


def slope(rise):
    """An edge across the picture that rises by so many pixels for each pixel, softened over two."""
    y, x = np.mgrid[:HIGH, :WIDE]
    return 0.3 * np.clip((y - HIGH / 2 - rise * (x - WIDE / 2)) / 2 + 0.5, 0, 1)


def test_stairs_and_walls_are_told_from_ground(texture):
    assert numbers.straight(texture)[0] < 0.1
    found, where = numbers.straight(texture + stairs(20))
    assert found > 5.0
    edges = np.abs(np.diff(stairs(20), axis=1)) + np.abs(np.diff(stairs(20), axis=0, append=0)[:, 1:]) > 0
    near = edges | np.roll(edges, 1, 0) | np.roll(edges, 1, 1) | np.roll(edges, -1, 0) | np.roll(edges, -1, 1)
    assert near[where[:, 1:]].mean() > 0.95


def test_it_is_the_same_turned_by_a_right_angle(texture):
    picture = texture + stairs(15)
    there = numbers.straight(picture)[0]
    assert numbers.straight(picture.T)[0] == pytest.approx(there, rel=0.02)
    assert numbers.straight(picture[::-1])[0] == pytest.approx(there, rel=0.02)


@pytest.mark.parametrize("rise", [0.15, 0.3, 1.0])
def test_an_edge_that_leans_is_no_grids(texture, rise):
    assert numbers.straight(texture + slope(rise))[0] < 0.5


def test_a_disc_has_no_straight_runs(texture):
    y, x = np.mgrid[:HIGH, :WIDE]
    disc = 0.3 * np.clip(70 - np.hypot(y - 90, x - 160) + 0.5, 0, 1)
    assert numbers.straight(texture + disc)[0] < 0.5


def test_a_horizon_is_left_out_and_a_wall_before_it_is_not(texture):
    sky = np.where(np.arange(HIGH)[:, None] < 60, 0.9, 0.0) + np.zeros((1, WIDE))
    sky[:, 100:140] = 0.0  # smoke before it
    assert numbers.straight(texture + sky)[0] > 0.5  # the smoke's own sides are as straight as a wall
    level = np.where(np.arange(HIGH)[:, None] < 60, 0.9, 0.0) * (np.arange(WIDE) % 160 > 50)
    level = np.minimum(level, 0.45 + 0.45 * np.sin(np.arange(WIDE) / 9.0))
    assert not numbers.straight(texture + level)[1][55:66].T.sum() > 9 * 4


@pytest.mark.parametrize(("length", "counts"), [(8, False), (12, True), (110, True), (150, False)])
def test_only_runs_of_some_length_count(texture, length, counts):
    post = np.zeros((HIGH, WIDE))
    post[10 : 10 + length, 100:104] = 0.5
    assert numbers.straight(texture + post)[1][:, 95:110].any() == counts


def test_a_plain_picture_has_none():
    assert numbers.straight(np.full((40, 60), 0.5))[0] == 0.0
    ramp = np.linspace(0.2, 0.4, WIDE) + np.zeros((HIGH, 1))
    assert numbers.straight(np.round(ramp * 255) / 255)[0] == 0.0  # steps of 8 bits


def puffs(radii):
    """Light of round puffs apart from each other."""
    light, at = np.zeros((2 * max(radii) + 6, sum(2 * r + 4 for r in radii) + 4)), 3
    y, x = np.mgrid[: light.shape[0], : light.shape[1]]
    for radius in radii:
        light[np.hypot(y - max(radii) - 3, x - at - radius) <= radius] = 1.0
        at += 2 * radius + 4
    return light[..., None] * np.ones(3)


def test_round_puffs_have_the_dimension_of_discs_whatever_the_exposure():
    clear = np.full_like(puffs((5, 8, 12, 17, 25, 40)), 0.2)
    for factor in (0.01, 1.0, 50.0):
        smoke = (clear + puffs((5, 8, 12, 17, 25, 40))) * factor
        found = numbers.dimensions(smoke, clear * factor, brighter=True)
        assert found["blobs_0.06"] == 6
        assert found["dimension_0.06"] == pytest.approx(1.0, abs=0.05)
        assert found["dimension_0.12"] == pytest.approx(1.0, abs=0.05)
        assert numbers.dimension(found) == pytest.approx(1.0, abs=0.05)


def test_one_puff_is_measured_by_rulers():
    puff = np.pad(puffs((60,)), [(20, 20), (20, 20), (0, 0)])
    clear = np.full_like(puff, 0.2)
    found = numbers.dimensions(clear + puff, clear, brighter=True)
    assert np.isnan(found["dimension_0.06"])
    assert numbers.dimension(found) == pytest.approx(1.0, abs=0.06)
    assert np.isnan(numbers.dimension(numbers.dimensions(clear, clear, brighter=True)))


def test_a_shadow_is_no_smoke_from_above():
    clear = np.full_like(puffs((5, 8, 12, 17, 25)), 0.5)
    shadow = clear - 0.4 * puffs((5, 8, 12, 17, 25))
    assert numbers.dimensions(shadow, clear, brighter=True)["smoke_0.06"] == 0.0
    assert numbers.dimensions(shadow, clear, brighter=False)["smoke_0.06"] > 0.2


def test_median_and_clipped():
    colours = np.full((10, 10, 3), 0.3)
    colours[0, :5, 0] = 1.0  # red alone is enough
    assert numbers.clipped(colours) == 5.0
    assert numbers.median(colours[..., 1]) == pytest.approx(0.3)
    assert numbers.within("median", 0.3)
    assert not numbers.within("median", 0.05)
    assert numbers.within("median", float("nan")) is None
    assert numbers.within("smoke_0.06", 1.0) is None


SCENE = """# Fire: an hour.
run = "x"
[time]
frames = 4
[render]
samples = 3

# From the west; 87 % of
# the front shows.
[[cameras]]
name = "overview"

# No word of it.
[[cameras]]
name = "chase"

# From above; 100 % of the front is in the picture.
[[cameras]]
name = "satellite"
kind = "satellite"
"""


def test_a_scene_is_read_for_cameras_and_what_they_show(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    assert pictures._cameras(scene) == {"overview": "overview", "drone": "chase", "satellite": "satellite"}
    assert pictures._front_seen(scene) == {"overview": 0.87, "satellite": 1.0}


@pytest.mark.parametrize("more", ["", "[smoke]\nenabled = true\n", "[smoke]  # of it\nspin_up = 60.0\n"])
def test_smoke_is_switched_off_in_any_scene(tmp_path, more):
    import tomllib

    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace("[time]", more + "[time]"))
    text = pictures._without_smoke(scene, tmp_path / "clear.toml").read_text()
    found = tomllib.loads(text)
    assert found["smoke"].pop("enabled") is False
    assert found["smoke"] == ({"spin_up": 60.0} if "spin_up" in more else {})
    assert found["run"] == "x"


def test_slopes_face_downhill_and_patches_have_their_shares():
    north = np.arange(40.0)[:, None] * 3.0 + np.zeros((1, 50))  # rises to the north
    found = land.Land.of((40.0, 10.0), 30.0, north, np.full((40, 50), 102))
    slope, aspect = found.slope_and_aspect
    np.testing.assert_allclose(slope, 0.1)
    np.testing.assert_allclose(aspect, 180.0)
    latitude, longitude = found.axes
    assert latitude.mean() == pytest.approx(40.0)
    assert longitude.mean() == pytest.approx(10.0)
    kinds = land.patches((80, 90), 30.0, 3, 600.0, {101: 0.25, 145: 0.75})
    assert (kinds == 101).mean() == pytest.approx(0.25, abs=0.01)


def test_optical_depths_are_read_from_what_is_said_of_smoke():
    line = (
        "firetwin: 12 t of smoke in 5 min, from 100 % grass; optical depth from above 3.2 at "
        "most, 1.1 over a kilometre (measured over savanna fires: 0.4 to 2.5, Eck et al. 2003)\n"
    )
    found = pictures.smoke_said(line)
    assert found["optical_depth"] == [3.2, 1.1]
    assert found["published"] == [0.4, 2.5]
    assert found["smoke"].startswith("12 t of smoke")
    assert set(pictures.smoke_said("firetwin: 3 kg of smoke in 5 min, from 100 % grass\n")) == {"smoke"}


def test_a_clock_that_is_moved_keeps_the_moments_of_the_fire(tmp_path):
    import tomllib
    from datetime import timedelta

    from firetwin.run import times
    from firetwin_core.run import open as open_run
    from small_run import RUN_TOML, small_fields, write_field

    run = tmp_path / "run"
    run.mkdir()
    for name, values in small_fields().items():
        write_field(run, name, values, "npy")
    (run / "run.toml").write_text(RUN_TOML)
    opened = open_run(run)
    start = times.utc(opened, float(opened.times[1]))
    scene = tmp_path / "fitted.toml"
    scene.write_text(f'run = "{run}"\n[time]\nstart = {start.isoformat()}  # said\nframes = 2\n')
    moved = tomllib.loads(pictures._moved(scene, run, tmp_path / "night.toml", 22.5).read_text())
    other = open_run(Path(moved["run"]))
    since = moved["time"]["start"] - times.utc(other, 0.0)
    assert since == timedelta(seconds=float(opened.times[1]))
    hour = moved["time"]["start"].timestamp() / 3600.0 + float(np.mean(opened.longitude)) / 15.0
    assert hour % 24.0 == pytest.approx(22.5, abs=0.02)
    np.testing.assert_array_equal(other.heat_flux(1), opened.heat_flux(1))
