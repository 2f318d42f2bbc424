"""Drawn labels: colours inside masks, boxes at their pixels, captions that say distance and top."""

from dataclasses import replace

import numpy as np
import plain_samples
import pytest
from firetwin import cli
from firetwin.dataset import draw_labels, files, labels, sensor, truth
from firetwin.dataset.files import Masks
from firetwin.dataset.truth import Annotation
from firetwin.geometry.rectangles import common_area
from PIL import Image, ImageDraw

FIRE, SMOKE = (draw_labels._COLOURS[each] for each in (truth.FIRE, truth.SMOKE))
BLACK = np.zeros((120, 160, 3), np.uint8)


def annotation(number, category, box, **more):
    return Annotation(number, category, box, 400, box, 400, 1.0, False, "visible", **more)


def drawn(*annotations, **more):
    layers = {name: np.zeros((120, 160), np.uint8) for name in ("smoke", "fire", "amodal")}
    for each in annotations:
        x0, y0, x1, y1 = map(int, each.box)
        layers["smoke" if each.category == truth.SMOKE else "fire"][y0:y1, x0:x1] = each.id
    base = labels.label(plain_samples.plane(plain_samples.looking(20.0)), plain_samples.flat_place(), 1)[0]
    return draw_labels.draw(BLACK, replace(base, annotations=annotations, **more), Masks(**layers))


def test_a_mask_is_tinted_and_its_box_is_drawn_on_its_outermost_pixels():
    picture = drawn(annotation(1, truth.FIRE, (40.0, 30.0, 60.0, 50.0)))
    assert tuple(picture[40, 50]) == tuple(round(0.25 * value) for value in FIRE)
    for at in ((30, 40), (49, 59), (30, 59), (49, 40)):
        assert tuple(picture[at]) == FIRE
    assert not picture[29, 39:61].any()
    assert not picture[:29].any()
    assert picture[50:, 40:].any()  # the caption of fire is below its box


def test_neighbours_have_a_line_between_them():
    left = annotation(1, truth.SMOKE, (20.0, 40.0, 60.0, 80.0))
    right = annotation(2, truth.SMOKE, (60.0, 40.0, 100.0, 80.0))
    found = drawn(left, right)
    assert tuple(found[60, 59]) == tuple(found[60, 60]) == SMOKE
    assert tuple(found[60, 40]) != SMOKE


def test_hidden_flames_have_a_dashed_box():
    box, amodal = (40.0, 30.0, 60.0, 50.0), (20.0, 30.0, 60.0, 50.0)
    found = drawn(replace(annotation(1, truth.FIRE, box), amodal_box=amodal, visible_fraction=0.5))
    upper = (found[30, 20:39] == FIRE).all(axis=-1)
    assert 0.3 < upper.mean() < 0.8


def test_lines_are_drawn():
    found = drawn(front=[[(10.0, 100.0), (100.0, 100.0)]], horizon=[[(0.0, 20.0), (159.0, 20.0)]])
    assert tuple(found[100, 50]) == draw_labels._FRONT
    assert tuple(found[20, 80]) == draw_labels._HORIZON


@pytest.mark.parametrize(
    "box", [(0.0, 0.0, 160.0, 120.0), (150.0, 2.0, 158.0, 8.0), (0.0, 110.0, 9.0, 120.0)]
)
@pytest.mark.parametrize("category", [truth.FIRE, truth.SMOKE])
def test_captions_at_the_edges_stay_in_the_picture(box, category):
    assert drawn(annotation(1, category, box)).shape == BLACK.shape


