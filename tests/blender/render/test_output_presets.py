"""Output presets and settings of films in the panel Render."""

import bpy
import firetwin
import pytest
from firetwin.shot import schema
from firetwin.shot.cameras.rigs.poses import PoseKey, Poses
from firetwin.shot.sections import Time
from firetwin.shot.settings import Camera, Render, output_presets
from firetwin.ui import camera_list, job, keys, scene_file, translations

FILMS = ("exr_space", "film", "film_codec", "slate", "video", "passes")
GERMAN = translations.SETTINGS | translations.CHOICES


@pytest.fixture
def panel(scene):
    """The panel of a scene in which nothing looks into runs, with two cameras."""
    firetwin.register()
    job.Job.current = job.Job("Test", iter(()))
    panel = scene.firetwin
    camera_list.add(panel, Camera("drone", Poses(keys=(PoseKey(),))))
    camera_list.add(panel, Camera("heat", Poses(keys=(PoseKey(),)), passes=("rgb", "thermal")))
    job.Job.current = None
    yield panel
    firetwin.unregister()


@pytest.mark.parametrize("name", output_presets.PRESETS)
def test_a_button_sets_what_the_command_line_sets(panel, name):
    panel.render.samples = 9
    before = scene_file.read_settings(panel.id_data)
    assert bpy.ops.firetwin.output_preset(preset=name) == {"FINISHED"}
    assert scene_file.read_settings(panel.id_data) == output_presets.apply(before, name) != before


def test_a_preset_that_the_engine_cannot_render_changes_nothing(panel):
    panel.render.engine = "eevee"
    before = scene_file.read_settings(panel.id_data)
    with pytest.raises(RuntimeError, match="cannot record comp with EEVEE"):
        bpy.ops.firetwin.output_preset(preset="compositing")
    assert scene_file.read_settings(panel.id_data) == before


def test_settings_of_films_have_labels_tooltips_and_german_names(panel):
    for part in (*schema.fields(Render), *schema.fields(Time)):
        if part.name not in (*FILMS, "fps"):
            continue
        group = panel.time if part.name == "fps" else panel.render
        shown = group.bl_rna.properties[part.name]
        assert shown.description, part.name
        assert shown.name in {*GERMAN, "Passes"}, part.name
        for choice in shown.enum_items if part.key.choices else ():
            assert choice.description, choice.identifier
    assert {"Comp", "Data"} <= {item.name for item in panel.render.bl_rna.properties["passes"].enum_items}
    named = {keys.label(name) for name in ("both", "clean", "review", "data", "editorial")}
    assert set(translations.CHOICES) == named


@pytest.mark.parametrize("rate", [23.976, 29.97])
def test_broadcast_rates_come_out_exactly(panel, rate):
    panel.time.fps = rate
    exact = scene_file.read_settings(panel.id_data).time.rate
    assert (exact.denominator, exact.numerator) == (1001, round(rate) * 1000)
