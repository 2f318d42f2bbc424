"""Passes: what each of them says, and what is made of their files."""

import dataclasses
import sys

import numpy as np
import pytest
from firetwin.shot import passes
from firetwin.shot.settings import Camera, Render, Settings
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


def test_data_is_neither_denoised_nor_seen_through_smoke():
    assert [name for name, each in KNOWN.items() if not each.data] == ["rgb"]
    assert all(("smoke" in each.leaves_out) == each.data for each in KNOWN.values())
    assert "smoke" not in KNOWN["depth"].aspects


def test_what_files_depend_on_holds_what_they_are_made_from():
    thermal, rgb = KNOWN["thermal"], KNOWN["rgb"]
    assert thermal.aspects == thermal.shows | rgb.shows
    assert rgb.aspects == rgb.shows


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


def test_the_thermal_picture_is_made_of_its_temperatures_and_the_visible_one(tmp_path):
    kelvin = np.linspace(300, 900, 24, dtype=np.float32).reshape(4, 6)
    rgb = np.full((4, 6, 3), 0.25, np.float32)
    files = {end: tmp_path / f"thermal.{end}" for end in ("exr", "png")}
    needed = {"rgb": {end: tmp_path / f"rgb.{end}" for end in ("png", "exr")}}
    sensor.write_image(files["exr"], np.repeat(kelvin[..., None], 3, axis=-1))
    sensor.write_image(needed["rgb"]["png"], rgb)
    settings = Settings(render=Render(thermal_low=320.0, thermal_high=800.0))
    KNOWN["thermal"].finish(files, needed, settings)
    made = sensor.read_image(files["png"])[..., :3]
    visible = sensor.read_image(needed["rgb"]["png"])[..., :3]
    expected = sensor.thermal_composite(visible, kelvin, 320.0, 800.0)
    np.testing.assert_allclose(made, expected, atol=1 / 255)
    assert np.abs(made[0, 0] - visible[0, 0]).max() < 0.01  # colder than where colour begins
    assert made[-1, -1].min() > 0.9  # white