def test_captions_of_close_boxes_do_not_cover_each_other():
    near = [annotation(k, truth.SMOKE, (60.0 + 8 * k, 60.0, 66.0 + 8 * k, 70.0)) for k in range(1, 5)]
    pen, taken = ImageDraw.Draw(Image.fromarray(BLACK)), [each.box for each in near]
    captions = []
    for each in near:
        captions.append(draw_labels._draw_caption(pen, each, taken + captions, 120, 160))
    for k, each in enumerate(captions):
        for other in captions[:k] + [box for box in taken if box != near[k].box]:
            assert common_area(each, other) == 0.0


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({}, "smoke 3"),
        ({"distance_m": 4210.0, "top_above_ground_m": 612.0}, "smoke 3, 4.2 km, top 612 m"),
        ({"distance_m": 87.4}, "smoke 3, 87 m"),
        ({"visible_fraction": 0.34}, "smoke 3, 34% visible"),
    ],
)
def test_captions_name_what_is_known(more, words):
    assert draw_labels.caption(replace(annotation(3, truth.SMOKE, (0, 0, 1, 1)), **more)) == words


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Write a data set of the samples 4, 5 and 30."""
    folder = tmp_path_factory.mktemp("set")
    sample = plain_samples.plane(plain_samples.looking(-3.0, size=(160, 120)))
    sensed = sensor.apply(sample, sensor.SensorSettings(), {"noise": 1, "thermal noise": 2})
    for index in (4, 5, 30):
        label, masks = labels.label(sample, plain_samples.flat_place(), index)
        files.write(folder, label, masks, sample, sensed)
    return folder


def test_a_sample_of_a_data_set_is_drawn_from_its_files(folder):
    for kind in ("images", "clean", "palette"):
        found = draw_labels.draw_sample(folder, 4, kind)
        assert (found == draw_labels._HORIZON).all(axis=-1).sum() > 100


def test_the_command_draws_the_samples_of_a_list(folder, tmp_path, capsys):
    assert cli.main(["dataset", "draw", str(folder), "--out", str(tmp_path / "seen"), "--only", "4,30"]) == 0
    assert sorted(path.name for path in (tmp_path / "seen").glob("[!.]*")) == ["000004.png", "000030.png"]
    assert capsys.readouterr().out.split()[0].endswith("000004.png")


@pytest.mark.parametrize("only", ["31", "x", "6"])
def test_samples_that_do_not_exist_have_a_remedy(folder, tmp_path, only, capsys):
    assert cli.main(["dataset", "draw", str(folder), "--out", str(tmp_path), "--only", only]) == 2
    assert "--only: sample" in capsys.readouterr().err


def test_an_empty_folder_has_no_samples_to_draw(tmp_path, capsys):
    assert cli.main(["dataset", "draw", str(tmp_path), "--out", str(tmp_path / "seen")]) == 1
    assert "has no samples; make some" in capsys.readouterr().err


def test_at_most_24_samples_are_drawn_without_a_list():
    assert draw_labels._chosen(list(range(1, 25)), "") == list(range(1, 25))
    many = draw_labels._chosen(list(range(1, 201)), "")
    assert (len(many), many[0], many[-1]) == (24, 1, 200)
    assert draw_labels._chosen([7], " ") == [7]


def test_small_pictures_have_the_same_boxes():
    base = labels.label(plain_samples.plane(plain_samples.looking(20.0)), plain_samples.flat_place(), 1)[0]
    wide = base.camera.width
    box = (0.25 * wide, 0.0, 0.5 * wide, 0.1 * wide)
    tiny = (0.75 * wide, 0.0, 0.75 * wide + 1.0, 1.0)
    hidden = annotation(2, truth.FIRE, tiny)
    found = replace(base, annotations=(annotation(1, truth.SMOKE, box), hidden))
    black = Image.new("RGB", (wide, base.camera.height))
    small = np.array(draw_labels.draw_small(black, found, wide // 2))
    assert small.shape[1] == wide // 2
    assert tuple(small[0, wide // 8]) == tuple(small[wide // 20 - 1, wide // 4 - 1]) == SMOKE
    assert tuple(small[0, 3 * wide // 8]) == FIRE  # a box of one pixel still shows
