"""`firetwin cache` with tiles: choices share files, and what no choice names goes too."""

import json
import os
import struct
import time

import pytest
from firetwin import cli
from firetwin.jobs.tiles import cache
from firetwin.shot.tiles import tile_cut
from firetwin.shot.tiles.tile_cut import TileCut
from firetwin.tiles import decoded
from firetwin.tiles.sources import http_cache
from firetwin.tiles.sources.http_cache import HttpCache

HOUR = 3600.0


def _used(path, ago):
    os.utime(path, (0, time.time() - ago))


def _tile(place, name, picture=""):
    text = json.dumps({"materials": [{"picture": picture}, {}]}).encode()
    (place / name).write_bytes(decoded._FIRST + struct.pack("<I", len(text)) + text + bytes(1000))
    return name


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Two choices that share a tile, used 1 and 2 hours ago, and files that no choice names."""
    monkeypatch.setattr(http_cache, "folder", lambda: tmp_path / "user")
    place = tmp_path / "cache" / "tiles"
    (place / "content").mkdir(parents=True)
    picture = f"{9:032x}.jpg"
    (place / picture).write_bytes(bytes(5000))
    shared = _tile(place, f"{1:032x}.tile", picture)
    for number, name in enumerate(("a", "b"), start=1):
        own = _tile(place, f"{number + 1:032x}.tile")
        cut = TileCut(place, name * 16, (shared, own), ("Somebody",), (), 2.0)
        path = place / f"{cut.name}.json"
        tile_cut.write(cut, path)
        (place / f"{cut.name}.npz").write_bytes(bytes(700))
        (place / cut.name).mkdir()
        os.link(place / picture, place / cut.name / "0.1001.jpg")
        _used(path, number * HOUR)
    rest = place / "content" / f"{7:064x}"
    rest.write_bytes(bytes(3000))
    _used(rest, 9 * HOUR)
    (place / "mine.txt").write_text("mine")
    return place


def _names(place):
    return {path.relative_to(place).as_posix() for path in place.rglob("*") if path.is_file()}


def test_each_file_is_counted_once(kept):
    first, second, rest = cache.list_tiles(kept.parent)
    assert (first.folder.stem, second.folder.stem, rest.folder) == ("a" * 16, "b" * 16, kept)
    assert rest.bytes == 3000
    inodes = {path.stat().st_ino: path.stat().st_size for path in kept.rglob("*") if path.is_file()}
    assert first.bytes + second.bytes + rest.bytes == sum(inodes.values()) - len("mine")
    assert first.bytes > 5000 > second.bytes


def test_they_are_listed_with_volumes(kept, capsys):
    (kept.parent / f"{1:016x}").mkdir()
    assert cli.main(["cache", str(kept.parent)]) == 0
    out, err = capsys.readouterr()
    assert [line.split("  ")[2] for line in out.splitlines()] == [
        "in use",
        "used 1 h 0 min ago",
        "used 2 h 0 min ago",
        "used 9 h 0 min ago",
    ]
    assert "of smoke volumes and tiles in" in err


def test_the_least_recently_used_goes_and_leaves_what_another_needs(kept, capsys):
    first, second, _ = cache.list_tiles(kept.parent)
    limit = str(first.bytes + second.bytes - 1)
    before = _names(kept)
    assert cli.main(["cache", "--prune", "--limit", limit, "--dry-run", str(kept.parent)]) == 0
    would = capsys.readouterr()
    assert _names(kept) == before
    assert cli.main(["cache", "--prune", "--limit", limit, str(kept.parent)]) == 0
    did = capsys.readouterr()
    assert did.out == would.out
    assert before - _names(kept) == {
        f"content/{7:064x}",
        f"{'b' * 16}.json",
        f"{'b' * 16}.npz",
        f"{'b' * 16}/0.1001.jpg",
        f"{3:032x}.tile",
    }
    cut = tile_cut.read(kept / f"{'a' * 16}.json")
    assert cut.is_whole()
    assert cli.main(["cache", "--prune", "--limit", "0", str(kept.parent)]) == 0
    assert _names(kept) == {"mine.txt"}


def test_what_is_in_use_stays(kept):
    _used(kept / f"{'b' * 16}.json", 0.0)
    assert cli.main(["cache", "--prune", "--limit", "0", str(kept.parent)]) == 0
    assert tile_cut.read(kept / f"{'b' * 16}.json").is_whole()
    assert not (kept / f"{'a' * 16}.json").exists()


def test_what_came_into_use_meanwhile_stays(kept):
    first, *_ = cache.list_tiles(kept.parent)
    _used(first.folder, 0.0)
    assert not cache.remove(first)
    assert first.folder.exists()


def test_a_damaged_choice_names_its_own_files_alone(kept):
    (kept / f"{'a' * 16}.json").write_text("{")
    _used(kept / f"{'a' * 16}.json", HOUR)
    first, second, _ = cache.list_tiles(kept.parent)
    assert first.names == {f"{'a' * 16}.json", f"{'a' * 16}.npz", f"{'a' * 16}/0.1001.jpg"}
    assert f"{1:032x}.tile" in second.names


def test_answers_of_servers_are_listed_and_pruned(kept, capsys):
    answers = HttpCache(http_cache.folder())
    for number in range(3):
        answers.put(
            f"https://x.example/{number}",
            bytes(1000),
            {"Cache-Control": "max-age=60"},
            time.time() - 7230 + number,
        )
    answers.close()
    assert cli.main(["cache", str(kept.parent)]) == 0
    assert f"{http_cache.folder()}  0 MB  3 responses, used 2 h 0 min ago" in capsys.readouterr().out
    arguments = ["cache", "--prune", "--answers", "2500", str(kept.parent)]
    assert cli.main([*arguments, "--dry-run"]) == 0
    assert HttpCache(http_cache.folder()).content()[0] == 3
    assert cli.main(arguments) == 0
    assert "tile server responses remain in" in capsys.readouterr().err
    assert HttpCache(http_cache.folder()).content()[:2] == (2, 2000)


def test_no_cache_of_answers_is_made_by_looking(kept, capsys):
    assert cli.main(["cache", str(kept.parent)]) == 0
    assert not http_cache.folder().exists()
