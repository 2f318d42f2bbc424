"""Faults of tiles, line by line, from a server to the selection: fetch, decode, select.

The lines are in the table of docs/tiles.md; test_tiles_http.py has the faults of servers. In each case the
job continues with the available tiles, reports missing tiles, and fails if it is strict.
"""

import json
import os
import signal
import threading
import time
from dataclasses import replace

import geodesy
import numpy as np
import pytest
import tile_files as made
from decoding import *  # noqa: F403
from firetwin.data import sample
from firetwin.errors import Error, InputError
from firetwin.jobs import worker
from firetwin.jobs.tiles import access, decode, make, selection, source
from firetwin.jobs.tiles.access import PREFERENCE, TileAccess
from firetwin.shot.source import ShotSource
from firetwin.shot.terrain import tile_heights
from firetwin.shot.tiles import tile_cut
from firetwin.tiles import decoded, policies
from firetwin.tiles.policies import Policy
from firetwin.tiles.sources import http, http_cache
from firetwin.tiles.sources.network import Network
from lying_server import Clock, Reply, serving

FRESH = {"Cache-Control": "private, max-age=3600", "ETag": '"1"'}
SCENE = """run = "run"
time = { frames = 1 }
terrain = { near_radius = 0.0, apron = 3000.0 }
render = { resolution = [320, 180] }
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.98
longitude = -120.56
height = 600.0
target = "head"
"""


@pytest.fixture(scope="module")
def ground(tmp_path_factory):
    """A shot of a small run, and a tileset of its ground: files by their paths. A tile is a square."""
    folder = tmp_path_factory.mktemp("ground")
    sample.write(folder / "run", 2)
    (folder / "scene.toml").write_text(SCENE)
    shot = ShotSource(scene=str(folder / "scene.toml")).shot()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(make.Maker, "_write_terrain", lambda _, *place: "{}/{}_{}.glb".format(*place))
        make.run(shot, make.TilesRequest(folder / "set", levels=2, credit="Somebody", geoid=-24.9))
    text = (folder / "set" / "tileset.json").read_bytes()
    return shot, {"/t/tileset.json": text} | dict(squares(json.loads(text)["root"]))


def squares(tile):
    """A content for each tile, in the middle of its region."""
    west, south, east, north, low, high = tile["boundingVolume"]["region"]
    centre = geodesy.geocentric(*np.mean([[south, west, low], [north, east, high]], axis=0))
    content = made.square(
        asset={"version": "2.0", "copyright": "Somebody"},
        extensions={"CESIUM_RTC": {"center": list(centre)}},
        extensionsUsed=["CESIUM_RTC"],
    )
    content.json["nodes"][0]["scale"] = [2000.0] * 3
    yield f"/t/{tile['content']['uri']}", content.glb()
    for child in tile.get("children", []):
        yield from squares(child)


@pytest.fixture(scope="module")
def server():
    with serving() as each:
        yield each


@pytest.fixture(scope="module")
def shared_leaf():
    """Path of a leaf and its cut, once a test has them."""
    return []


class Chain:
    """From a server's tileset to a cut."""

    def __init__(self, ground, server, folder, shared_leaf):
        self.shot, self.files = ground
        self.server, self.folder, self.shared_leaf = server, folder, shared_leaf
        self.query = ""
        server.asked.clear()
        server.answers = {path: Reply(200, data, FRESH) for path, data in self.files.items()}

    def shot_of(self):
        tiles = replace(
            self.shot.settings.tiles,
            sources=(f"{self.server.url}/t/tileset.json{self.query}",),
            max_screen_space_error=1.0,
            geoid=-24.9,
        )
        return self.shot.with_settings(replace(self.shot.settings, tiles=tiles, cache=self.folder / "cache"))

    def make(self, **access):
        """The cut and its messages."""
        shot = self.shot_of()
        told = selection.make(shot, access=TileAccess(**access))
        return tile_cut.of_shot(shot), "\n".join(told)

    def leaf(self):
        """Path of one of the finest tiles that the shot shows, and the whole cut."""
        if not self.shared_leaf:
            cut, _ = self.make()
            assert not cut.missing
            assert len(cut.tiles) > 4
            self.shared_leaf += [max(each for each in self.server.asked if each.endswith(".glb")), cut]
            self.server.asked.clear()
            self.forget()
        return self.shared_leaf

    def forget(self):
        """Empty all caches."""
        for place in (self.folder / "user", self.folder / "cache"):
            for path in sorted(place.rglob("*"), reverse=True):
                path.rmdir() if path.is_dir() else path.unlink()


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(http, "Clock", lambda: clock)
    return clock


