"""Settings in the .blend file: scene files go in and come out without loss."""

from dataclasses import replace
from pathlib import Path

import bpy
import firetwin
import pytest
from any_settings import SCENES, any_table
from firetwin.errors import Error
from firetwin.scene.build import PARTS
from firetwin.shot import schema
from firetwin.shot.settings import Render, Settings
from firetwin.shot.settings import scene_file as file
from firetwin.ui import camera_list, changed_settings, job, keys, scene_file, sections
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture
def panel(scene):
    """The panel of a scene in which nothing looks into runs."""
    firetwin.register()
    job.Job.current = job.Job("Test", iter(()))
    yield scene.firetwin
    job.Job.current = None
    firetwin.unregister()


def key(kind, name):
    return next(part for part in schema.fields(kind) if part.name == name)


@settings(
    max_examples=examples(25), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(any_table(Settings, path=st.just(SCENES / "scene.toml")))
def test_any_settings_come_back_from_the_blend_file(panel, whole):
    scene_file.fill(panel.id_data, whole)
    assert scene_file.read_settings(panel.id_data, whole.path) == whole


def test_every_scene_file_comes_back_from_a_saved_blend_file(panel, tmp_path):
    for path in (EXAMPLES / "king_fire.toml", EXAMPLES / "rigs.toml"):
        whole = file.read(path)
        scene_file.fill(panel.id_data, whole)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
        panel = bpy.context.scene.firetwin
        scene_file.export(bpy.context.scene, tmp_path / "out.toml")
        assert replace(file.read(tmp_path / "out.toml"), path=whole.path) == whole


def test_an_export_over_a_scene_file_changes_the_keys_that_changed(panel, tmp_path):
    """Single precision in Blender changes no number of the file."""
    path = tmp_path / "king_fire.toml"
    text = (EXAMPLES / path.name).read_text(encoding="utf-8") + "# ours\n"
    path.write_text(text, encoding="utf-8")
    scene_file.fill(panel.id_data, file.read(path))
    panel.time.fps = 25
    scene_file.export(panel.id_data, path)
    assert path.read_text(encoding="utf-8") == text.replace("fps = 12 ", "fps = 25 ", 1) != text


def test_what_an_artist_changes_is_what_comes_out(panel):
    whole = replace(file.read(EXAMPLES / "king_fire.toml"), render=Render(thermal_low=285.123456789))
    scene_file.fill(panel.id_data, whole)
    panel.render.thermal_high, panel.terrain.error = 700.1, 0.3
    settings = scene_file.read_settings(panel.id_data)
    assert (settings.render.thermal_low, settings.render.thermal_high, settings.terrain.error) == (
        285.123456789,
        700.1,
        0.3,
    )
    panel.render.thermal_low = 290.5
    panel.time.start, panel.terrain.photo_extent = "2014-09-17T16:10-07:00", "-121, 38.6, -120.2, 39.1"
    panel.cameras[0].name = "mine"
    settings = scene_file.read_settings(panel.id_data)
    assert settings.render.thermal_low == 290.5
    assert f"{settings.time.start:%H:%M %Z}" == "23:10 UTC"
    assert settings.terrain.photo_extent == (-121.0, 38.6, -120.2, 39.1)
    assert settings.cameras[0] == replace(whole.cameras[0], name="mine")
    panel.render.use_thermal_low, panel.time.use_speed, panel.time.start = False, False, ""
    settings = scene_file.read_settings(panel.id_data)
    assert (settings.render.thermal_low, settings.time.start) == (None, None)


@pytest.mark.parametrize(
    ("section", "name", "value", "words"),
    [
        ("time", "start", "yesterday", 'Start: "yesterday" is not a date and time; write it as'),
        ("time", "zone", "America/Los_Angles", 'Time.zone "America/Los_Angles" is not a time zone; did you'),
        ("terrain", "photo_extent", "west", 'Photo extent: "west" is not a list'),
        ("render", "passes", set(), "Render.passes is empty; name at least one"),
    ],
)
def test_what_no_scene_file_may_hold_is_said_in_words(panel, tmp_path, section, name, value, words):
    setattr(getattr(panel, section), name, value)
    with pytest.raises(Error) as refused:
        scene_file.export(panel.id_data, tmp_path / "scene.toml")
    assert str(refused.value).startswith(words)
    assert not (tmp_path / "scene.toml").exists()


def test_only_what_differs_from_the_default_is_marked(panel):
    def marked():
        return {
            part.name
            for section in sections.sections()
            for part in schema.fields(section.table)
            if keys.is_changed(getattr(panel, section.name), part)
        }

    assert marked() == set()
    whole = file.read(EXAMPLES / "king_fire.toml")
    scene_file.fill(panel.id_data, whole)
    assert marked() == {
        part.name
        for section in sections.sections()
        for part in schema.fields(section.table)
        if getattr(getattr(whole, section.name), part.name) != part.default
    }
    assert marked() >= {"start", "speed", "fps", "samples"}
    panel.light.use_exposure = True
    assert "exposure" in marked()


def test_what_changed_since_it_was_built_is_known(panel):
    scene_file.fill(panel.id_data, file.read(EXAMPLES / "king_fire.toml"))
    panel.forest.budget = 1000
    assert panel.changed == ""  # nothing is built
    changed_settings.store_digests(panel, changed_settings.compute_digests(panel), tuple(PARTS))
    panel.forest.budget, panel.light.use_exposure, panel.time.frames = 900, True, 2
    panel.cameras[0].name = "mine"
    assert panel.changed == "time forest light cameras"
    panel.light.use_exposure = False
    changed_settings.store_digests(panel, changed_settings.compute_digests(panel), ("forest",))
    changed_settings.store_digests(panel, changed_settings.compute_digests(panel), ("cameras",))
    assert panel.changed == "time cameras"  # built data elsewhere depends on them too
    changed_settings.store_digests(panel, changed_settings.compute_digests(panel), tuple(PARTS))
    assert panel.changed == ""
    panel.run = "/elsewhere"
    assert panel.changed == "run"
    changed_settings.clear(panel)
    panel.forest.budget = 800
    assert panel.changed == ""


def test_cameras_are_kept_whole(panel):
    whole = file.read(EXAMPLES / "rigs.toml").cameras
    camera_list.fill(panel, whole)
    assert camera_list.cameras(panel) == whole
    camera_list.put(panel.cameras[0], replace(whole[0], frames="3"))
    assert camera_list.get(panel.cameras[0]).frames == "3"
    panel.cameras[0].table = "[[cameras]]\nkind = 3\n"
    with pytest.raises(Error, match=r'camera "scout" cannot be read: cameras\.kind'):
        camera_list.cameras(panel)
