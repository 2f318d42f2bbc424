"""Formats of data sets: boxes, masks and poses of each file agree with the truth."""

import json
import tarfile
from dataclasses import replace
from unittest.mock import Mock

import labelled
import numpy as np
import pytest
from firetwin.dataset import files, formats, rle
from firetwin.dataset.formats import coco, colmap, common, hf, nerfstudio, parquet, tum, voc, webdataset, yolo
from firetwin.dataset.truth import CATEGORIES, Truth, stem
from firetwin.errors import InputError, UsageError
from firetwin.geometry.quaternion import matrices
from PIL import Image

POSE = labelled.camera(1)
NAMES = [name for name in formats.FORMATS if name != "parquet"]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("set")
    samples = labelled.data_set(folder)
    formats.write(folder, samples, NAMES)
    return folder, samples


def test_each_format_is_a_module_that_writes():
    modules = (coco, colmap, hf, nerfstudio, parquet, tum, voc, webdataset, yolo)
    assert {module.__name__.rpartition(".")[2] for module in modules} == set(formats.FORMATS)
    assert all(callable(module.write) for module in modules)


def instances(folder, split):
    return json.loads((folder / f"annotations/instances_{split}.json").read_text())


def boxes_of_truth(truth):
    return [each.box for each in truth.annotations]


def test_coco_has_boxes_areas_and_masks_of_the_truth(made):
    folder, samples = made
    known = {truth.index: truth for truth in samples}
    found = [each for split in ("train", "test") for each in instances(folder, split)["annotations"]]
    assert [each["id"] for each in found] == list(range(1, 13))
    for each in found:
        truth = known[each["image_id"]]
        expected = next(one for one in truth.annotations if one.category == each["category_id"])
        x, y, w, h = each["bbox"]
        assert (x, y, x + w, y + h) == expected.box
        mask = rle.decode(each["segmentation"])
        np.testing.assert_array_equal(mask, labelled.shapes(truth.index)[expected.category])
        assert each["area"] == mask.sum() == expected.pixels
        assert each["attributes"]["distance_m"] == 1234.5


def test_panoptic_segments_cover_each_pixel_once(made):
    folder, samples = made
    content = json.loads((folder / "annotations/panoptic_train.json").read_text())
    kinds = {each["id"]: each for each in content["categories"]}
    assert len(kinds) == len(CATEGORIES)
    for each in content["annotations"]:
        coded = np.asarray(Image.open(folder / "annotations/panoptic_train" / each["file_name"])).astype(int)
        ids = coded @ [1, 256, 65536]
        assert sorted(np.unique(ids[ids > 0])) == sorted(one["id"] for one in each["segments_info"])
        for one in each["segments_info"]:
            assert one["area"] == np.sum(ids == one["id"])
        things = [one for one in each["segments_info"] if kinds[one["category_id"]]["isthing"]]
        assert len(things) == len(next(t for t in samples if t.index == each["image_id"]).annotations)


def test_yolo_and_voc_boxes_come_back(made):
    folder, samples = made
    for truth in samples:
        lines = (folder / f"labels/{stem(truth.index)}.txt").read_text().splitlines()
        read = [yolo.box(line, truth.camera) for line in lines]
        np.testing.assert_allclose([box for _, box in read], boxes_of_truth(truth), atol=1e-4)
        assert [kind + 1 for kind, _ in read] == [each.category for each in truth.annotations]
        found = voc.boxes(folder / f"voc/Annotations/{stem(truth.index)}.xml")
        assert [box for _, box in found] == boxes_of_truth(truth)


def test_the_first_pixel_of_voc_is_1_1(made):
    folder, samples = made
    text = (folder / f"voc/Annotations/{stem(1)}.xml").read_text()
    x0, _, x1, _ = samples[0].annotations[0].box
    assert f"<xmin>{x0 + 1:g}</xmin>" in text
    assert f"<xmax>{x1:g}</xmax>" in text


def test_yolo_lists_each_picture_once_with_its_labels(made):
    folder, samples = made
    lists = [(folder / f"{split}.txt").read_text() for split in ("train", "test")]
    pictures = "".join(lists).split()
    assert sorted(pictures) == [f"./{truth.files['images']}" for truth in samples]
    for picture in pictures:
        assert (folder / picture).is_file()
        assert (folder / picture.replace("/images/", "/labels/")).with_suffix(".txt").is_file()
    assert "val: test.txt" in (folder / "data.yaml").read_text()


def test_rows_of_hugging_face_name_pictures_and_boxes(made):
    folder, samples = made
    for split in ("train", "test"):
        lines = (folder / f"imagefolder/{split}/metadata.jsonl").read_text().splitlines()
        rows = [json.loads(line) for line in lines]
        members = [truth for truth in samples if truth.split == split]
        assert rows[0]["objects"]["bbox"]  # the library infers types from it
        rows.sort(key=lambda row: row["index"])
        for row, truth in zip(rows, members, strict=True):
            assert (folder / "imagefolder" / split / row["file_name"]).is_file()
            corners = [(x, y, x + w, y + h) for x, y, w, h in row["objects"]["bbox"]]
            assert corners == boxes_of_truth(truth)
            assert row["objects"]["category"] == [each.category - 1 for each in truth.annotations]


def test_keys_of_webdataset_end_at_the_first_dot(made):
    folder, samples = made
    with tarfile.open(folder / "webdataset/test-000000.tar") as tar:
        names = tar.getnames()
        keys = {name.partition(".")[0] for name in names}
        assert keys == {stem(truth.index) for truth in samples if truth.split == "test"}
        meta = json.load(tar.extractfile(f"{max(keys)}.json"))
    assert meta["index"] == int(max(keys))
    assert f"{max(keys)}.jpg" in names
    assert f"{max(keys)}.masks.png" in names


