"""Passes: what each of them says, and what is made of their files."""

import dataclasses
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.shot import passes
from firetwin.shot.passes import _bar
from firetwin.shot.settings import Camera, Render, Settings, Thermal
from firetwin_core import sensor

KNOWN = passes.known()


def test_passes_come_in_their_order():
    assert [name for name in KNOWN if name in ("thermal", "depth", "rgb")] == ["rgb", "depth", "thermal"]
    orders = [each.order for each in KNOWN.values()]
    assert orders == sorted(set(orders))
    assert passes.helps()["rgb"] == "The visible picture"


@pytest.mark.parametrize("name", KNOWN)
def test_a_pass_says_what_it_is(name):
    each = KNOWN[name]
    module = sys.modules[f"{passes.__name__}.{name}"]
    assert each.name == name
    assert module.PASS is each
    assert module.__doc__
    assert each.help.strip()
    assert not each.help.endswith(".")
    assert "exr" in each.files  # Blender writes it
    assert set(each.needs) <= set(KNOWN) - {name}
    assert (each.finish is not None) >= bool(each.needs)
    assert each.filmed <= ("png" in each.files)


def test_data_is_not_denoised_and_only_surfaces_leave_out_smoke():
    assert [name for name, each in KNOWN.items() if not each.data] == ["rgb"]
    assert [name for name, each in KNOWN.items() if "smoke" in each.leaves_out] == ["depth", "normal"]
    assert "smoke" not in KNOWN["depth"].aspects


def test_what_files_depend_on_holds_what_they_are_made_from():
    thermal, rgb = KNOWN["thermal"], KNOWN["rgb"]
    assert thermal.aspects == thermal.shows
    made = dataclasses.replace(thermal, needs=("rgb",))
    assert made.aspects == thermal.shows | rgb.shows


def test_passes_of_a_camera_come_in_order():
    camera = Camera()
    settings = Settings(render=Render(passes=("thermal", "rgb")), cameras=(camera,))
    assert [each.name for each in passes.of_camera(settings, camera)] == ["rgb", "thermal"]
    own = dataclasses.replace(camera, passes=("depth",))
    assert [each.name for each in passes.of_camera(settings, own)] == ["depth"]


def test_a_pass_is_added_by_one_file(tmp_path, monkeypatch):
    (tmp_path / "mask.py").write_text(
        '"""Where fire is."""\nfrom firetwin.shot.passes import Pass\n'
        'PASS = Pass("mask", 29, "Where fire is", ("exr",), "Image", frozenset({"fire"}), needs=("depth",))\n'
    )
    (tmp_path / "_helper.py").write_text("raise ImportError")
    monkeypatch.setattr(passes, "__path__", [*passes.__path__, str(tmp_path)])
    passes.known.cache_clear()
    try:
        before = [name for name in KNOWN if name != "thermal"]
        assert list(passes.known()) == [*before, "mask", "thermal"]
        assert passes.known()["mask"].aspects == {"fire"} | KNOWN["depth"].shows
    finally:
        passes.known.cache_clear()
        sys.modules.pop(f"{passes.__name__}.mask")


def thermal(path, radiance, **keys):
    """The thermal pass's EXR (h, w, channels) and PNG of rendered radiance."""
    files = {end: path / f"thermal.{end}" for end in ("exr", "png")}
    sensor.write_image(files["exr"], np.repeat(radiance[..., None], 3, axis=-1))
    settings = Settings(render=Render(thermal_low=290.0, thermal_high=1000.0), thermal=Thermal(**keys))
    KNOWN["thermal"].finish(files, {}, SimpleNamespace(settings=settings), "drone", 1)
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
    expected = sensor.colour(kelvin, 290.0, 1000.0, "white-hot", 0.4)
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
    assert _bar.marks(290.0, 1000.0, 0.4, 20.0)[-1] == 1000.0
    assert all(kelvin % 10 == 0 for kelvin in _bar.marks(290.0, 1000.0, 0.4, 20.0))
    assert len(_bar.marks(299.0, 301.0, 1.0, 20.0)) >= 3
    _, picture = thermal(tmp_path, scene(180, 320), palette="inferno")
    bare = sensor.colour(np.full((180, 320), 300.0), 290.0, 1000.0, "inferno", 0.4)
    bar = picture[20:160, 312:316].mean(axis=(1, 2))
    assert bar[0] > bar[-1] + 0.5
    assert np.all(np.diff(bar) < 0.02)
    assert np.abs(picture[30:, :280] - bare[30:, :280]).max() < 0.51 / 255
