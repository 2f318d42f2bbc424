"""Files of samples: each map comes back, metadata come last, and equal samples are equal bytes."""

import json
import struct
import zlib
from dataclasses import replace

import numpy as np
import plain_samples
import pytest
from firetwin import files as atomic
from firetwin.dataset import files, sensor, truth
from firetwin.dataset.files import Masks
from firetwin.dataset.sensor import SensorSettings
from firetwin.dataset.truth import Annotation, CameraPose, Truth
from firetwin.errors import InputError
from firetwin.passes import masks as classes

KEYS = {"noise": 1, "thermal noise": 2}
POSE = CameraPose(64, 48, 60.0, 60.0, 32.0, 24.0, np.eye(4).tolist(), 38.8, -120.6, 900.0, 38.7, -120.5, 0.0)


@pytest.fixture(scope="module")
def sample():
    random = np.random.default_rng(0)
    base = plain_samples.plane(plain_samples.looking(-5.0))
    shape = base.depth.shape
    return replace(
        base,
        rgb=random.random((*shape, 3), np.float32),
        clear=random.random(shape, np.float32),
        instance=random.integers(0, 2**24, shape, np.int32),
        kelvin=random.uniform(250.0, 900.0, shape).astype(np.float32),
    )


def written(folder, sample, **more):
    ids = [np.arange(sample.depth.size, dtype=np.uint8).reshape(sample.depth.shape) // n for n in (1, 2, 3)]
    sensed = sensor.apply(sample, SensorSettings(full_well=9000.0, read_noise=0.004), KEYS)
    label = Truth(5, POSE, "2014-09-17T18:00:00+00:00", 3600.0)
    return files.write(folder, label, Masks(*ids), sample, sensed, **more), Masks(*ids), sensed


@pytest.fixture(scope="module")
def folder(tmp_path_factory, sample):
    folder = tmp_path_factory.mktemp("set")
    written(folder, sample)
    return folder


def test_all_maps_come_back(folder, sample):
    back = {kind: files.read(folder, kind, 5) for kind in files.KINDS}
    assert np.array_equal(back["clean"], files.eight_bits(sample.rgb))
    assert np.array_equal(back["twin"], files.eight_bits(sample.twin))
    assert np.abs(back["alpha"] - sample.alpha).max() <= 0.5001 / 65535
    assert np.array_equal(back["depth"], sample.depth)
    assert np.isinf(back["depth"]).any()
    assert np.isfinite(back["depth"]).any()
    assert np.array_equal(back["classes"], sample.classes)
    assert np.array_equal(back["instances"], sample.instance)
    assert np.abs(back["thermal"] - sample.kelvin).max() < 1e-4 * sample.kelvin.max()
    assert back["images"].shape == back["palette"].shape == (48, 64, 3)


def test_masks_come_back_with_their_three_layers(folder, sample):
    found = files.read_masks(folder, 5)
    ids = np.arange(sample.depth.size, dtype=np.uint8).reshape(48, 64)
    assert [found.smoke.tolist(), found.fire.tolist(), found.amodal.tolist()] == [
        (ids // n).tolist() for n in (1, 2, 3)
    ]


def test_masks_of_an_annotation_are_of_its_category():
    masks = Masks(*(np.full((2, 2), k, np.uint8) for k in (1, 2, 3)))
    plume, flames = (
        Annotation(k, category, (0, 0, 2, 2), 4, (0, 0, 2, 2), 4, 1.0, False, "x")
        for k, category in ((1, truth.SMOKE), (2, truth.FIRE))
    )
    assert masks.visible_pixels(plume).all()
    assert masks.amodal_pixels(plume).all()
    assert masks.visible_pixels(flames).all()
    assert not masks.amodal_pixels(flames).any()


def test_thermal_files_are_degrees_celsius_with_their_conditions(folder, sample):
    from PIL import Image

    with Image.open(folder / "thermal/000005.tif") as image:
        assert np.abs(np.array(image) + 273.15 - sample.kelvin).max() < 0.1
        assert image.tag_v2[270] == "brightness temperature, degrees C"
    conditions = json.loads((folder / "thermal/000005.json").read_text())
    assert conditions["unit"] == "degrees C"
    assert conditions["band_um"] == [8.0, 14.0]
    assert conditions["emissivity"] == 1.0


def test_the_sky_of_a_depth_file_is_no_data(folder, sample):
    from PIL import Image

    with Image.open(folder / "depth/000005.tif") as image:
        assert image.tag_v2[42113] == "0"
        assert np.array_equal(np.array(image) == 0.0, np.isinf(sample.depth))


def test_class_files_show_the_colours_of_the_mask_pass(folder, sample):
    from PIL import Image

    with Image.open(folder / "classes/000005.png") as image:
        shown = np.array(image.convert("RGB"))
    assert np.array_equal(shown, np.array(classes.COLOURS, np.uint8)[sample.classes])


def test_equal_samples_are_equal_bytes(tmp_path, folder, sample):
    written(tmp_path, sample)
    paths = sorted(path.relative_to(tmp_path) for path in tmp_path.rglob("*.*"))
    assert len(paths) == len(files.KINDS) + 2
    for path in paths:
        assert (folder / path).read_bytes() == (tmp_path / path).read_bytes(), path


def test_metadata_are_written_last_and_list_the_files(tmp_path, sample, monkeypatch):
    order, write = [], atomic.write
    monkeypatch.setattr(atomic, "write", lambda path, *more: (order.append(path), write(path, *more)))
    complete, _, _ = written(tmp_path, sample, kinds=("alpha", "thermal"))
    assert order[-1] == truth.path(tmp_path, 5)
    assert files.is_complete(tmp_path, 5)
    assert not files.is_complete(tmp_path, 6)
    assert complete.files == {
        "alpha": "alpha/000005.png",
        "thermal": "thermal/000005.tif",
        "thermal_conditions": "thermal/000005.json",
    }
    assert truth.read(tmp_path, 5) == complete
    assert not (tmp_path / "images").exists()


def test_a_damaged_map_has_a_remedy(tmp_path, sample):
    written(tmp_path, sample)
    for kind in ("depth", "alpha", "images"):
        path = tmp_path / files.name(kind, 5)
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        with pytest.raises(InputError, match="resume the data set"):
            files.read(tmp_path, kind, 5)
    with pytest.raises(InputError):
        files.read(tmp_path, "alpha", 9)


@pytest.mark.parametrize("side", [12_000, 20_000])
def test_a_picture_without_limits_is_refused(tmp_path, side):
    parts = (b"IHDR", struct.pack(">2I5B", side, side, 8, 2, 0, 0, 0)), (b"IDAT", b"")
    chunks = [
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        for kind, body in parts
    ]
    (tmp_path / "masks").mkdir()
    (tmp_path / "masks/000005.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))
    with pytest.raises(InputError, match=r"000005\.png: has more than 100,000,000 pixels; .*: remove it"):
        files.read(tmp_path, "masks", 5)


def test_annotations_of_a_picture_are_limited(folder, tmp_path):
    box = 0.0, 0.0, 1.0, 1.0
    one = (Annotation(1, truth.FIRE, box, 1, box, 1, 1.0, False, "visible"),)
    label = truth.read(folder, 5)
    truth.write(tmp_path, replace(label, annotations=one * truth.MOST))
    assert len(truth.read(tmp_path, 5).annotations) == 255
    truth.write(tmp_path, replace(label, annotations=one * (truth.MOST + 1)))
    with pytest.raises(InputError, match="is damaged; delete it"):
        truth.read(tmp_path, 5)