def through_nerfstudio(folder, run, truth, point):
    index = json.loads((folder / f"nerfstudio/{run}/transforms.json").read_text())
    frame = next(one for one in index["frames"] if one["file_path"].endswith(truth.files["images"]))
    assert (folder / "nerfstudio" / run / frame["file_path"]).resolve() == folder / truth.files["images"]
    x, y, z, _ = np.linalg.inv(np.array(frame["transform_matrix"])) @ [*point, 1.0]
    return frame["cx"] + frame["fl_x"] * x / -z, frame["cy"] - frame["fl_y"] * y / -z


def through_colmap(folder, run, truth, point):
    lines = (folder / f"colmap/{run}/images.txt").read_text().splitlines()
    line = next(line.split() for line in lines if line.endswith(f"{stem(truth.index)}.jpg"))
    rotation = matrices(np.array([line[1:5]], float))[0]
    x, y, z = rotation @ point + np.array(line[5:8], float)
    lenses = (folder / f"colmap/{run}/cameras.txt").read_text().splitlines()
    fx, fy, cx, cy = next(map(float, each.split()[4:]) for each in lenses if each.startswith(f"{line[8]} "))
    return cx + fx * x / z, cy + fy * y / z


def through_tum(folder, run, truth, point):
    def values(name):
        lines = (folder / f"tum/{run}/{name}.txt").read_text().splitlines()
        return next(line.split()[1:] for line in lines if line.startswith(f"{truth.index}.0 "))

    tx, ty, tz, qx, qy, qz, qw = map(float, values("groundtruth"))
    rotation = matrices(np.array([[qw, qx, qy, qz]]))[0]
    x, y, z = rotation.T @ (point - [tx, ty, tz])
    assert values("rgb") == [f"../../{truth.files['images']}"]
    fx, fy, cx, cy = map(float, values("camera")[2:])
    return cx + fx * x / z + 0.5, cy + fy * y / z + 0.5  # the first pixel of OpenCV has its centre at 0, 0


@pytest.mark.parametrize("through", [through_nerfstudio, through_colmap, through_tum])
def test_poses_project_a_landmark_to_one_pixel(made, through):
    folder, samples = made
    for truth in samples:
        point = labelled.landmark(truth.camera)
        expected = labelled.project(truth.camera, point)
        assert abs(expected - [45.2, 15.6]).max() < 1.0  # right of and above the centre
        found = through(folder, truth.groups["run"].replace(" ", "_"), truth, point)
        np.testing.assert_allclose(found, expected, atol=1e-6)


def test_a_format_written_twice_has_equal_bytes(made, tmp_path):
    folder, samples = made
    labelled.data_set(tmp_path)
    formats.write(tmp_path, samples, NAMES)
    for path in folder.rglob("*"):
        if path.is_file():
            assert path.read_bytes() == (tmp_path / path.relative_to(folder)).read_bytes(), path


def test_names_of_formats_are_explained(monkeypatch):
    assert formats.names("yolo, coco,yolo") == ("yolo", "coco")
    assert set(formats.names("all")) >= set(NAMES)
    with pytest.raises(UsageError, match='no format "kitti"; choose from coco, yolo'):
        formats.names("kitti")
    for error, words in (
        (ModuleNotFoundError("No module named 'pyarrow'"), "pip install pyarrow"),
        (ImportError("needs NumPy 2"), "does not load: needs NumPy 2; install another version"),
    ):
        monkeypatch.setattr(formats.importlib, "import_module", Mock(side_effect=error))
        assert "parquet" not in formats.names("all")
        with pytest.raises(UsageError, match=words):
            formats.names("parquet")


def test_runs_with_similar_names_have_separate_folders():
    samples = [
        Truth(n, POSE, "", 0.0, groups={"run": run}) for n, run in enumerate(("a b", "a_b", "a/b", "a b"))
    ]
    found = common.by_run(samples)
    assert sorted(len(members) for members in found.values()) == [1, 1, 2]
    assert all(name.replace("_", "").isalnum() for name in found)


def test_large_sets_are_divided_in_order(made, monkeypatch):
    folder, samples = made
    size = sum((folder / path).stat().st_size for path in samples[0].files.values())
    monkeypatch.setattr(common, "SHARD_BYTES", 2 * size)
    parts = common.shards(folder, samples)
    assert len(parts) >= 3
    assert [truth for part in parts for truth in part] == samples
    assert all(parts)


def test_a_set_without_splits_is_one_list(tmp_path):
    samples = [replace(truth, split="") for truth in labelled.data_set(tmp_path, 3)]
    formats.write(tmp_path, samples, ["yolo", "coco", "webdataset"])
    assert len((tmp_path / "all.txt").read_text().split()) == 3
    assert "train: all.txt\nval: all.txt\n" in (tmp_path / "data.yaml").read_text()
    assert len(instances(tmp_path, "all")["images"]) == 3
    assert (tmp_path / "webdataset/all-000000.tar").is_file()


def test_a_failed_format_leaves_the_old_files(made, tmp_path):
    labelled.data_set(tmp_path, 3)
    samples = made[1][:3]
    formats.write(tmp_path, samples, ["coco"])
    before = (tmp_path / "annotations/instances_train.json").read_bytes()
    (tmp_path / files.name("masks", 2)).unlink()
    with pytest.raises(InputError, match=r"000002\.png"):
        formats.write(tmp_path, samples, ["coco"])
    assert (tmp_path / "annotations/instances_train.json").read_bytes() == before
    assert not list(tmp_path.parent.glob(".*.part"))
