"""Films on tiles by the command line: credits in pictures, sidecars and manifest, and missing tiles."""

import json
import subprocess
import sys

import numpy as np
import pytest
from firetwin.imaging import credits as layout
from firetwin.imaging.credits import Credits
from firetwin_core import sensor
from scene_text import DRONE, NO_PLANTS, NO_SMOKE

SIZE = 192, 108
WORDS = Credits(("Somebody of the tests", "Another"))
SCENE = (
    """\
run = "{run}"
{tiles}
[time]
frames = 2
"""
    + NO_PLANTS
    + NO_SMOKE
    + """\
[render]
resolution = [192, 108]
samples = 1
denoise = false
passes = ["rgb", "edl", "pose", "masks"]
"""
    + DRONE
)


@pytest.fixture(scope="module")
def folder(run_folder, tmp_path_factory):
    """Scene files without and with tiles, and tiles of which one has gone."""
    folder = tmp_path_factory.mktemp("tiles")
    for name, tiles in (
        ("plain", ""),
        ("scene", 'tiles = { sources = ["set"], max_screen_space_error = 1.0, geoid = -24.9 }'),
    ):
        (folder / f"{name}.toml").write_text(SCENE.format(run=run_folder, tiles=tiles))
    run(
        folder,
        "tiles",
        "make",
        folder / "plain.toml",
        "--out",
        folder / "set",
        "--credit",
        "; ".join(WORDS.data),
        "--geoid",
        -24.9,
    )
    gone = max((folder / "set").rglob("*.glb"), key=lambda path: path.as_posix())
    gone.unlink()
    return folder, gone


def run(folder, *arguments, status=0):
    """Return the output of `firetwin`."""
    process = subprocess.run(
        [sys.executable, "-m", "firetwin", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=900,
    )
    assert process.returncode == status, process.stderr
    return process.stdout, process.stderr


@pytest.fixture(scope="module")
def film(folder):
    place, gone = folder
    _, err = run(place, "render", place / "scene.toml", "--out", place / "film")
    return place / "film", gone, err


def _rows(path):
    return sensor.read_image(path)[..., :3]


def test_a_missing_tile_fails_a_strict_job_and_nothing_is_rendered(folder):
    place, gone = folder
    for verb, out in (("render", ["--out", "strict"]), ("build", ["-o", "strict.blend"])):
        _, err = run(place, verb, place / "scene.toml", *out, "--strict", status=1)
        assert "--strict: 1 tile missing: " in err
        assert str(gone) in err
    assert not (place / "strict").exists()
    assert not (place / "strict.blend").exists()


def test_it_is_said_otherwise(film):
    _, gone, err = film
    assert f"1 tiles are missing, the first: {gone}" in err
    assert f"credits of tiles, which pictures show: {WORDS.text()}" in err


def test_pictures_that_are_looked_at_show_the_credits(film):
    out, _, _ = film
    (block,) = layout.blocks(WORDS, *SIZE)
    strips = []
    for name in ("rgb", "edl"):
        for frame in (1, 2):
            rows = _rows(out / f"drone/{name}/drone_{name}_{frame:06d}.png")
            strips.append(rows[block.top :])
            assert rows[: block.top].std() > 0.02
    assert all((each == strips[0]).all() for each in strips)
    assert strips[0].max() > 0.9
    assert strips[0][:, :20].max() < 0.1  # nothing at the left: no service
    exr = _rows(out / "drone/rgb/drone_rgb_000001.exr")[block.top :]
    masks = _rows(out / "drone/masks/drone_masks_000001.png")[block.top :]
    assert exr.mean() > 0.05  # data keep their pixels
    assert np.abs(masks - strips[0]).min(axis=2).mean() > 0.1


def test_manifest_and_sidecars_name_credits_and_what_is_missing(film):
    out, gone, _ = film
    manifest = json.loads((out / "manifest.json").read_text())
    assert len(manifest["files"]) == 2 * 6 + 2  # rgb 2, edl 1, pose 1, masks 2; two films
    for name, entry in manifest["files"].items():
        assert entry["credits"] == list(WORDS.data), name
        assert entry["missing_tiles"] == [str(gone)], name
    sidecar = json.loads((out / "drone/pose/drone_pose_000002.json").read_text())
    assert sidecar["credits"] == list(WORDS.data)
    assert [each.split(": ")[0] for each in sidecar["tiles"]["missing"]] == [str(gone)]
    frames = json.loads((out / "drone/transforms.json").read_text())["frames"]
    assert [each["credits"] for each in frames] == [list(WORDS.data)] * 2


def test_a_film_is_resumed_until_its_credits_or_tiles_change(film, folder):
    (out, _, _), (place, _) = film, folder
    again = "render", place / "scene.toml", "--out", out, "--resume"
    _, err = run(place, *again)
    assert "8 of 8 pictures are finished and match; nothing to render" in err
    tileset = place / "set/tileset.json"
    before = tileset.read_text()
    tileset.write_text(before.replace("Another", "A third"))
    try:
        _, err = run(place, *again, "--frames", "1", "--passes", "edl")
    finally:
        tileset.write_text(before)
    assert "rendering 1 picture of drone" in err
    files = json.loads((out / "manifest.json").read_text())["files"]
    assert "A third" in files["drone/edl/drone_edl_000001.png"]["credits"]
