"""Output presets: a scene with a preset is valid, and its other settings do not change."""

from dataclasses import replace
from pathlib import Path

import pytest
from firetwin import argument_types
from firetwin.errors import UsageError
from firetwin.shot import schema
from firetwin.shot.cameras.rigs._key import CameraKey
from firetwin.shot.cameras.rigs.poses import PoseKey, Poses
from firetwin.shot.cameras.rigs.vr import RIG as VR
from firetwin.shot.settings import Camera, Render, Settings, output_presets
from firetwin.shot.source import ShotSource


def scene(**render):
    cameras = (
        Camera("drone", Poses(keys=(PoseKey(),))),
        Camera("heat", Poses(keys=(PoseKey(),)), passes=("thermal",)),
        Camera("around", VR(keys=(CameraKey(),)), resolution=(512, 512)),
    )
    return Settings(path=Path("shots/king.toml"), cameras=cameras, render=Render(**render))


def test_the_command_line_knows_their_names():
    assert tuple(output_presets.PRESETS) == argument_types.OUTPUT_PRESETS


@pytest.mark.parametrize("name", output_presets.PRESETS)
def test_a_preset_gives_a_valid_scene_and_changes_nothing_twice(name):
    before = scene(samples=9, film_codec="h265")
    after = output_presets.apply(before, name)
    assert schema.validate(after) is None
    assert after.render.samples == 9
    assert output_presets.apply(after, name) == after != before


def test_compositing_adds_its_passes_where_cameras_can_record_them():
    drone, heat, around = output_presets.apply(scene(passes=("rgb", "map")), "compositing").cameras
    assert drone.passes == ()  # as [render]
    assert heat.passes == ("thermal",)
    assert around.passes == ("rgb", "map", "comp")
    made = output_presets.apply(scene(passes=("rgb", "map")), "compositing").render
    assert made.passes == ("rgb", "map", "comp", "data")
    assert (made.exr_space, made.film) == ("acescg", "clean")


def test_editorial_keeps_a_slate_or_names_the_scene():
    named, own = (output_presets.apply(scene(slate=text), "editorial").render for text in ("", "King v3"))
    assert (named.slate, own.slate) == ("king", "King v3")
    assert (own.film, own.film_codec, own.passes) == ("both", "prores", Render().passes)


def test_a_source_applies_a_preset_or_names_what_forbids_it(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('run = "run"\n[[cameras]]\nname = "drone"\nkind = "poses"\n[[cameras.keys]]\n')
    source = ShotSource(str(path), preset="compositing")
    assert source.settings().render.passes[-2:] == ("comp", "data")
    path.write_text(path.read_text().replace("\n", '\nrender.engine = "eevee"\n', 1))
    with pytest.raises(UsageError, match='--preset: camera "drone" cannot record comp with EEVEE'):
        source.settings()
    assert replace(source, preset="").settings().render.film == "review"
