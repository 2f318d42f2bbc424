"""The HTTP cache: effect of headers, order of removal, and two processes at the same time."""

import multiprocessing
import sqlite3
import stat
import sys
from email.utils import formatdate

import pytest
from firetwin.errors import InputError
from firetwin.tiles.sources.backoff import Clock
from firetwin.tiles.sources.http import Http
from firetwin.tiles.sources.http_cache import HttpCache, folder, rules
from firetwin.tiles.sources.network import Network
from lying_server import Reply, serving

NOW = 1_000_000.0
URL = "https://tiles.example/a.glb"


@pytest.mark.parametrize(
    ("headers", "store", "lasts", "strict"),
    [
        ({"Cache-Control": "private, max-age=14400, must-revalidate, no-transform"}, True, 14400, True),
        ({"Cache-Control": "max-age=60", "Age": "20"}, True, 40, False),
        ({"Cache-Control": "max-age=60", "Age": "90"}, True, 0, False),
        ({"Cache-Control": "max-age=60, no-cache"}, True, 0, True),
        ({"Cache-Control": "no-store, max-age=60"}, False, 60, False),
        ({"Cache-Control": 'MAX-AGE="60"'}, True, 60, False),
        ({"Cache-Control": "max-age=soon"}, True, 0, False),
        (
            {"Expires": formatdate(NOW + 50, usegmt=True), "Date": formatdate(NOW, usegmt=True)},
            True,
            50,
            False,
        ),
        ({"Expires": "0"}, True, 0, False),
        ({"Vary": "*", "Cache-Control": "max-age=60"}, False, 60, False),
        ({}, True, 0, False),
    ],
)
def test_headers(headers, store, lasts, strict):
    found = rules(headers, NOW)
    assert (found.store, found.expires - NOW, found.strict) == (store, lasts, strict)


def test_an_answer_comes_back_and_a_new_one_takes_its_place(tmp_path):
    cache = HttpCache(tmp_path / "c")
    assert cache.find(URL, NOW) is None
    cache.put(URL, b"one", {"Cache-Control": "max-age=5", "ETag": '"e"', "Last-Modified": "then"}, NOW)
    found = cache.find(URL, NOW)
    assert (found.body, found.etag, found.modified, found.expires, found.strict) == (
        b"one",
        '"e"',
        "then",
        NOW + 5,
        False,
    )
    cache.put(URL, b"two", {}, NOW)
    assert cache.find(URL, NOW).body == b"two"
    assert len([path for path in (tmp_path / "c").glob("??/*")]) == 1
    cache.put(URL, b"three", {"Cache-Control": "no-store"}, NOW)
    assert cache.find(URL, NOW) is None
    assert not list((tmp_path / "c").glob("??/*"))
    with sqlite3.connect(tmp_path / "c/answers.db") as data:
        assert data.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    if sys.platform != "win32":
        assert stat.S_IMODE((tmp_path / "c").stat().st_mode) == 0o700


def test_the_least_recently_used_go_first(tmp_path):
    cache = HttpCache(tmp_path, limit=1000)
    for number in range(10):
        cache.put(f"{URL}{number}", b"x" * 100, {}, NOW + number)
    assert cache.find(f"{URL}0", NOW + 1000).body == b"x" * 100  # used again
    cache.put(f"{URL}10", b"x" * 100, {}, NOW + 2000)
    left = [number for number in range(11) if cache.find(f"{URL}{number}", NOW + 2000)]
    assert left == [0, 3, 4, 5, 6, 7, 8, 9, 10]
    assert cache.prune(250) == 200
    assert len(list(tmp_path.glob("??/*"))) == 2


def _work(place, name, count):
    cache = HttpCache(place, limit=40_000)
    for number in range(count):
        url = f"{URL}{number % 7}"
        cache.put(url, name.encode() * 500, {}, NOW + number)
        found = cache.find(url, NOW)
        assert found is None or found.body in (b"a" * 500, b"b" * 500)
    cache.close()


def test_two_processes_share_a_cache(tmp_path):
    context = multiprocessing.get_context("spawn" if sys.platform == "win32" else "fork")
    workers = [context.Process(target=_work, args=(tmp_path, name, 30)) for name in "ab"]
    for each in workers:
        each.start()
    for each in workers:
        each.join()
    assert [each.exitcode for each in workers] == [0, 0]
    cache = HttpCache(tmp_path)
    assert all(cache.find(f"{URL}{number}", NOW) for number in range(7))
    left = len(list(tmp_path.glob("??/*")))
    assert left == 7 or (sys.platform == "win32" and left > 7)  # a file that was read cannot be removed


def test_a_stale_answer_is_confirmed_without_its_body(tmp_path):
    time = [NOW]
    clock = Clock(now=lambda: time[0])
    strict = {"Cache-Control": "private, max-age=100, must-revalidate", "ETag": '"v1"'}
    with serving() as server:

        def answer(_, headers):
            return (
                Reply(304, headers=strict)
                if headers.get("If-None-Match") == '"v1"'
                else Reply(200, b"x", strict)
            )

        server.answers["/a"] = answer
        source = Http(f"{server.url}/t.json", Network(cache=tmp_path), clock)
        for seconds, asked in ((0, 1), (99, 1), (101, 2), (150, 2), (202, 3)):
            time[0] = NOW + seconds
            assert source.read(f"{server.url}/a") == b"x"
            assert len(server.asked) == asked
        assert [each.get("If-None-Match") for each in server.headers] == [None, '"v1"', '"v1"']
        source.close()
        time[0] = NOW + 1000
        offline = Http(f"{server.url}/t.json", Network(online=False, cache=tmp_path), clock)
        with pytest.raises(InputError, match="must not be used without the server"):
            offline.read(f"{server.url}/a")
        offline.close()


def test_the_folder_is_the_users(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(sys, "platform", "linux")
    assert folder() == tmp_path / "firetwin/tiles"
    monkeypatch.setattr(sys, "platform", "darwin")
    assert folder().parts[-4:] == ("Library", "Caches", "firetwin", "tiles")
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "local"))
    assert folder() == tmp_path / "local/firetwin/tiles"
