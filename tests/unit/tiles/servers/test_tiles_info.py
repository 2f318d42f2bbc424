"""`firetwin tiles info`."""

import json

import pytest
from firetwin import cli
from firetwin.tiles import contents, info, list_command
from firetwin.tiles.policies import Policy
from lying_server import Reply, serving
from polite import rude
from tilesets import GLB, Memory, as_bytes, box, load, tile, tileset, write


def some():
    region = {"region": [-2.1041, 0.6797, -2.1039, 0.6799, 0.0, 100.0]}
    root = tile(
        100.0, "r.glb", [tile(10.0, "a.b3dm", volume=region), tile(12.0, "sub.json", volume=region)], region
    )
    inner = tileset(tile(3.0, "m.json", volume=region), asset={"version": "1.0", "copyright": "Two; One"})
    whole = tileset(root | {"refine": "REPLACE"}, asset={"version": "1.1", "copyright": "One"})
    return {"tileset.json": whole, "sub.json": inner, "r.glb": GLB, "a.b3dm": GLB, "m.json": {"asset": {}}}


def test_what_is_in_a_tileset(tmp_path, capsys):
    write(tmp_path, some())
    assert cli.main(["tiles", "info", str(tmp_path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["tiles"], facts["contents"], facts["files"], facts["whole"]) == (4, 3, 2, True)
    assert facts["kinds"] == {"glb": 2, "gltf": 1}  # by their bytes: a.b3dm is a glb
    assert [each["tiles"] for each in facts["levels"]] == [1, 2, 1]
    assert facts["levels"][1] == {"tiles": 2, "with_content": 1, "error_m": [10.0, 12.0]}
    assert facts["credits"] == ["One", "Two"]
    assert facts["centre"]["latitude"] == pytest.approx(38.9494, abs=1e-3)
    assert facts["centre"]["longitude"] == pytest.approx(-120.5504, abs=1e-3)
    assert facts["missing"] == []
    assert cli.main(["tiles", "info", str(tmp_path)]) == 0
    page = capsys.readouterr().out
    assert "tiles      4 (4 REPLACE)" in page
    assert "38.949" in page
    assert "N 120.550" in page


def test_what_is_missing_is_listed(capsys, tmp_path):
    write(tmp_path, {name: value for name, value in some().items() if name not in ("sub.json", "a.b3dm")})
    assert cli.main(["tiles", "info", str(tmp_path)]) == 0
    page = capsys.readouterr().out
    assert page.count("missing    ") == 2
    assert "not placed" not in page


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nowhere"], "is not there; name a tileset.json"),
        (["http://tiles.example/t.json"], "plain http"),
        (["ion:x"], "number of an asset"),
        (
            ["https://tiles.example/t.json", "--offline"],
            "not in the cache, and the network may not be used: leave",
        ),
    ],
)
def test_refusals_are_one_polite_line(words, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert cli.main(["tiles", "info", *words]) == 1
    line = capsys.readouterr().err
    assert message in line
    assert not rude(line)


def test_a_server_is_read_a_little_and_one_that_forbids_it_not_at_all(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with serving() as server:
        inner = tileset(tile(1.0, "x.glb"))
        children = [tile(5.0, f"{i}.json") for i in range(60)]
        server.answers |= {f"/{i}.json": as_bytes(inner) for i in range(60)}
        server.answers["/t.json"] = Reply(200, as_bytes(tileset(tile(9.0, children=children))))
        assert cli.main(["tiles", "info", f"{server.url}/t.json"]) == 0
        assert len(server.asked) == 50
        assert "not all: --files reads more" in capsys.readouterr().out
        assert cli.main(["tiles", "info", f"{server.url}/t.json", "--files", "61", "--json"]) == 0
        facts = json.loads(capsys.readouterr().out)
        assert (facts["whole"], facts["tiles"], facts["kinds"]) == (True, 121, {"glb": 60})
    source = Memory({})
    source.policy = Policy(may_prefetch=False)
    assert list_command._default_files(source) == 1


def test_a_tileset_in_metres_of_its_own(tmp_path):
    facts = info.gather(load(tile(1.0, volume=box(5.0, half=2.0))), None)
    assert facts["centre"] is None
    assert facts["extent_m"] == {"low": [3.0, -2.0, -2.0], "high": [7.0, 2.0, 2.0]}
    assert "not placed on the Earth" in info.format_text(facts)


def test_kinds_and_lengths():
    assert contents.kind(GLB) == "glb"
    assert contents.kind(b"\xef\xbb\xbf {}") == "json"
    assert contents.kind(b"") == "unknown"
    assert contents.kind_by_name("a/b.I3DM?x=.glb") == "i3dm"
    assert contents.truncation(GLB[:5]) == "5 bytes, less than its header"
    assert contents.truncation(GLB + b"more") is None
    assert list(
        contents.references(
            {"root": {"contents": [{"url": "a"}, 5], "children": [{"content": {"uri": "b"}}]}}
        )
    ) == ["a", "b"]
    assert list(contents.references([])) == []


def test_strict_fails_where_a_file_is_missing(tmp_path, capsys):
    root = tile(8.0, "r.glb", [tile(1.0, "gone.glb")], refine="ADD")
    folder = str(write(tmp_path / "set", {"tileset.json": tileset(root), "r.glb": GLB}))
    assert cli.main(["tiles", "info", folder]) == 0
    assert "gone.glb: " in capsys.readouterr().out
    assert cli.main(["tiles", "info", folder, "--strict"]) == 1
    told = capsys.readouterr()
    assert "--strict: 1 file missing: " in told.err
    assert "gone.glb" in told.err
