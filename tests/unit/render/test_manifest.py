"""Manifests of a film: damaged ones end each command that reads them in one line."""

import contextlib
import io
import json
import os
from pathlib import Path

import doors
import pytest
from firetwin import cli
from firetwin.render import manifest, store
from PIL import Image

COMMANDS = (
    "deliver film --out versions",
    "edit scene.toml --film film --out cut",
    "brief run --film film --out page.html --overwrite",
    "cite scene.toml --crate film --overwrite",
)
PICTURE, FILM = "drone/rgb/drone_rgb_000001.png", "drone/drone_rgb.mp4"


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    """Make a scene and a film with a picture, and change into their folder; returns the manifest's text."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("film"))
        out = Path.cwd() / "film"
        doors._scene(patch)
        (out / PICTURE).parent.mkdir(parents=True)
        Image.new("RGB", (4, 4)).save(out / PICTURE)
        (out / FILM).write_bytes(b"x")
        of = {"camera": "drone", "pass": "rgb", "settings": "a"}
        picture = of | store.describe(out / PICTURE)
        picture |= {"frame": 1, "time": "2014-09-17T04:45:00+00:00", "clock": "04:45", "credits": ["a"]}
        film = of | store.describe(out / FILM) | {"film": "review"}
        made_with = {"fps": "24", "frames": [[1, "a"]], "versions": {"firetwin": "0"}, "run": {}}
        manifest.write(out, {"a": made_with}, {PICTURE: picture, FILM: film})
        yield (out / manifest.NAME).read_text()


def call(words):
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        status = cli.main(words.split())
    return status, said.getvalue().splitlines()


@pytest.mark.parametrize(
    ("table", "name", "key", "value"),
    [
        ("files", PICTURE, "", [1]),
        ("files", "a\0b.png", "", {}),
        ("files", "\ud800.mp4", "", {}),
        ("files", PICTURE, "camera", 7),
        ("files", PICTURE, "camera", "\ud800"),
        ("files", PICTURE, "pass", None),
        ("files", PICTURE, "time", 1410929100),
        ("files", PICTURE, "time", "yesterday"),
        ("files", PICTURE, "time", "0001-01-01T00:00+14:00"),
        ("files", PICTURE, "frame", "1"),
        ("files", PICTURE, "frame", -1),
        ("files", PICTURE, "bytes", 2**70),
        ("files", PICTURE, "sha256", []),
        ("files", PICTURE, "credits", [7]),
        ("files", FILM, "film", {}),
        ("files", FILM, "settings", ["a"]),
        ("settings", "a", "", "a"),
        ("settings", "a", "frames", [1, 2]),
        ("settings", "a", "fps", 24),
        ("settings", "a", "versions", {"firetwin": 0}),
        ("settings", "a", "versions", {"\ud800": "0"}),
        ("settings", "a", "run", []),
    ],
)
def test_a_damaged_manifest_is_one_line_of_each_command(content, table, name, key, value):
    damaged = json.loads(content)
    if key:
        damaged[table][name][key] = value
    else:
        damaged[table][name] = value
    Path("film", manifest.NAME).write_text(json.dumps(damaged))
    for words in COMMANDS:
        status, (*_, line) = call(words)
        assert (status, line.partition("manifest.json: ")[0]) == (1, f"firetwin: film{os.sep}"), words
        assert "is not as Firetwin writes it" in line


def test_an_intact_manifest_is_read_by_each_command(content):
    Path("film", manifest.NAME).write_text(content)
    for words in COMMANDS:
        assert call(words)[0] == 0, call(words)
