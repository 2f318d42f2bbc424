"""The index for nerfstudio: one per camera, and one of all cameras whose paths lead to the same files."""

import json
from types import SimpleNamespace

import pytest
from firetwin.render import dataset

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
