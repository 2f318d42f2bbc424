"""Deliveries: names by a pattern, hashes, versions that are never overwritten."""

import contextlib
import json
import os
import re
import subprocess
from pathlib import Path

import fileseq
import pytest
from firetwin import cli, written
from firetwin.delivery import names, version
from firetwin.delivery.command import PATTERN
from firetwin.errors import InputError, UsageError
from firetwin.render import manifest, store
from firetwin.render.picture import Picture, film
from firetwin.render.store import Store

VIEWS = ("drone", "drone@slower", "ir-2")


@pytest.fixture
def finished(tmp_path):
    """Return a folder of finished files of three views, made up."""
    out = tmp_path / "film"
    with Store(out, create=True) as film_store:
        for camera in VIEWS:
            entries = {}
            for frame in (1, 2, 3):
                for path in Picture(camera, frame, "rgb").files():
                    entries[path] = {"camera": camera, "pass": "rgb", "frame": frame}
            for kind in ("review", "clean"):
                entries[film(camera, "rgb", kind)] = {"camera": camera, "pass": "rgb", "film": kind}
            for path in entries:
                (out / path).parent.mkdir(parents=True, exist_ok=True)
                (out / path).write_bytes(path.encode())
                entries[path] |= store.describe(out / path)
            film_store.add({"run": {}}, entries)
        film_store.export()
    return out


LINKS = os.name == "posix"
NAMES = {"latest", "v001", "v002"} if LINKS else {"latest.txt", written.NAME, "v001", "v002"}


def latest(out):
    """Return the version that the link names, or the text where links are not possible."""
    return os.readlink(out / "latest") if LINKS else (out / "latest.txt").read_text().strip()


def deliver(*words):
    return cli.main(["deliver", *map(str, words)])


@pytest.mark.posix("sha256sum")
def test_a_version_has_all_files_and_matches_its_hashes(finished, tmp_path, capsys):
    out = tmp_path / "delivered"
    assert deliver(finished, "--out", out) == 0
    delivered = out / "v001"
    assert capsys.readouterr().out.strip() == str(delivered)
    assert (delivered / "drone/rgb/drone_rgb.1001.exr").read_bytes() == b"drone/rgb/drone_rgb_000001.exr"
    assert (delivered / "drone_at_slower/rgb/drone_at_slower_rgb.mp4").is_file()
    done = subprocess.run(
        ["sha256sum", "-c", "SHA256SUMS"], cwd=out / "latest", capture_output=True, text=True
    )
    assert (done.returncode, done.stdout.count(": OK")) == (0, 3 * (3 * 2 + 2))
    assert (delivered / "drone/rgb_clean/drone_rgb_clean.mp4").read_bytes() == b"drone/drone_rgb_clean.mp4"
    listed = json.loads((delivered / "manifest.json").read_text())["files"]
    entry = listed["ir-2/rgb/ir-2_rgb.1003.png"]
    assert (entry["frame"], entry["number"], entry["source"]) == (3, 1003, "ir-2/rgb/ir-2_rgb_000003.png")
    sequence = fileseq.findSequencesOnDisk(str(delivered / "drone_at_slower/rgb"))
    exr = next(each for each in sequence if each.extension() == ".exr")
    assert (exr.start(), exr.end(), fileseq.FileSequence(str(exr)).basename()) == (
        1001,
        1003,
        "drone_at_slower_rgb.",
    )


def test_versions_count_up_and_are_never_overwritten(finished, tmp_path, capsys):
    out = tmp_path / "delivered"
    assert deliver(finished, "--out", out, "--version", 7) == 0
    assert (
        deliver(finished, "--out", out, "--pattern", "{camera}_{pass}_{version}.{frame}.{ext}", "--start", 1)
        == 0
    )
    assert (out / "v008/drone_rgb_v008.0001.exr").is_file()
    before = (out / "v007/SHA256SUMS").read_bytes()
    assert deliver(finished, "--out", out, "--version", 7) == 2
    assert "v007 exists, and a delivered version is never overwritten" in capsys.readouterr().err
    assert (out / "v007/SHA256SUMS").read_bytes() == before
    assert deliver(finished, "--out", out, "--version", 2) == 0
    assert latest(out) == "v008"


