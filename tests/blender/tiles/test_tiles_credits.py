"""Credits of tiles drawn into pictures by Blender's typeface, and kept with a scene."""

import numpy as np
import pytest
from firetwin.blender import text
from firetwin.imaging import credits as layout
from firetwin.imaging.credits import Credits
from firetwin.render import credits, engine
from firetwin.scene import credits as scene_credits
from firetwin_core import sensor
from PIL import Image

WORDS = Credits(("Données Éü © 2025 Somebody", "地図"), ("A Service",))


@pytest.fixture
def picture(tmp_path):
    path = tmp_path / "picture.png"
    sensor.write_image(path, np.full((360, 640, 3), 0.5, np.float32), {"Note": "before"})
    return path


def test_a_strip_is_drawn_and_the_rest_keeps_its_pixels(picture):
    before = sensor.read_image(picture)
    credits.burn(picture, WORDS, "Firetwin: run")
    after = sensor.read_image(picture)
    (block,) = layout.blocks(WORDS, 640, 360)
    np.testing.assert_array_equal(after[: block.top], before[: block.top])
    strip = after[block.top :, :, 0]
    assert strip.min() == pytest.approx(0.05, abs=0.01)
    assert strip.max() > 0.95
    written = np.flatnonzero((strip > 0.5).any(axis=0))
    gaps = np.diff(written)
    assert written.min() < 0.05 * 640 < gaps.max()  # the service at the left, the data at the right
    assert 0.97 * 640 < written.max() < 640
    with Image.open(picture) as file:
        assert file.text == {"Note": "Firetwin: run"}


def test_other_words_have_other_pixels_and_the_same_words_the_same(picture):
    seen = []
    for words in (
        WORDS,
        WORDS,
        Credits(WORDS.data),
        Credits(("Données Éü © 2025 Somebodx", "地図"), WORDS.logo),
    ):
        sensor.write_image(picture, np.full((360, 640, 3), 0.5, np.float32))
        credits.burn(picture, words, "")
        seen.append(picture.read_bytes())
    assert seen[0] == seen[1]
    assert len({*seen}) == 3


def test_burning_again_covers_what_is_there(picture):
    """Draw credits as in passes made from the visible picture."""
    credits.burn(picture, WORDS, "")
    once = picture.read_bytes()
    credits.burn(picture, WORDS, "")
    assert picture.read_bytes() == once


def test_both_eyes_of_a_panorama_have_them(tmp_path):
    path = tmp_path / "around.png"
    sensor.write_image(path, np.full((512, 512, 3), 0.5, np.float32))
    credits.burn(path, Credits(("Somebody",)), "", around=True)
    upper, lower = np.split(sensor.read_image(path)[..., :3], 2)
    np.testing.assert_array_equal(upper, lower)
    assert (upper[128:] > 0.9).any()
    assert (upper[:128] == upper[0, 0]).all()


def test_every_letter_is_at_most_as_wide_as_is_reckoned_with():
    for line in ("Maxar Technologies; CNES / Airbus", "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "0123456789", "日本地図"):
        assert text.measure_width(line, 20) <= layout.estimate_width(line, 20) * 1.02


def test_a_scene_keeps_its_credits_and_blenders_own_renders_show_them(stage, run):
    part = stage.part("Tiles")
    scene_credits.store(part, WORDS)
    assert not credits.read_scene(stage)  # no tile is there
    import bpy

    part.objects.link(bpy.data.objects.new("Tile", bpy.data.meshes.new("Tile")))
    assert credits.read_scene(stage) == WORDS
    engine.set_metadata(run, stage.scene)
    credits.stamp(stage)
    assert stage.scene.render.use_stamp
    assert stage.scene.render.stamp_note_text.endswith(WORDS.text())
    engine.set_metadata(run, stage.scene)
    assert not stage.scene.render.use_stamp
