"""Decoding in separate processes: arrays as files, and names of undecodable tiles."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
import tile_files as made
from decoding import *  # noqa: F403
from firetwin.errors import InputError
from firetwin.jobs.tiles import decode
from firetwin.jobs.tiles.decode import DecodeTask
from firetwin.shot.tiles import tile_cut
from firetwin.tiles import decoded

ONE = np.eye(4).tolist()


def content(folder, name, data):
    (folder / name).write_bytes(data)
    return DecodeTask(str(folder / name), name, ONE, ONE, str(folder / f"{name}.tile"))


@pytest.mark.usefixtures("decoded_here")
def test_a_tile_comes_back_as_it_was_decoded(tmp_path):
    good = content(tmp_path, "good.glb", made.square().glb())
    assert decode.run([good]) == {}
    tile = decoded.read(tmp_path / "good.glb.tile")
    assert tile.position.shape == (4, 3)
    assert tile.triangle.shape == (2, 3)
    assert tile.material_index.tolist() == [0, 0]
    before = os.stat(good.out).st_mtime_ns
    assert decode.run([good]) == {}
    assert os.stat(good.out).st_mtime_ns == before  # an existing file is not decoded again


def test_tiles_that_are_wrong_or_hang_are_named_and_the_others_go_on(tmp_path, monkeypatch):
    names = ("first", "bad", "hangs", "last")
    contents = [content(tmp_path, f"{name}.glb", made.square().glb()) for name in names]
    (tmp_path / "bad.glb").write_bytes(made.square().glb()[:60])
    (tmp_path / "hangs.glb").unlink()
    os.mkfifo(tmp_path / "hangs.glb")  # reading it blocks for ever
    monkeypatch.setattr(decode, "_SECONDS", 8.0)
    bad = decode.run(contents)
    assert "no progress" in bad["hangs.glb"]
    assert {each.name for each in contents if not Path(each.out).exists()} == set(bad)
    assert list(bad) == ["bad.glb", "hangs.glb"]


@pytest.mark.usefixtures("decoded_here")
def test_a_decoded_tile_whose_numbers_do_not_fit_is_refused(tmp_path):
    good = content(tmp_path, "good.glb", made.square().glb())
    decode.run([good])
    data = Path(good.out).read_bytes()
    tile = decoded.read(Path(good.out))
    wrong = data.replace(tile.triangle.tobytes(), (tile.triangle + 9).tobytes())
    assert wrong != data
    (tmp_path / "wrong.tile").write_bytes(wrong)
    with pytest.raises(InputError, match="inconsistent numbers"):
        decoded.read(tmp_path / "wrong.tile")


@pytest.mark.usefixtures("decoded_here")
def test_a_decoded_tile_that_is_cut_off_is_decoded_again(tmp_path):
    good = content(tmp_path, "good.glb", made.square().glb())
    decode.run([good])
    whole = Path(good.out).read_bytes()
    for length in (0, 10, 30, len(whole) - 1):
        Path(good.out).write_bytes(whole[:length])
        assert decoded.read_summary(Path(good.out)) is None
        with pytest.raises(InputError, match="not a decoded tile"):
            decoded.read(Path(good.out))
    decode.run([good])
    assert Path(good.out).read_bytes() == whole
    assert decoded.read_summary(Path(good.out)).triangles == 2


def test_a_cut_is_read_as_it_was_written(tmp_path):
    cut = tile_cut.TileCut(
        tmp_path, "cut", ("a.tile",), ("Somebody",), ("b: not there",), 2.5, difference=(-1.0, 0.5, 2.0)
    )
    tile_cut.write(cut, tmp_path / "cut.json")
    assert tile_cut.read(tmp_path / "cut.json") == cut
    (tmp_path / "cut.json").write_text(json.dumps({"tiles": []}))
    with pytest.raises(InputError, match="selected tiles"):
        tile_cut.read(tmp_path / "cut.json")
