"""The index for nerfstudio: one per camera, and one of all cameras whose paths lead to the same files."""

import json
import struct
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.passes import masks
from firetwin.render import dataset, verify
from firetwin.shot import passes
from firetwin.shot.settings import Render, Settings
from firetwin_core import sensor

LENS = {
    "width": 64,
    "height": 36,
    "fx": 50.0,
    "fy": 50.0,
    "cx": 32.0,
    "cy": 18.0,
    "projection": "perspective",
}
SIDECAR = {
    "intrinsics": LENS | {"distortion": dict.fromkeys(("k1", "k2", "p1", "p2"), 0.0)},
    "pose": {"camera_to_world": [[1.0]]},
    "time_utc": "2014-09-17T23:12:00Z",
}


@pytest.mark.parametrize("cameras", [("drone",), ("drone", "tower")])
def test_cameras_are_merged_into_one_index(tmp_path, cameras):
    names = []
    for camera in cameras:
        for kind, end in (("rgb", "png"), ("pose", "json"), ("depth", "exr")):
            name = f"{camera}/{kind}/{camera}_{kind}_000001.{end}"
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(json.dumps(SIDECAR))
            names.append(name)
    dataset.write(SimpleNamespace(names=lambda: names, out=tmp_path))
    for camera in cameras:
        (frame,) = json.loads((tmp_path / camera / dataset.NAME).read_text())["frames"]
        assert (tmp_path / camera / frame["file_path"]).is_file()
    merged = tmp_path / dataset.NAME
    assert merged.exists() == (len(cameras) > 1)
    if merged.exists():
        frames = json.loads(merged.read_text())["frames"]
        assert [frame["camera"] for frame in frames] == list(cameras)
        for frame in frames:
            paths = [frame["file_path"], *(path for paths in frame["passes"].values() for path in paths)]
            assert len(paths) == 4
            assert all((tmp_path / path).is_file() for path in paths)


def make(out, *kinds):
    """Index the frames (camera, number, kinds) of empty files."""
    names = []
    for camera, number, listed in kinds:
        for kind in listed.split():
            for suffix in passes.known()[kind].files:
                names.append(name := passes.file_of(camera, kind, number, suffix))
                (out / name).parent.mkdir(parents=True, exist_ok=True)
                (out / name).write_text(json.dumps(SIDECAR))
    dataset.write(SimpleNamespace(names=lambda: names, out=out))


def test_every_frame_of_an_index_has_depth_and_mask_or_none_has(tmp_path):
    both, keys = "rgb pose nerfstudio", {"depth_file_path", "mask_path"}
    make(tmp_path, ("drone", 1, both), ("drone", 2, both), ("tower", 1, both), ("tower", 2, "rgb pose"))
    found = {
        path.parent.name: json.loads(path.read_text())["frames"] for path in tmp_path.rglob(dataset.NAME)
    }
    assert all(keys <= set(frame) for frame in found["drone"])
    assert not any(keys & set(frame) for frame in (*found["tower"], *found[tmp_path.name]))
    make(tmp_path, ("drone", 1, both), ("tower", 1, both))
    for frame in json.loads((tmp_path / dataset.NAME).read_text())["frames"]:
        assert frame["depth_file_path"].endswith(".npy")
        assert frame["mask_path"].endswith(".png")
        assert all((tmp_path / frame[key]).is_file() for key in keys)


def read_mask(path: Path):
    """The pixels of a PNG of one 8-bit channel whose rows have no filter or that of Sub or Up."""
    data, place, packed = path.read_bytes(), 8, b""
    while place < len(data):
        length, kind = struct.unpack_from(">I4s", data, place)
        part = data[place + 8 : place + 8 + length]
        if kind == b"IHDR":
            width, height, bits, colours = struct.unpack_from(">IIBB", part)
            assert (bits, colours) == (8, 0)  # nerfstudio refuses masks of several channels
        packed += part if kind == b"IDAT" else b""
        place += length + 12
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, width + 1)
    above, unfiltered = np.zeros(width, np.uint8), []
    for row in rows:
        pixels = row[1:]
        assert row[0] in (0, 1, 2)
        pixels = {0: pixels, 1: np.cumsum(pixels, dtype=np.uint8), 2: pixels + above}[int(row[0])]
        unfiltered.append(above := pixels)
    return np.array(unfiltered)


def test_the_files_hold_millimetres_and_static_pixels(tmp_path):
    """They are read as nerfstudio does: np.load(depth) * 0.001, and the mask's non-zero pixels."""
    planar = np.full((4, 7), 1234.5, np.float32)
    planar[:, 6], planar[0] = 41_000.125, 1e10
    kind = np.tile(np.arange(7, dtype=np.float32), (4, 1))
    needed = {"depth": {"exr": tmp_path / "depth.exr"}, "masks": {"exr": tmp_path / "masks.exr"}}
    sensor.write_image(
        needed["depth"]["exr"], np.stack([planar, planar * 1.1], -1), None, ["planar", "range"]
    )
    names = ["class", "clear", "instance", "surface"]
    sensor.write_image(needed["masks"]["exr"], np.stack([kind, *[kind * 0.0] * 3], -1), None, names)
    files = {"npy": tmp_path / "frame.npy", "png": tmp_path / "frame.png"}
    passes.finish("nerfstudio", files, needed, SimpleNamespace(), "drone", 1)
    depth = np.load(files["npy"])
    assert depth.dtype == np.float32
    metres = depth * 0.001
    assert np.all(metres[0] == 0.0)
    assert metres[1:, :6] == pytest.approx(1234.5, abs=1e-3)
    assert metres[1:, 6] == pytest.approx(41_000.125, abs=5e-3)
    static = np.isin(kind, (masks.GROUND, masks.BURNED, masks.TREE, masks.BUILDING))
    assert np.array_equal(read_mask(files["png"]).astype(bool), static)
    for path in files.values():
        verify.picture(path, (7, 4))
    files["npy"].write_bytes(files["npy"].read_bytes()[:-4])
    with pytest.raises(InputError, match="Blender wrote a damaged file"):
        verify.picture(files["npy"], (7, 4))


def test_masks_of_eevee_are_refused():
    camera = SimpleNamespace(name="drone", rig=SimpleNamespace(around=False))
    eevee, cycles = (Settings(render=Render(engine=engine)) for engine in ("eevee", "cycles"))
    assert "with EEVEE" in passes.refused(passes.known()["nerfstudio"], camera, eevee)
    assert not passes.refused(passes.known()["nerfstudio"], camera, cycles)
