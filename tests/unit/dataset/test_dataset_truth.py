"""Metadata of samples: written and read without a difference, and damaged files explained."""

from dataclasses import replace

import pytest
from firetwin.dataset import truth
from firetwin.dataset.truth import Annotation, CameraPose, Truth
from firetwin.errors import InputError
from hypothesis import given, settings
from hypothesis import strategies as st

CAMERA = CameraPose(
    64, 48, 60.0, 60.0, 32.0, 24.0, [[1.0, 0.0, 0.0, 5.0]] * 4, 38.8, -120.6, 900.0, 38.7, -120.5, 0.0
)
numbers = st.floats(-1e9, 1e9)
boxes = st.tuples(numbers, numbers, numbers, numbers)
annotations = st.builds(
    Annotation,
    boxes_by_alpha=st.dictionaries(st.sampled_from(["0.05", "0.2", "0.5"]), boxes),
    **{name: numbers for name in ("visible_fraction",)},
    **{name: boxes for name in ("box", "amodal_box")},
    **{name: st.none() | numbers for name in ("contrast", "distance_m", "max_temperature_k")},
)
truths = st.builds(
    Truth,
    index=st.integers(0, 999_999),
    camera=st.just(CAMERA),
    model_time_s=numbers,
    annotations=st.lists(annotations, max_size=2).map(tuple),
    below_size=st.lists(annotations, max_size=1).map(tuple),
    front=st.lists(st.lists(st.tuples(numbers, numbers), max_size=3), max_size=2),
    horizon=st.just([[(0.0, 1.0), (64.0, 2.0)]]),
    **{name: st.none() for name in ("seconds_since_ignition", "front_geojson")},
    **{
        name: st.dictionaries(st.text(max_size=3), st.text(max_size=3), max_size=2)
        for name in ("groups", "draw", "source", "labelling", "sensor", "thermal")
    },
    files=st.just({"images": "images/000001.jpg"}),
)


@settings(max_examples=30)
@given(truths)
def test_a_truth_comes_back_as_it_was(tmp_path_factory, written):
    folder = tmp_path_factory.mktemp("set")
    path = truth.write(folder, written)
    first = path.read_bytes()
    assert truth.read(folder, written.index) == written
    assert truth.write(folder, truth.read(folder, written.index)).read_bytes() == first
    assert list(truth.indices(folder)) == [written.index]


def plain(**more):
    return Truth(7, CAMERA, "2014-09-17T18:06:00+00:00", 60.0, **more)


@pytest.mark.parametrize("hostile", [{"split": "../x"}, {"split": "/x"}, {"files": {"images": "a/../../x"}}])
def test_names_that_lead_out_of_the_folder_are_refused(tmp_path, hostile):
    truth.write(tmp_path, replace(plain(), **hostile))
    with pytest.raises(InputError, match="is damaged"):
        truth.read(tmp_path, 7)


def test_numbers_that_json_has_not_are_rejected(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        truth.write(tmp_path, replace(plain(), model_time_s=float("nan")))
    assert list(truth.indices(tmp_path)) == []


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"format": "firetwin sample 1", "index": 3}'])
def test_a_damaged_file_has_a_remedy(tmp_path, text):
    path = truth.write(tmp_path, plain())
    path.write_text(text)
    with pytest.raises(InputError, match="delete it and resume"):
        truth.read(tmp_path, 7)


def test_a_file_of_another_version_is_named(tmp_path):
    path = truth.write(tmp_path, plain())
    path.write_text(path.read_text().replace("sample 1", "sample 9"))
    with pytest.raises(InputError, match="with this version"):
        truth.read(tmp_path, 7)


def test_categories_begin_at_one_and_cover_the_class_map():
    assert [each.id for each in truth.CATEGORIES] == list(range(1, 8))
    assert sorted(each.value for each in truth.CATEGORIES) == list(range(7))
    assert [each.name for each in truth.CATEGORIES if each.has_instances] == ["fire", "smoke"]


def test_negatives_have_no_instances_of_any_size():
    small = Annotation(1, truth.FIRE, (0, 0, 1, 1), 1, (0, 0, 1, 1), 1, 1.0, False, "x")
    assert plain().is_negative
    assert not plain(below_size=(small,)).is_negative
