"""Formats of data sets: boxes, masks and poses of each file agree with the truth."""

import json
from dataclasses import replace

import labelled
import numpy as np
import pytest
from firetwin.dataset import files, formats, rle
from firetwin.dataset.formats import coco, colmap, common, hf, nerfstudio, yolo
from firetwin.dataset.truth import CATEGORIES, Truth, stem
from firetwin.errors import InputError, UsageError
from firetwin.geometry.quaternion import matrices
from PIL import Image

POSE = labelled.camera(1)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("set")
    samples = labelled.data_set(folder)
    formats.write(folder, samples, formats.FORMATS)
    return folder, samples


def test_each_format_is_a_module_that_writes():
    modules = (coco, colmap, hf, nerfstudio, yolo)
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
        mask = labelled.shapes(truth.index)[expected.category]
        assert each["segmentation"] == rle.encode(mask)
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


def test_yolo_boxes_come_back(made):
    folder, samples = made
    for truth in samples:
        lines = (folder / f"labels/{stem(truth.index)}.txt").read_text().splitlines()
        kinds, middle, size = np.split(
            np.array([line.split() for line in lines], float).reshape(-1, 5), (1, 3), 1
        )
        corners = [(middle - size / 2), (middle + size / 2)] * np.array([labelled.WIDTH, labelled.HEIGHT])
        expected = np.reshape(boxes_of_truth(truth), (-1, 4))
        np.testing.assert_allclose(np.hstack([*corners]), expected, atol=1e-4)
        assert (kinds[:, 0] + 1).tolist() == [each.category for each in truth.annotations]


def test_yolo_lists_each_picture_once_with_its_labels(made):
    folder, samples = made
    lists = [(folder / f"{split}.txt").read_text() for split in ("train", "test")]
    pictures = "".join(lists).split()
    assert sorted(pictures) == [f"./{truth.files['images']}" for truth in samples]
    for picture in pictures:
        assert (folder / picture).is_file()
        assert (folder / picture.replace("/images/", "/labels/")).with_suffix(".txt").is_file()
    assert "val: train.txt" in (folder / "data.yaml").read_text()  # never the pictures of the test


def test_coco_ignores_the_region_of_a_small_fire(tmp_path):
    (truth,) = labelled.data_set(tmp_path, count=1)
    small = replace(truth.annotations[0], id=9, box=(2.0, 3.0, 6.0, 5.0), pixels=7)
    hidden = replace(small, id=10, box=(0.0, 0.0, 0.0, 0.0), pixels=0)
    formats.write(tmp_path, [replace(truth, below_size=(small, hidden))], ["coco", "yolo"])
    *boxes, region = instances(tmp_path, truth.split)["annotations"]
    assert [each["iscrowd"] for each in boxes] == [0] * len(truth.annotations)
    assert (region["iscrowd"], region["bbox"], region["area"]) == (1, [0, 0, 10, 9], 90)
    mask = np.zeros((labelled.HEIGHT, labelled.WIDTH), bool)
    mask[:9, :10] = True  # 4 pixels more on each side, within the picture
    assert region["segmentation"] == rle.encode(mask)
    assert len({each["id"] for each in [*boxes, region]}) == len(boxes) + 1
    assert len((tmp_path / f"labels/{stem(1)}.txt").read_text().splitlines()) == len(boxes)


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


@pytest.mark.parametrize("through", [through_nerfstudio, through_colmap])
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
    formats.write(tmp_path, samples, formats.FORMATS)
    for path in folder.rglob("*"):
        if path.is_file():
            assert path.read_bytes() == (tmp_path / path.relative_to(folder)).read_bytes(), path


def test_names_of_formats_are_explained():
    assert formats.names("yolo, coco,yolo") == ("yolo", "coco")
    assert formats.names("all") == tuple(formats.FORMATS)
    with pytest.raises(UsageError, match='no format "kitti"; choose from coco, yolo'):
        formats.names("kitti")
    for name, remedy in (
        ("voc", "globox convert"),
        ("parquet", "to_parquet"),
        ("webdataset", "ShardWriter"),
        ("tum", "colmap"),
    ):
        with pytest.raises(UsageError, match=f"does not write {name}; .*{remedy}"):
            formats.names(name)


def test_runs_with_similar_names_have_separate_folders():
    samples = [
        Truth(n, POSE, "", 0.0, groups={"run": run}) for n, run in enumerate(("a b", "a_b", "a/b", "a b"))
    ]
    found = common.by_run(samples)
    assert sorted(len(members) for members in found.values()) == [1, 1, 2]
    assert all(name.replace("_", "").isalnum() for name in found)


def test_a_set_without_splits_is_one_list(tmp_path):
    samples = [replace(truth, split="") for truth in labelled.data_set(tmp_path, 3)]
    formats.write(tmp_path, samples, ["yolo", "coco"])
    assert len((tmp_path / "all.txt").read_text().split()) == 3
    assert "train: all.txt\nval: all.txt\n" in (tmp_path / "data.yaml").read_text()
    assert len(instances(tmp_path, "all")["images"]) == 3


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


def test_folders_and_files_of_others_stay(tmp_path):
    samples = labelled.data_set(tmp_path, 3)
    (tmp_path / "annotations").mkdir()
    for name in ("annotations/mine.json", "data.yaml"):
        (tmp_path / name).write_text("mine")
    with pytest.raises(InputError, match=r"data\.yaml: exists already, and Firetwin did not write it"):
        formats.write(tmp_path, samples, ["coco", "yolo"])
    formats.write(tmp_path, samples, ["coco"])
    for name in ("annotations/mine.json", "data.yaml"):
        assert (tmp_path / name).read_text() == "mine"


def test_labels_of_samples_that_are_gone_do_not_stay(tmp_path):
    samples = labelled.data_set(tmp_path, 3)
    formats.write(tmp_path, samples, ["yolo"])
    formats.write(tmp_path, samples[:2], ["yolo"])
    assert sorted(path.name for path in (tmp_path / "labels").iterdir()) == ["000001.txt", "000002.txt"]