def test_an_interrupted_delivery_leaves_nothing(finished, tmp_path):
    chosen, out = names.choose(finished, PATTERN, 1001), tmp_path / "delivered"

    def stop(done, *_):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        version.write(out, chosen, None, stop)
    assert list(out.iterdir()) == []
    assert version.write(out, chosen).name == "v001"


def test_a_file_that_changed_is_not_delivered(finished, tmp_path):
    (finished / "drone/drone_rgb.mp4").write_bytes(b"drone/drone_rgb.mp5")
    with pytest.raises(InputError, match=r"drone_rgb.mp4: changed since it was rendered"):
        version.write(tmp_path / "delivered", names.choose(finished, PATTERN, 1001))
    assert not (tmp_path / "delivered/v001").exists()


@pytest.mark.parametrize(
    "hostile",
    [
        {"camera": "../../../OUTSIDE/x"},
        {"camera": "/tmp/x"},
        {"camera": ".."},
        {"camera": 7},
        {"pass": "a/../../x"},
        {"film": "../x"},
        {"frame": "1/../../x"},
    ],
)
def test_values_of_a_manifest_never_lead_out_of_the_version(finished, tmp_path, hostile):
    path = finished / "manifest.json"
    content = json.loads(path.read_text())
    for entry in content["files"].values():
        entry |= hostile
    path.write_text(json.dumps(content))
    out, before = tmp_path / "a" / "b" / "delivered", sorted(tmp_path.rglob("*"))
    words = r"manifest.json: (names .* cannot be part of a file name|files.* is not as Firetwin writes it)"
    with pytest.raises(InputError, match=words):
        version.write(out, names.choose(finished, PATTERN, 1001))
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("value", [None, True, -1, 7, 2**70, 1e300, "x", [], [7], {}, {"x": 7}], ids=repr)
def test_a_manifest_with_other_values_is_read_or_one_line(finished, value):
    """Each value of an entry, of its settings, and each table, in place of the one that was written."""
    path = finished / "manifest.json"
    text = path.read_text()
    places = [(), ("files",), ("settings",), ("files", 0), ("settings", 0)]
    places += [
        ("files", 0, key) for key in ("bytes", "sha256", "camera", "pass", "frame", "film", "settings")
    ]
    places += [("files", 0, key) for key in ("time", "clock", "slate_frames", "credits", "missing_tiles")]
    places += [("settings", 0, key) for key in ("frames", "fps", "versions", "credits", "tiles", "run")]
    for place in places:
        content = {"": json.loads(text)}
        table, name = content, ""
        for key in place:
            table = table[name]
            name = key if isinstance(key, str) else next(iter(table))
        table[name] = value
        path.write_text(json.dumps(content[""]))
        with contextlib.suppress(InputError):
            names.choose(finished, PATTERN, 1001)
            read = manifest.read(finished)
            manifest.versions(read["settings"].values())
            for made_with in read["settings"].values():
                manifest.credit_entry(made_with)


def test_two_deliveries_at_once_get_two_numbers(finished, tmp_path):
    chosen, out, second = names.choose(finished, PATTERN, 1001), tmp_path / "delivered", []
    (out / ".v007.0123456789ab.part").mkdir(parents=True)  # of a killed process

    def meanwhile(done, *_):
        if done == 3 and not second:
            second.append(None)
            second[0] = version.write(out, chosen)

    first = version.write(out, chosen, None, meanwhile)
    assert (first.name, second[0].name) == ("v001", "v002")
    assert latest(out) == "v002"
    assert {path.name for path in out.iterdir()} == NAMES
    for each in (first, second[0]):
        assert len(list(each.rglob("*.exr"))) == 9


def test_deliveries_of_processes_get_numbers_of_their_own_and_remove_rests(finished, tmp_path):
    chosen, out = names.choose(finished, PATTERN, 1001), tmp_path / "delivered"
    (out / ".v001.0123456789ab.part").mkdir(parents=True)
    (out / ".latest.0123456789ab.part").mkdir()
    (out / ".latest.0123456789ab.part" / "latest").symlink_to("v001")
    children = []
    for _ in range(3):
        children.append(os.fork())
        if children[-1] == 0:
            try:
                version.write(out, chosen)
            finally:
                os._exit(0)
    for child in children:
        os.waitpid(child, 0)
    assert sorted(path.name for path in out.iterdir()) == ["latest", "v001", "v002", "v003"]
    assert os.readlink(out / "latest") == "v003"
    assert len({len([*each.rglob("*")]) for each in out.glob("v*")}) == 1


