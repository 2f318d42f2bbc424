"""Finishing of pictures: detector, scales, overlays, depth and the map of the paper."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.imaging import colour_bar
from firetwin.passes import thermal as thermal_pass
from firetwin.run import opening as runs
from firetwin.shot import exr_tags, passes
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.path import Path
from firetwin.shot.fire import air_temperature
from firetwin.shot.sections import Thermal, Time
from firetwin.shot.settings import Camera, Render, Settings
from firetwin.shot.shot import Shot
from firetwin_core import sensor


@pytest.fixture(autouse=True)
def no_tags(monkeypatch):
    """Files without tags, whose camera and run most tests here do not have."""
    monkeypatch.setattr(exr_tags, "attributes", lambda *_, **__: {})


def thermal(path, radiance, **keys):
    """The thermal pass's EXR (h, w, channels) and PNG of rendered radiance."""
    files = {end: path / f"thermal.{end}" for end in ("exr", "png")}
    sensor.write_image(files["exr"], np.repeat(radiance[..., None], 3, axis=-1))
    settings = Settings(render=Render(thermal_low=290.0, thermal_high=1000.0), thermal=Thermal(**keys))
    passes.finish("thermal", files, {}, SimpleNamespace(settings=settings), "drone", 1)
    return sensor.read_image(files["exr"]), sensor.read_image(files["png"])[..., :3]


def scene(height=36, width=64):
    """300 K with a 1000 K patch, and a row of pixels that are half of each: W m-2 sr-1."""
    cold, hot = sensor.radiance([300.0, 1000.0])
    radiance = np.full((height, width), cold, np.float32)
    radiance[10:20, 10:20], radiance[25] = hot, 0.5 * (cold + hot)
    return radiance


def test_the_thermal_pass_holds_brightness_temperature_and_radiance(tmp_path):
    found, picture = thermal(tmp_path, scene())
    kelvin, radiance = np.moveaxis(found, -1, 0)
    assert np.array_equal(radiance, scene())
    assert kelvin[0, 0] == pytest.approx(300.0, abs=1e-3)
    assert kelvin[15, 15] == pytest.approx(1000.0, abs=1e-3)
    half = sensor.brightness_temperature(0.5 * sensor.radiance([300.0, 1000.0]).sum())
    assert kelvin[25] == pytest.approx(float(half), abs=1e-3)
    assert half > 700.0
    expected = sensor.colour(kelvin, 290.0, 1000.0, "white-hot", thermal_pass.KNEE)
    assert np.abs(picture - expected).max() < 0.51 / 255


def test_the_names_of_its_channels_are_in_the_exr(tmp_path):
    thermal(tmp_path, scene(), saturation=800.0, bits=14)
    header = (tmp_path / "thermal.exr").read_bytes()[:1000]
    assert all(name in header for name in (b"kelvin\0", b"radiance\0", b"signal\0"))


def test_the_detector_of_the_settings_measures(tmp_path):
    kelvin, _, signal = np.moveaxis(thermal(tmp_path, scene(), saturation=800.0, bits=14)[0], -1, 0)
    assert kelvin.max() == pytest.approx(800.0, abs=1e-3)
    assert signal.max() == 2**14 - 1
    assert np.array_equal(signal, np.round(signal))
    noisy = thermal(tmp_path, scene(), noise=0.1)[0][..., 0]
    assert noisy[0].std() == pytest.approx(0.1, rel=0.5)
    assert np.array_equal(noisy, thermal(tmp_path, scene(), noise=0.1)[0][..., 0])
    assert thermal(tmp_path, scene(), blur=2.0)[0][15, 21, 0] > 320.0
    mid, low = (sensor.radiance(300.0, band) for band in ((3.4, 4.1), (8.0, 14.0)))
    other = thermal(tmp_path, scene() / np.float32(low / mid), band="mwir")[0]
    assert other[0, 0, 0] == pytest.approx(300.0, abs=1e-3)


def test_a_bar_of_round_temperatures_stands_at_the_right(tmp_path):
    assert colour_bar.choose_ticks(290.0, 1000.0, 5.0, 20.0)[-1] == 1000.0
    assert all(kelvin % 10 == 0 for kelvin in colour_bar.choose_ticks(290.0, 1000.0, 5.0, 20.0))
    assert len(colour_bar.choose_ticks(299.0, 301.0, 5.0, 20.0)) >= 3
    _, picture = thermal(tmp_path, scene(180, 320), palette="inferno")
    bare = sensor.colour(np.full((180, 320), 300.0), 290.0, 1000.0, "inferno", thermal_pass.KNEE)
    bar = picture[20:160, 312:316].mean(axis=(1, 2))
    assert bar[0] > bar[-1] + 0.5
    assert np.all(np.diff(bar) < 0.02)
    assert np.abs(picture[30:, :280] - bare[30:, :280]).max() < 0.51 / 255