@pytest.fixture
def chain(ground, server, shared_leaf, tmp_path, monkeypatch, clock, decoded_here):
    monkeypatch.setattr(tile_heights.np, "savez_compressed", np.savez)  # compressing takes most of the time
    monkeypatch.setattr(tile_heights, "_MOST", 200)  # points of heights, which nothing here looks at

    def network(access):
        hosts = access.hosts, access.private
        return Network(access.online, access.setting, *hosts, cache=tmp_path / "user")

    monkeypatch.setattr(access.TileAccess, "network", network)
    return Chain(ground, server, tmp_path, shared_leaf)


def missing(chain, leaf, why, whole, strict=False):
    """An ancestor replaces a leaf and its neighbours; the job reports it, and fails if it is strict."""
    cut, told = chain.make()
    (reason,) = cut.missing
    assert reason.startswith(f"{chain.server.url}{leaf}: ")
    assert why in reason
    assert reason in told
    assert len(cut.tiles) == len(whole.tiles) - 3  # one parent for four children
    assert cut.credits == ("Somebody",)
    path = tile_cut.location(chain.shot_of())
    path.unlink()
    if not strict:
        return cut
    with pytest.raises(Error, match="--strict: 1 tile missing: ") as caught:
        chain.make(strict=True)
    assert f"{chain.server.url}{leaf}" in str(caught.value)
    assert not path.exists()
    return cut


@pytest.mark.parametrize("status", [404, 410])
def test_a_file_that_is_not_there(chain, status):
    leaf, whole = chain.leaf()
    chain.server.answers[leaf] = Reply(status, b"gone")
    missing(chain, leaf, f"is not there (status {status})", whole, strict=True)


def test_a_file_beside_a_tile_that_is_not_there(chain):
    """A glTF names an external buffer."""
    leaf, whole = chain.leaf()
    content = {"asset": {"version": "2.0"}, "buffers": [{"uri": "gone.bin", "byteLength": 12}]}
    chain.server.answers[leaf] = Reply(200, json.dumps(content).encode(), FRESH)
    cut = missing(chain, leaf, "gone.bin: is not there (status 404)", whole)
    assert len(cut.tiles) > 0


def swapped(monkeypatch, leaf, file):
    """Let decoders, in separate processes, read another file in place of a tile's."""
    monkeypatch.setattr(decode, "worker", worker)
    before = source.TileSource._content

    def content(source, number):
        found = before(source, number)
        return replace(found, file=str(file)) if found.name.endswith(leaf) else found

    monkeypatch.setattr(source.TileSource, "_content", content)


@pytest.fixture
def pipe(tmp_path):
    """A file that nobody writes: reading it takes for ever."""
    os.mkfifo(tmp_path / "pipe")
    return tmp_path / "pipe"


def test_a_decoder_that_dies_loses_its_tile_alone(chain, monkeypatch, pipe):
    leaf, whole = chain.leaf()
    started, start = [], worker.subprocess.Popen

    def popen(*arguments, **options):
        started.append(start(*arguments, **options))
        return started[-1]

    def kill():
        """End the decoder with a fault once it reads the tile: a pipe is written only while it is read."""
        while True:
            try:
                writing = os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
            except OSError:
                time.sleep(0.02)
                continue
            started[-1].send_signal(signal.SIGSEGV)
            started[-1].wait()
            os.close(writing)
            return

    monkeypatch.setattr(decode.os, "cpu_count", lambda: 1)
    monkeypatch.setattr(worker.subprocess, "Popen", popen)
    threading.Thread(target=kill, daemon=True).start()
    swapped(monkeypatch, leaf, pipe)
    cut, _ = chain.make()
    (reason,) = cut.missing
    assert reason.startswith(f"{chain.server.url}{leaf}: decoding stopped on signal")
    assert len(cut.tiles) == len(whole.tiles) - 3


@pytest.mark.posix("limits of the memory of a process")
def test_a_decoder_over_its_memory_loses_its_tile_alone(chain, monkeypatch):
    leaf, whole = chain.leaf()
    monkeypatch.setattr(decode, "_MEMORY", 300_000_000)
    swapped(monkeypatch, leaf, "/dev/zero")
    cut, _ = chain.make()
    (reason,) = cut.missing
    assert reason == f"{chain.server.url}{leaf}: memory ran out"
    assert len(cut.tiles) == len(whole.tiles) - 3


def not_finite():
    content = made.square()
    view = content.accessor(np.full((4, 3), np.nan, np.float32))
    content.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = view
    return content.scene().glb()


