"""Passes: their declarations, and pictures made from their files."""

import dataclasses
import itertools

import fileseq
import pytest
from firetwin.render.picture import Picture
from firetwin.shot import passes
from firetwin.shot.sections import SmokeSettings
from firetwin.shot.settings import Camera, Render, Settings

KNOWN = passes.known()


def test_passes_come_in_their_order():
    assert [name for name in KNOWN if name in ("thermal", "depth", "rgb")] == ["rgb", "depth", "thermal"]
    orders = [module.ORDER for module in passes.modules().values()]
    assert orders == sorted(set(orders))
    assert passes.helps()["rgb"] == "Visible picture"
    assert list(passes.helps()) == list(KNOWN)


@pytest.mark.parametrize("name", KNOWN)
def test_a_pass_says_what_it_is(name):
    each = KNOWN[name]
    assert each.name == name
    assert passes.modules()[name].__doc__
    assert passes.helps()[name].strip()
    assert not passes.helps()[name].endswith(".")
    rendered = isinstance(each, passes.RenderedPass)
    assert ("exr" in each.files) >= rendered  # Blender writes it
    assert passes.is_rendered(each) or each.finished
    assert set(each.made_from) <= set(KNOWN) - {name}
    assert each.film <= ("png" in each.files)


def test_data_is_not_denoised_and_only_surfaces_leave_out_smoke():
    rendered = {name: each for name, each in KNOWN.items() if isinstance(each, passes.RenderedPass)}
    assert [name for name, each in rendered.items() if each.shading == "light"] == ["rgb"]
    assert [name for name, each in rendered.items() if "smoke" in each.excludes] == ["depth", "normal"]
    assert "smoke" not in KNOWN["depth"].aspects


def test_what_files_depend_on_holds_what_they_are_made_from():
    thermal, rgb = KNOWN["thermal"], KNOWN["rgb"]
    assert thermal.all_aspects == thermal.aspects
    made = dataclasses.replace(KNOWN["thermal_map"], needs=("rgb",))
    assert made.all_aspects == made.aspects | rgb.aspects


def test_passes_of_a_camera_come_in_order():
    camera = Camera()
    settings = Settings(render=Render(passes=("thermal", "rgb")), cameras=(camera,))
    assert [each.name for each in passes.of_camera(settings, camera)] == ["rgb", "thermal"]
    own = dataclasses.replace(camera, passes=("depth",))
    assert [each.name for each in passes.of_camera(settings, own)] == ["depth"]


@pytest.mark.parametrize("view", ["drone", "drone@slower", "ir-2"])
def test_readers_of_sequences_find_the_frames(tmp_path, view):
    for name, frame in itertools.product(("rgb", "data"), (1, 2, 3, 5)):
        for path in (tmp_path / each for each in Picture(view, frame, name).files()):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    stem = passes.file_stem(view)
    for name in ("rgb", "data"):
        found = fileseq.findSequencesOnDisk(str(tmp_path / stem / name))
        assert {each.extension() for each in found} == {f".{end}" for end in KNOWN[name].files}
        for sequence in found:
            assert list(sequence.frameSet()) == [1, 2, 3, 5]
            assert (sequence.basename(), sequence.zfill()) == (f"{stem}_{name}_", 6)
            again = fileseq.FileSequence(str(sequence))
            assert list(again) == list(sequence), "what it prints can be read"


@pytest.mark.parametrize(
    ("smoke", "words"),
    [
        ({}, ""),
        ({"enabled": False, "draw": "volume"}, ""),
        ({"draw": "volume"}, 'comp with smoke.draw = "volume"'),
        ({"method": "preview"}, ""),
    ],
)
def test_layers_need_smoke_that_is_marched(smoke, words):
    settings, camera = Settings(smoke=SmokeSettings(**smoke)), Camera()
    found = passes.refused(KNOWN["comp"], camera, settings)
    assert bool(found) == bool(words)
    assert words in found
    assert not passes.refused(KNOWN["rgb"], camera, settings)