def view(perspective):
    """A camera 1 km up that looks straight down, turned so that its top is east."""
    rotation = np.array([[[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    half = (0.5, 0.25) if perspective else (500.0, 250.0)
    place = np.array([[10.0, 20.0, 1000.0]])
    return Path(Camera(name="drone"), place, rotation, place, half, perspective)


@pytest.mark.parametrize("perspective", [True, False])
def test_points_of_a_depth_are_where_the_ground_is(perspective):
    planar = np.full((20, 40), 1000.0, np.float32)
    planar[0] = 1e10
    points = pixel_rays.points(view(perspective), 1, planar)
    assert np.isnan(points[0]).all()
    assert np.abs(points[1:, :, 2]).max() < 1e-9
    assert points[10, 20, :2] == pytest.approx([10.0 - 12.5, 20.0 - 12.5])  # half a pixel right and down
    assert points[19, 39, :2] == pytest.approx([10.0 - 250.0 + 12.5, 20.0 - 500.0 + 12.5])
    ranges = pixel_rays.ranges(view(perspective), 1, planar)
    expected = np.linalg.norm(points - view(True).position[0], axis=-1) if perspective else planar
    np.testing.assert_allclose(ranges[1:], expected[1:], rtol=1e-6)
    assert np.all(ranges[0] == np.float32(1e10))


def test_a_camera_that_zooms_sees_by_its_lens_of_that_frame():
    zoomed = dataclasses.replace(view(True), wider=np.array([2.0]))
    planar = np.full((20, 40), 1000.0, np.float32)
    near, far = (pixel_rays.points(each, 1, planar) - each.position[0] for each in (view(True), zoomed))
    np.testing.assert_allclose(far[..., :2], 2.0 * near[..., :2])
    expected = np.linalg.norm(far, axis=-1)
    np.testing.assert_allclose(pixel_rays.ranges(zoomed, 1, planar), expected, rtol=1e-6)


class Seen(Shot):
    """A still of one camera that looks straight down at the middle of a run."""

    def __init__(self, run):
        super().__init__(Settings(time=Time(frames=1)), run)
        self.paths = [view(False)]


@pytest.fixture
def finished(tmp_path, make_run):
    """Finish a pass from a grey picture and the depth of even ground, half of it sky: (before, after)."""

    def finish(name, **fields):
        seen = Seen(runs.open(make_run(**fields)))
        seen.paths[0].position[:] = [0.0, 0.0, 1000.0]
        needed = {"rgb": {"png": tmp_path / "rgb.png"}, "depth": {"exr": tmp_path / "depth.exr"}}
        rgb = np.random.default_rng(0).uniform(0.0, 0.5, (20, 40, 3))
        planar = np.full((20, 40), 1000.0)
        planar[:5] = 1e10
        sensor.write_image(needed["rgb"]["png"], rgb)
        sensor.write_image(needed["depth"]["exr"], planar)
        passes.finish(name, {"png": tmp_path / "made.png"}, needed, seen, "drone", 1)
        return [sensor.read_image(path)[..., :3] for path in (needed["rgb"]["png"], tmp_path / "made.png")]

    return finish


def burning_east(warmer=20.0, **more):
    """Fields of a run whose two eastern columns burn and are warmer by so many K, over valleys and ridges."""
    elevation = 1000.0 + 300.0 * np.arange(20.0, dtype=np.float32).reshape(4, 5) % 700.0
    kelvin = np.broadcast_to(310.0 - 0.0065 * elevation, (3, 4, 5)).astype(np.float32)
    flux = np.full((3, 4, 5), 1e-30, np.float32)  # what models leave where nothing burns
    kelvin[:, :, 3:] += warmer
    flux[:, :, 3:] = 2e4
    return {"temperature": kelvin, "heat_flux": flux, "elevation": elevation} | more


def test_the_papers_map_adds_the_gradient_where_fire_warms_the_models_air(finished):
    before, after = finished("thermal_map", **burning_east())
    assert np.array_equal(after[:5], before[:5])  # sky
    assert np.abs(after[-2:] - before[-2:]).max() < 1 / 255 + 1e-6  # air as cold as it must be so high up
    warm = (after - before)[5]
    assert warm.max() > 0.2
    assert np.all(after >= before - 1e-6)


def test_the_papers_map_of_a_run_without_fire_is_the_picture(finished):
    fields = burning_east(0.0)
    before, after = finished("thermal_map", **fields | {"heat_flux": 0.0 * fields["heat_flux"]})
    assert np.abs(after - before).max() < 0.51 / 255


def test_ends_of_scales_are_those_of_the_shot_and_read_once(make_run, monkeypatch):
    shot = Seen(runs.open(make_run(**burning_east(15.0))))
    low, high = shot.air.warmest
    assert low == pytest.approx(0.0, abs=0.01)
    assert high == pytest.approx(15.0, abs=0.01)
    assert shot.air.coldest < 306.0
    monkeypatch.setattr(air_temperature, "at", None)
    monkeypatch.setattr(air_temperature, "mean", None)
    assert (shot.air.warmest, shot.air.coldest) == ((low, high), shot.air.coldest)


def test_the_thermal_scale_follows_the_moment_alone(make_run, monkeypatch):
    """A dawn and a noon 20 K warmer: each frame's palette begins at its own air, in whatever shot it is."""
    monkeypatch.setattr(air_temperature.sun, "position", lambda run, time: (180.0, 40.0))
    night = np.full((3, 4, 5), 285.0, np.float32)
    run = runs.open(make_run(temperature=night + np.array([0.0, 10.0, 20.0], np.float32)[:, None, None]))
    moving = Shot(Settings(time=Time(frames=3)), run)
    assert [thermal_pass.scale(moving, frame) for frame in (1, 2, 3)] == [
        (285.0, 800.0),
        (295.0, 800.0),
        (305.0, 800.0),
    ]
    still = Shot(Settings(time=Time(frames=1, start=moving.utc(3))), run)
    assert thermal_pass.scale(still, 1) == (305.0, 800.0)
    held = Shot(Settings(time=Time(frames=3), render=Render(thermal_low=280.0)), run)
    assert {thermal_pass.scale(held, frame) for frame in (1, 2, 3)} == {(280.0, 800.0)}


def test_the_sky_has_its_own_part_of_the_palette(tmp_path):
    """Colder than the coldest ground, it is graded in the darkest part; the ground begins above it."""
    kelvin = np.array([[np.nan, 240.0, 270.0, 285.0, 300.0, 320.0, 800.0]])
    place = colour_bar.paint(kelvin, 300.0, 800.0, "white-hot", 5.0, 45.0)[0, :, 0]
    assert place[0] == place[1] == 0.0
    assert np.all(np.diff(place[1:]) > 0.03)
    assert place[[4, 6]] == pytest.approx([colour_bar.FOOT, 1.0], abs=1e-6)
    plain = colour_bar.paint(kelvin, 300.0, 800.0, "white-hot", 5.0, 0.0)
    assert plain == pytest.approx(sensor.colour(kelvin, 300.0, 800.0, "white-hot", 5.0), abs=1e-6)
    ticks = colour_bar.choose_ticks(300.0, 800.0, 5.0, 20.0, 45.0)
    assert min(ticks) < 290.0
    assert max(ticks) >= 700.0


def test_hot_spots_lie_over_the_picture(tmp_path):
    rgb, kelvin = np.full((20, 30, 3), 0.4), np.full((20, 30), 320.0)
    kelvin[5:10], kelvin[12] = 700.0, 400.0
    needed = {"rgb": {"png": tmp_path / "rgb.png"}, "thermal": {"exr": tmp_path / "thermal.exr"}}
    sensor.write_image(needed["rgb"]["png"], rgb)
    both = np.stack([kelvin, kelvin], axis=-1)
    sensor.write_image(needed["thermal"]["exr"], both, None, ["kelvin", "radiance"])
    settings = Settings(render=Render(thermal_low=290.0, thermal_high=800.0))
    path = tmp_path / "overlay.png"
    passes.finish("overlay", {"png": path}, needed, SimpleNamespace(settings=settings), "drone", 1)
    found = sensor.read_image(path)
    assert np.abs(found[:5] - 0.4).max() < 0.51 / 255
    hot = sensor.colour([[700.0, 400.0]], 290.0, 800.0, "ironbow", thermal_pass.KNEE)[0]
    assert found[7, 7] == pytest.approx(0.04 + 0.9 * hot[0], abs=0.01)
    assert found[12, 7] == pytest.approx(0.55 * 0.4 + 0.45 * hot[1], abs=0.01)


def test_eye_dome_lighting_darkens_the_sky_behind_the_ground_alone(finished):
    before, after = finished("edl")
    assert np.abs(after[5:] - before[5:]).max() < 0.51 / 255
    assert np.all(after[4] < 0.01)
    assert np.array_equal(after[:4], before[:4])


def test_depth_has_both_distances_by_name(tmp_path):
    path = tmp_path / "depth.exr"
    sensor.write_image(path, np.full((20, 40), 1000.0))
    passes.finish("depth", {"exr": path}, {}, SimpleNamespace(paths=[view(True)]), "drone", 1)
    planar, far = np.moveaxis(sensor.read_image(path), -1, 0)
    assert np.all(planar == 1000.0)
    assert far[0, 0] == pytest.approx(1000.0 * np.sqrt(1 + (0.5 * 39 / 40) ** 2 + (0.25 * 19 / 20) ** 2))
    assert all(name in path.read_bytes()[:600] for name in (b"planar\0", b"range\0"))