@pytest.mark.parametrize("content", [made.Gltf().glb(), not_finite()], ids=["no vertices", "not finite"])
def test_a_tile_without_anything_is_empty_and_counted(chain, content):
    leaf, whole = chain.leaf()
    chain.server.answers[leaf] = Reply(200, content, FRESH)
    cut, told = chain.make(strict=True)
    assert (cut.missing, cut.empty, len(cut.tiles)) == ((), 1, len(whole.tiles))
    assert "empty, without triangles between finite vertices: 1 tile" in told
    tile = [decoded.read(cut.folder / name) for name in cut.tiles if name not in whole.tiles]
    assert [len(each.triangle) for each in tile] == [0]


def test_a_box_without_extent_is_taken_as_it_is(chain):
    leaf, whole = chain.leaf()
    root = json.loads(chain.files["/t/tileset.json"])

    def flatten(tile):
        if leaf.endswith(tile.get("content", {}).get("uri", "?")):
            west, south, _, _, low, _ = tile["boundingVolume"]["region"]
            tile["boundingVolume"]["region"] = [west, south, west, south, low, low]
        for each in tile.get("children", []):
            flatten(each)

    flatten(root["root"])
    chain.server.answers["/t/tileset.json"] = Reply(200, json.dumps(root).encode(), FRESH)
    cut, _ = chain.make(strict=True)
    assert len(cut.tiles) == len(whole.tiles)


@pytest.mark.parametrize("place", ["decoded", "content", "choice"])
def test_a_damaged_cache_is_as_none(chain, place):
    whole, _ = chain.make()
    own = chain.folder / "cache" / "tiles"
    harmed = {
        "decoded": [own / name for name in whole.tiles],
        "content": list((own / "content").iterdir()),
        "choice": [tile_cut.location(chain.shot_of())],
    }[place]
    assert harmed
    for path in harmed:
        path.write_bytes(b"damaged" * 9)
    if place == "content":  # its decoded file is gone too
        for name in whole.tiles:
            (own / name).unlink()
    cut, _ = chain.make(strict=True)
    assert cut.tiles == whole.tiles
    assert cut.is_whole()
    assert sum(len(decoded.read(cut.folder / name).triangle) for name in cut.tiles) > 0


def test_without_permission_the_cache_is_used_and_the_setting_is_named(chain):
    """Fresh answers in the cache need no server; others are missing."""
    offline = {"online": False, "setting": PREFERENCE}
    with pytest.raises(InputError, match="System > Network > Allow Online Access"):
        chain.make(**offline)
    leaf, whole = chain.leaf()
    chain.make()
    chain.server.asked.clear()
    cut, _ = chain.make(strict=True, **offline)
    assert cut.tiles == whole.tiles
    cache = http_cache.HttpCache(chain.folder / "user")
    cache.put(f"{chain.server.url}{leaf}", b"", {"Cache-Control": "no-store"}, time.time())
    cache.close()
    cut, told = chain.make(**offline)
    assert leaf in "".join(cut.missing)  # and its ancestors, which were never requested
    assert "is not in the cache, and the network may not be used: allow it by Edit > Preferences" in told
    assert chain.server.asked == []


def test_a_film_is_continued_with_its_tiles_while_the_server_has_others(chain):
    """Only a complete selection stays; missing tiles are requested again."""
    leaf, whole = chain.leaf()
    shot = chain.shot_of()
    chain.make()
    assert selection._can_keep(shot, keep=True)
    assert not selection._can_keep(shot, keep=False)
    (chain.folder / "cache" / "tiles" / whole.tiles[0]).unlink()
    assert not selection._can_keep(shot, keep=True)
    chain.forget()
    chain.server.answers[leaf] = Reply(404)
    chain.make()
    assert not selection._can_keep(shot, keep=True)


def test_a_policys_error_is_taken_where_the_scene_has_none_of_its_own(chain, monkeypatch):
    known = Policy("an imitation", pixel_error=20.0, logo="Imitation Maps")
    monkeypatch.setattr(policies, "for_host", lambda host: known)
    first, told = chain.make()  # the scene says 1 pixel
    assert first.error == 1.0
    assert first.logo == ("Imitation Maps",)
    assert "recommends" not in told
    shot = chain.shot_of()
    default = replace(shot.settings.tiles, max_screen_space_error=2.0)
    shot = shot.with_settings(replace(shot.settings, tiles=default))
    told = "\n".join(selection.make(shot))
    assert "an imitation recommends tiles to 20 pixels" in told
    assert "credits of tiles, which pictures show: Imitation Maps; Somebody" in told
    assert tile_cut.of_shot(shot).error >= 20.0
