"""`firetwin cache`: order of removal, and files that stay."""

import os
import time

import pytest
from firetwin import cli
from firetwin.smoke import cache
from firetwin.tiles.sources import http_cache

HOUR = 3600.0


@pytest.fixture(autouse=True)
def no_answers(tmp_path, monkeypatch):
    """The user's own answers of tile servers are left alone."""
    monkeypatch.setattr(http_cache, "folder", lambda: tmp_path / "user")


@pytest.fixture
def kept(tmp_path):
    """A cache with volumes of 1, 2 and 3 MB used 1, 2 and 3 hours ago, and foreign files."""
    place = tmp_path / "cache"
    for size in (1, 2, 3):
        folder = place / f"{size:016x}"
        folder.mkdir(parents=True)
        (folder / "smoke_000001.vdb").write_bytes(bytes(size * 500_000))
        (folder / "smoke_000002.vdb").write_bytes(bytes(size * 500_000))
        _used(folder, size * HOUR)
    (place / "run-0123456789abcdef.json").write_text("{}")
    (place / "mine").mkdir()
    (place / "mine" / "smoke_000001.vdb").write_bytes(bytes(9))
    return place


def _used(folder, ago):
    os.utime(folder, (0, time.time() - ago))


def _names(place):
    return sorted(path.name[-1] for path in place.iterdir() if len(path.name) == 16)


def test_they_are_listed_with_size_and_use(kept, capsys):
    assert cli.main(["cache", str(kept)]) == 0
    out, err = capsys.readouterr()
    assert [line.split("  ")[1:] for line in out.splitlines()] == [
        ["1 MB", "used 1 h 0 min ago"],
        ["2 MB", "used 2 h 0 min ago"],
        ["3 MB", "used 3 h 0 min ago"],
    ]
    assert "6 MB of smoke volumes" in err
    assert _names(kept) == ["1", "2", "3"]


@pytest.mark.parametrize(
    ("limit", "left"), [("6MB", "123"), ("5.9 MB", "12"), ("3000000", "12"), ("2MB", "1"), ("0", "")]
)
def test_what_was_used_longest_ago_goes_first(kept, capsys, limit, left):
    assert cli.main(["cache", "--prune", "--limit", limit, "--dry-run", str(kept)]) == 0
    would = capsys.readouterr()
    assert _names(kept) == ["1", "2", "3"]
    assert cli.main(["cache", "--prune", "--limit", limit, str(kept)]) == 0
    did = capsys.readouterr()
    assert _names(kept) == list(left)
    assert did.out == would.out
    assert did.err == would.err.replace("would free", "freed")
    assert (kept / "run-0123456789abcdef.json").exists()
    assert (kept / "mine" / "smoke_000001.vdb").exists()


def test_what_is_in_use_never_goes(kept, capsys):
    folder = kept / f"{3:016x}"
    with cache.in_use(folder):
        assert cli.main(["cache", "--prune", "--limit", "0", str(kept)]) == 0
        assert _names(kept) == ["3"]
    cli.main(["cache", str(kept)])
    assert "in use" in capsys.readouterr().out


def test_what_came_into_use_meanwhile_stays(kept):
    (volumes,) = [each for each in cache.list_volumes(kept) if each.folder.name.endswith("2")]
    _used(volumes.folder, 0.0)
    assert not cache.remove(volumes)
    assert _names(kept) == ["1", "2", "3"]


def test_files_of_others_among_ours_stay(kept):
    folder = kept / f"{3:016x}"
    (folder / "notes.txt").write_text("mine")
    _used(folder, 3 * HOUR)
    cli.main(["cache", "--prune", "--limit", "0", str(kept)])
    assert [path.name for path in folder.iterdir()] == ["notes.txt"]


def test_a_scene_file_names_its_cache(kept, tmp_path, capsys):
    (tmp_path / "scene.toml").write_text('cache = "cache"\n')
    assert cli.main(["cache", str(tmp_path / "scene.toml"), str(kept)]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 3


@pytest.mark.parametrize(
    "arguments", [["--limit", "x"], ["--limit=-1GB"], ["--limit", "5 XB"], ["--limit", "nan"], ["nowhere"]]
)
def test_bad_usage(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        status = cli.main(["cache", *arguments])
    except SystemExit as end:
        status = end.code
    assert status == 2
    assert arguments[-1].rpartition("=")[2] in capsys.readouterr().err


def test_a_cache_that_is_not_there_yet_is_empty(tmp_path, capsys):
    (tmp_path / "scene.toml").write_text('cache = "cache"\n')
    assert cli.main(["cache", "--prune", str(tmp_path / "scene.toml")]) == 0
    assert "freed 0 MB" in capsys.readouterr().err


def test_the_tail_of_a_volume_counts(tmp_path):
    path = tmp_path / "smoke_000001.vdb"
    path.write_bytes(cache._MAGIC + bytes(100))
    cache.check(path, 108)
    for content, size in ((b"", 108), (cache._MAGIC + bytes(50), 108), (bytes(108), 108)):
        path.write_bytes(content)
        with pytest.raises(Exception, match="truncated"):
            cache.check(path, size)
