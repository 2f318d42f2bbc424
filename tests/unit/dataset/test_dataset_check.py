"""Check of data sets: an intact set has no faults; each fault has one line with its remedy."""

import shutil
from dataclasses import replace

import labelled
import numpy as np
import plain_samples
import pytest
from firetwin import cli
from firetwin.dataset import about, check, files, finish, formats, labels, sensor, sums, truth, twins
from firetwin.errors import InputError
from firetwin.passes import masks
from PIL import Image

COUNT = 9


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    folder = tmp_path_factory.mktemp("original")
    labelled.data_set(folder, COUNT)
    about.write(folder, about.About(count=COUNT, split_by="place"))
    finish.write(folder, ["coco", "yolo"])
    return folder


@pytest.fixture
def folder(original, tmp_path):
    return shutil.copytree(original, tmp_path / "set")


def faults(folder):
    return [finding.text for finding in check.check(folder) if finding.is_fault]


def change(folder, index, **values):
    truth.write(folder, replace(truth.read(folder, index), **values))
    sums.write(folder)


def only(folder, *words):
    """Check that there is one fault, and that it has these words."""
    found = faults(folder)
    assert len(found) == 1, found
    assert all(word in found[0] for word in words), found[0]
    assert "; " in found[0]
    assert "\n" not in found[0]


def test_an_intact_set_has_no_faults(original):
    found = list(check.check(original))
    assert not [each for each in found if each.is_fault]
    remarks = [each.text for each in found]
    assert "train: 6 samples, 33% without fire and smoke; labels: 4 fire, 4 smoke" in remarks


def test_a_changed_byte_is_found(folder):
    path = folder / files.name("classes", 4)
    path.write_bytes(path.read_bytes()[:-1] + b"x")
    only(folder, "classes/000004.png: differs from SHA256SUMS", "restore it")


def test_files_that_are_not_listed_are_found(folder):
    (folder / "notes.txt").write_text("mine")
    only(folder, "notes.txt: is not in SHA256SUMS", "remove it")


def test_a_set_without_hashes_is_not_complete(folder):
    (folder / sums.NAME).unlink()
    only(folder, "SHA256SUMS: is missing", "resume it")


@pytest.mark.parametrize("content", [None, b""])
def test_missing_and_empty_files_are_found(folder, content):
    path = folder / files.name("twin", 2)
    change(folder, 2, files=truth.read(folder, 2).files | {"twin": files.name("twin", 2)})
    if content is not None:
        path.parent.mkdir()
        path.write_bytes(content)
        sums.write(folder)
    state = "is missing" if content is None else "is empty"
    only(folder, f"twin/000002.png: {state}", "delete meta/000002.json and resume")


def test_half_written_pictures_are_found(folder):
    path = folder / files.name("images", 2)
    path.write_bytes(path.read_bytes()[:200])
    sums.write(folder)
    only(folder, "images/000002.jpg: is damaged or half-written", "delete meta/000002.json")


def test_leftovers_are_found(folder):
    (folder / "images" / ".000010.abc.part.jpg").write_bytes(b"half")
    only(folder, ".000010.abc.part.jpg: was left half-written", "delete it")


def test_files_of_work_are_not_a_part_of_the_set(folder):
    (folder / ".work").mkdir()
    (folder / ".work" / ".a.part.json").write_text("")
    assert not faults(folder)


def test_missing_samples_are_found(folder):
    about.write(folder, about.About(count=COUNT + 2, split_by="place"))
    sums.write(folder)
    only(folder, "2 of 11 samples are missing (10, 11)", "resume it")


def test_damaged_metadata_are_found(folder):
    (folder / "meta/000009.json").write_text("{")
    sums.write(folder)
    found = faults(folder)
    assert any("is damaged" in text and "meta/000009.json" in text for text in found), found


def test_a_group_in_two_splits_is_found(folder):
    change(folder, 9, split="test")  # a picture of the ridge
    found = [text for text in faults(folder) if "is in test and train" in text]
    assert len(found) == 3  # the place, its run, its camera
    assert 'place "ridge" is in test and train' in found[0]
    assert 'split_by = "place"' in found[0]


def test_a_set_that_is_split_by_run_may_have_a_place_in_two_splits(folder):
    about.write(folder, about.About(count=COUNT, split_by="run"))
    for index in (3, 4, 5):
        sample = truth.read(folder, index)
        change(folder, index, groups=sample.groups | {"place": "coast"})
    assert not faults(folder)


def test_a_moved_box_is_found(folder):
    sample = truth.read(folder, 1)
    x0, y0, x1, y1 = sample.annotations[0].box
    moved = replace(sample.annotations[0], box=(x0 + 1.0, y0, x1, y1))
    change(folder, 1, annotations=(moved, *sample.annotations[1:]))
    found = faults(folder)
    assert any("its mask" in text and "meta/000001.json" in text for text in found)
    for name in ("coco", "yolo"):
        remedy = f"firetwin dataset formats {folder} --format {name}"
        assert any("does not agree" in text and remedy in text for text in found)


def test_masks_must_agree_with_the_opacity(folder):
    path = folder / files.name("alpha", 1)
    alpha = np.array(Image.open(path))
    alpha[labelled.shapes(1)[truth.SMOKE]] = 1000
    Image.fromarray(alpha).save(path)
    sums.write(folder)
    only(folder, "meta/000001.json", "is smoke, but alpha is below 0.05")


