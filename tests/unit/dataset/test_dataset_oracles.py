"""Formats of data sets as other libraries read them.

pycocotools is a member of the extra `test`; the others are large, or need NumPy 2:
`tests/system/dataset_oracles.sh` installs them in a folder and runs these tests.
"""

import json

import labelled
import numpy as np
import pytest
from firetwin.dataset import formats


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("set")
    samples = labelled.data_set(folder)
    formats.write(folder, samples, formats.FORMATS)
    return folder, samples


@pytest.mark.parametrize("split", ["train", "test"])
@pytest.mark.parametrize("kind", ["bbox", "segm"])
def test_pycocotools_scores_the_truth_against_itself_with_1(made, split, kind):
    coco = pytest.importorskip("pycocotools.coco")
    score = pytest.importorskip("pycocotools.cocoeval").COCOeval
    expected = coco.COCO(str(made[0] / f"annotations/instances_{split}.json"))
    keys = "image_id", "category_id", "bbox", "segmentation"
    found = [{key: each[key] for key in keys} | {"score": 0.9} for each in expected.dataset["annotations"]]
    evaluation = score(expected, expected.loadRes(json.loads(json.dumps(found))), kind)
    evaluation.evaluate()
    evaluation.accumulate()
    evaluation.summarize()
    assert evaluation.stats[0] == 1.0


def test_pycocotools_decodes_the_masks(made):
    coco = pytest.importorskip("pycocotools.coco").COCO(str(made[0] / "annotations/instances_test.json"))
    for each in coco.dataset["annotations"]:
        expected = labelled.shapes(each["image_id"])[each["category_id"]]
        np.testing.assert_array_equal(coco.annToMask(each), expected)


def test_globox_reads_boxes_of_yolo_and_coco(made):
    library = pytest.importorskip("globox")
    folder, samples = made
    yolo = library.AnnotationSet.from_yolo_v5(folder / "labels", image_folder=folder / "images")
    coco = {}
    for split in ("train", "test"):
        read = library.AnnotationSet.from_coco(folder / f"annotations/instances_{split}.json")
        coco |= {each.image_id: each for each in read}
    for truth in samples:
        name = truth.files["images"].split("/")[1]
        expected = np.array([each.box for each in truth.annotations]).reshape(-1, 4)
        np.testing.assert_allclose(corners(yolo[name]), expected, atol=1e-4)
        np.testing.assert_array_equal(corners(coco[name]), expected)
        assert [int(box.label) + 1 for box in yolo[name].boxes] == [
            each.category for each in truth.annotations
        ]


def corners(picture):
    found = [(box.xmin, box.ymin, box.xmax, box.ymax) for box in picture.boxes]
    return np.array(found).reshape(-1, 4)


def test_pycolmap_projects_a_landmark_to_one_pixel(made):
    library = pytest.importorskip("pycolmap")
    folder, samples = made
    seen = 0
    for run in (folder / "colmap").iterdir():
        for picture in library.Reconstruction(str(run)).images.values():
            truth = next(each for each in samples if each.files["images"].endswith(picture.name))
            point = labelled.landmark(truth.camera)
            expected = labelled.project(truth.camera, point)
            np.testing.assert_allclose(picture.project_point(point), expected, atol=1e-6)
            seen += 1
    assert seen == len(samples)


def test_datasets_reads_the_image_folder(made, tmp_path):
    library = pytest.importorskip("datasets", exc_type=ImportError)
    folder, samples = made
    found = library.load_dataset("imagefolder", data_dir=str(folder / "imagefolder"), cache_dir=str(tmp_path))
    compare_rows(found, samples)


def compare_rows(found, samples):
    for split in ("train", "test"):
        members = [truth for truth in samples if truth.split == split]
        rows = sorted(found[split], key=lambda row: row["index"])
        for row, truth in zip(rows, members, strict=True):
            assert row["index"] == truth.index
            assert row["image"].size == (labelled.WIDTH, labelled.HEIGHT)
            corners = [(x, y, x + w, y + h) for x, y, w, h in row["objects"]["bbox"]]
            assert corners == [each.box for each in truth.annotations]