def test_a_text_names_the_latest_version_where_links_are_not_possible(finished, tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError("no right to make links")

    monkeypatch.setattr(Path, "symlink_to", fail)
    chosen, out = names.choose(finished, PATTERN, 1001), tmp_path / "delivered"
    for _ in range(2):
        version.write(out, chosen)
    assert (out / "latest.txt").read_text() == "v002\n"
    assert {path.name for path in out.iterdir()} == {"latest.txt", written.NAME, "v001", "v002"}


def test_a_link_latest_of_others_stays(finished, tmp_path):
    out, mine = tmp_path / "delivered", tmp_path / "mine"
    out.mkdir()
    mine.mkdir()
    (out / "latest").symlink_to(mine)
    chosen = names.choose(finished, PATTERN, 1001)
    with pytest.raises(InputError, match="latest: is a link that firetwin deliver did not write"):
        version.write(out, chosen)
    assert [path.name for path in out.iterdir()] == ["latest"]
    version.write(out, chosen, overwrite=True)
    assert os.readlink(out / "latest") == "v001"


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        ("{shot}.{frame}.{ext}", r"\{shot\} is not one of \{camera\}"),
        ("shot.{ext}", r"\{frame\} is missing"),
        ("shot.{frame:04d}.{ext}", "fields have no format"),
        ("../{frame}.{ext}", "names files below a folder"),
        ("/a/{frame}.{ext}", "names files below a folder"),
        ("a b.{frame}.{ext}", "names files below a folder"),
        ("shot.{frame.{ext}", "--pattern"),
    ],
)
def test_bad_patterns_are_bad_usage(pattern, words):
    with pytest.raises(UsageError, match=words):
        names.check(pattern)


def test_two_files_with_one_name_are_refused(finished):
    with pytest.raises(UsageError, match=r"would both be shot\.mp4"):
        names.choose(finished, "shot.{frame}.{ext}", 1001)


def test_missing_files_are_named_and_an_empty_folder_is_refused(finished, tmp_path):
    (finished / "ir-2/ir-2_rgb.mp4").unlink()
    assert names.choose(finished, PATTERN, 1).messages == [
        "1 file of the manifest missing, such as ir-2/ir-2_rgb.mp4"
    ]
    with pytest.raises(InputError, match="has no finished pictures or films"):
        names.choose(tmp_path / "none", PATTERN, 1)


def test_films_without_a_frame_are_refused_in_one_line(finished, tmp_path, capsys):
    for path in finished.rglob("*_00000?.*"):
        path.unlink()
    assert deliver(finished, "--out", tmp_path / "delivered") == 1
    assert capsys.readouterr().err.splitlines() == [
        f"firetwin: {finished}: has films and none of their frames; run firetwin render --resume for them"
    ]
    assert not (tmp_path / "delivered").exists()


def test_the_pattern_of_the_page_names_the_version_once_in_folders(finished, tmp_path):
    page = (Path(__file__).parents[3] / "docs/delivery.md").read_text()
    (pattern,) = {each for each in re.findall(r"`(\S+\{frame\}\.\{ext\})`", page) if "{version}" in each}
    assert deliver(finished, "--out", tmp_path, "--pattern", pattern) == 0
    delivered = [path.relative_to(tmp_path) for path in (tmp_path / "v001").rglob("*_v001.1001.exr")]
    assert len(delivered) == len(VIEWS)
    assert all(path.parts.count("v001") == 1 for path in delivered)


def test_a_file_that_its_exr_names_keeps_its_name(tmp_path):
    out = tmp_path / "film"
    with Store(out, create=True) as film_store:
        paths = Picture("drone", 1, "data").files()
        (out / paths[0]).parent.mkdir(parents=True)
        for path in paths:
            (out / path).write_bytes(b"content")
        facts = {"camera": "drone", "pass": "data", "frame": 1}
        film_store.add({"run": {}}, {path: facts | store.describe(out / path) for path in paths})
        film_store.export()
    found = {each.pattern for each in names.choose(out, PATTERN, 1001).files}
    assert found == {"drone/data/drone_data.1001.exr", "drone/data/drone_data_000001.json"}