def test_pixels_and_ids_must_agree_with_the_masks(folder):
    path = folder / files.name("masks", 1)
    ids = np.array(Image.open(path))
    ids[20, 60] = 9, 0, 0
    Image.fromarray(ids).save(path)
    sample = truth.read(folder, 2)
    wrong = replace(sample.annotations[0], pixels=3)
    change(folder, 2, annotations=(wrong, sample.annotations[1]))
    found = faults(folder)
    assert any("ids without an annotation: 9" in text for text in found)
    assert any("has 3 pixels, its mask" in text for text in found)


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("labels/000004.txt", "1 ", "0 "),
        ("train.txt", "000001", "000002"),
        ("annotations/instances_test.json", '"id":6,', '"id":60,'),
        ("annotations/instances_test.json", '"counts":"', '"counts":"1'),
    ],
)
def test_changed_formats_are_found(folder, path, old, new):
    text = (folder / path).read_text()
    assert old in text
    (folder / path).write_text(text.replace(old, new, 1))
    sums.write(folder)
    only(folder, f"{path}: does not agree with the metadata", "--format")


def test_near_copies_in_two_splits_are_found(folder):
    source, copy = (folder / files.name("images", index) for index in (3, 6))  # train, test
    with Image.open(source) as picture:
        picture.save(copy, quality=60)
    sums.write(folder)
    only(folder, "samples 3 (train) and 6 (test) are near copies", "remove one of them")


def test_even_pictures_and_other_pictures_are_not_copies():
    random = np.random.default_rng(0)
    sky = np.linspace(200.0, 20.0, 16)[:, None] + np.zeros(17)
    even = [twins.Fingerprint(n, split, sky) for n, split in enumerate(("train", "test"))]
    others = [
        twins.Fingerprint(9 + n, split, random.uniform(0.0, 255.0, (16, 17)))
        for n, split in enumerate(("train", "test") * 20)
    ]
    assert not list(twins.find([*even, *others]))


def test_a_rotation_is_checked(folder):
    sample = truth.read(folder, 3)
    mirrored = (np.array(sample.camera.camera_to_world) @ np.diag([1.0, -1.0, 1.0, 1.0])).tolist()
    change(folder, 3, camera=replace(sample.camera, camera_to_world=mirrored))
    only(folder, "camera_to_world is not a rotation")


def test_a_large_split_needs_each_category_and_negatives(tmp_path):
    for index in range(1, 31):
        sample = labelled.sample(tmp_path, index, "ridge")
        truth.write(tmp_path, replace(sample, annotations=sample.annotations[:1]))
    finish.write(tmp_path, [])
    found = [text for text in faults(tmp_path) if text.startswith("train: has no")]
    assert found == ["train: has no fire; draw more samples, or change positives and [splits] in the plan"]


def test_fires_without_a_label_are_counted(folder):
    change(folder, 3, draw={"kind": "fire"})
    remarks = [each.text for each in check.check(folder) if not each.is_fault]
    assert any("train: 1 of 5 samples with fire have no label" in text for text in remarks)


def test_many_faults_of_a_kind_end_with_their_number(folder):
    for number in range(30):
        (folder / f"{number}.txt").write_text("")
    found = faults(folder)
    assert len(found) == 21
    assert found[-1] == "hashes: 10 more findings of this kind"


def test_a_folder_without_samples_is_explained(tmp_path):
    with pytest.raises(InputError, match="has no samples") as caught:
        list(check.check(tmp_path))
    assert str(caught.value).startswith(f"{tmp_path}: has no samples")


def test_a_missing_file_is_one_fault(folder):
    (folder / files.name("alpha", 2)).unlink()
    only(folder, "alpha/000002.png: is missing", "delete meta/000002.json")


def test_samples_that_the_labels_and_the_sensors_wrote_have_no_faults(tmp_path):
    """Smoke of all opacities in front of a fire, and a negative."""
    camera = plain_samples.looking(-3.0, size=(160, 120))
    empty = plain_samples.plane(camera)
    opacity = np.zeros((120, 160), np.float32)
    opacity[10:90, 40:120] = np.linspace(0.0, 1.0, 80)
    burns = np.zeros((120, 160), bool)
    burns[70:100, 60:110] = True
    surface = np.where(burns, masks.FIRE, empty.surface).astype(np.uint8)
    light = burns[..., None].repeat(3, -1).astype(np.float32)
    smoky = replace(
        empty,
        rgb=(empty.twin * (1.0 - opacity[..., None]) + 0.9 * opacity[..., None]).astype(np.float32),
        clear=1.0 - opacity,
        smoke_range=np.where(opacity > 0.0, 900.0, np.inf).astype(np.float32),
        surface=surface,
        classes=np.where(opacity > 0.5, masks.SMOKE, surface).astype(np.uint8),
        twin_fire=light,
        fire=light * (1.0 - opacity[..., None]),
    )
    seeds = {"noise": 1, "thermal noise": 2}
    for index, rendered in enumerate((smoky, empty), 1):
        made, drawn = labels.label(rendered, plain_samples.flat_place(), index)
        sensed = sensor.apply(rendered, sensor.SensorSettings(), seeds)
        files.write(tmp_path, replace(made, groups={"run": "king"}), drawn, rendered, sensed)
    finish.write(tmp_path, formats.FORMATS)
    samples = finish.read_samples(tmp_path)
    assert [len(sample.annotations) for sample in samples] == [2, 0]
    assert not faults(tmp_path)


def test_the_command_prints_faults_and_ends_with_1(folder, capsys):
    assert cli.main(["dataset", "check", str(folder)]) == 0
    (folder / "notes.txt").write_text("mine")
    assert cli.main(["dataset", "check", str(folder)]) == 1
    out = capsys.readouterr().out.splitlines()
    assert [line for line in out if not line.startswith("note: ")] == [faults(folder)[0]]
