"""Conversion as a user sees it: damaged files, stops, existing files; a run is complete or absent."""

import io
import pickle
import re
import sys
import threading
import time
import warnings
from collections import defaultdict
from pathlib import Path
from types import SimpleNamespace

import child_work
import damage
import model_files as made
import numpy as np
import pytest
from firetwin import cli, extras
from firetwin.errors import Error, InputError, UsageError
from firetwin.jobs import convert, worker
from firetwin.run import opening as runs
from firetwin.run import readers
from firetwin.run.models import heartbeat, netcdf, write

COUNT = len(damage.CUTS) + len(damage.WAYS)  # each once; tests/system/fuzz/convert.py tries 200 of each kind


def in_process(paths, out, **options):
    asked = [options.get(name, "") for name in ("start", "at", "projection")] + [0.0]
    convert.in_process(list(paths), out, asked)


@pytest.mark.skipif(sys.platform != "linux", reason="forks")
def test_damaged_files_are_a_run_or_one_line(tmp_path):
    """A signal (a crash inside HDF5) does not fail the test: that is not the user's process, see below."""
    ends = defaultdict(list)
    for kind, end in damage.tried_all(damage.KINDS, tmp_path, count=COUNT, seed=5):
        ends[kind].append(end)
    assert {kind: len(each) for kind, each in ends.items()} == dict.fromkeys(damage.KINDS, COUNT)
    assert not [(kind, end) for kind, each in ends.items() for end in each if end.wrong]
    assert [kind for kind, each in ends.items() if not any(end.said for end in each)] == []


@pytest.mark.parametrize("kind", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"])
@pytest.mark.parametrize("records", [0, 1, 3])
@pytest.mark.parametrize("types", [("f4", "i2", "S1", "f8"), ("i2",)])
def test_a_classic_file_that_is_cut_off_is_no_file(tmp_path, kind, records, types):
    """netCDF reads missing data as zeros."""
    path = tmp_path / "a.nc"
    with made.netCDF4.Dataset(path, "w", format=kind) as file:
        file.title, file.numbers = "a b c", np.arange(3, dtype=np.int16)
        for name, size in (("t", None), ("y", 3), ("x", 5)):
            file.createDimension(name, size)
        for name in types:
            file.createVariable(f"still_{name}", name, ("y", "x")).units = "m/s"
            moving = file.createVariable(f"moving_{name}", name, ("t", "y", "x"))
            moving[:records] = np.ones((records, 3, 5), name)
    whole = path.read_bytes()
    netcdf.File(path).close()
    padding = 2 if types == ("i2",) and records == 0 else 0
    path.write_bytes(whole[: len(whole) - padding])
    netcdf.File(path).close()
    path.write_bytes(whole[: len(whole) - padding - 1])
    with pytest.raises(InputError, match="it is incomplete"):
        netcdf.File(path)


def test_an_lcp_that_is_cut_off_is_not_left_out(tmp_path):
    paths, options = damage.files_of("lcp", tmp_path)
    for size in (7316, 6000, 0):
        paths[0].write_bytes(paths[0].read_bytes()[:size])
        with pytest.raises(InputError, match=r"a\.lcp: has no header of an LCP"):
            in_process(paths, tmp_path / "out", **options)


def test_what_makes_no_run_leaves_none(tmp_path):
    """Cells without a width, so that all longitudes are the same."""
    np.savez(tmp_path / "a.npz", time_of_arrival=np.ones((9, 9)), cell_width=0.0, cell_height=30.0)
    with pytest.raises(InputError, match=r"a\.npz: makes no run: longitude: value 2 is not beyond"):
        in_process([tmp_path / "a.npz"], tmp_path / "out", start="2020-07-01")
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]


def test_heights_that_no_run_can_have_leave_none(tmp_path):
    paths, options = damage.files_of("lcp", tmp_path)
    paths[0].write_bytes(paths[0].read_bytes()[:7316] + b"\xff\x7f" * (17 * 17 * 8))  # 32,767 m
    with pytest.raises(InputError, match=r"makes no run: elevation: has an elevation of 32,767 m"):
        in_process(paths, tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_a_process_that_crashes_is_one_line(tmp_path, monkeypatch, capfd):
    paths, _ = damage.files_of("forefire", tmp_path)
    child_work.importable(monkeypatch)
    monkeypatch.setattr(convert, "in_process", child_work.abort)
    assert cli.main(["convert", str(paths[0]), "--out", str(tmp_path / "out")]) == 1
    text = capfd.readouterr().err.strip().splitlines()
    assert len(text) == 1
    assert str(paths[0]) in text[0]
    assert "SIGABRT" in text[0]
    assert not (tmp_path / "out").exists()


def test_a_file_that_cannot_be_used_is_named(tmp_path, monkeypatch):
    """By the process that does the work: without a log of Blender or the number of an error."""
    child_work.importable(monkeypatch)
    monkeypatch.setattr(convert, "in_process", child_work.open_missing)
    paths, _ = damage.files_of("forefire", tmp_path)
    with pytest.raises(InputError) as caught:
        convert.run(paths, tmp_path / "out")
    assert str(caught.value) == f"{Path('/nowhere/at_all')}: No such file or directory"


def test_a_process_that_hangs_is_one_line(tmp_path, monkeypatch, capfd):
    paths, _ = damage.files_of("forefire", tmp_path)
    child_work.importable(monkeypatch)
    monkeypatch.setattr(convert, "in_process", child_work.hang)
    monkeypatch.setattr(convert, "PATIENCE", 1.0)
    assert cli.main(["convert", str(paths[0]), "--out", str(tmp_path / "out")]) == 1
    (line,) = capfd.readouterr().err.strip().splitlines()
    assert f"{paths[0]}: reading it made no progress for 1 s" in line
    assert not (tmp_path / "out").exists()


def test_patience_ends_with_what_is_silent_alone():
    class Child:
        killed = threading.Event()
        kill = killed.set

    with worker._Watchdog(Child, 0.4) as watch:
        for _ in range(12):
            time.sleep(0.05)
            watch.heard()
        assert not Child.killed.is_set()  # after 0.6 s
        assert Child.killed.wait(10.0)
        assert watch.over


def test_each_word_of_a_process_is_heard():
    class Child:
        stdin, wait = io.BytesIO(), staticmethod(lambda: 0)
        answers = ("heartbeat", None), ("progress", (1, 2)), ("tell", "a"), ("result", 5)
        stdout = io.BytesIO(b"a banner\n" + worker._START + b"".join(map(pickle.dumps, answers)))

    heard, told = [], []
    watch = SimpleNamespace(heard=lambda: heard.append(1))
    assert worker._converse(Child, print, lambda *_: None, told.append, watch) == ("result", 5)
    assert (len(heard), told) == (5, ["a"])


def test_reading_says_that_it_goes_on(tmp_path, monkeypatch):
    """A sign for each part that is read, so that neither many files nor slow ones are taken for a hang."""
    paths, _ = made.cfbm(tmp_path, count=5)
    signs = []
    monkeypatch.setattr(heartbeat, "_OFTEN", 0.0)
    with heartbeat.to(lambda: signs.append(1)):
        in_process(paths, tmp_path / "out")
    assert len(signs) > 5 * 6  # opened, and five fields of each


def test_the_command(tmp_path, capfd):
    paths, _ = damage.files_of("cfbm", tmp_path)
    out = tmp_path / "out"
    assert cli.main(["convert", *map(str, paths), "--out", str(out)]) == 0
    result = capfd.readouterr()
    assert result.out.strip() == str(out)
    assert "Community Fire Behavior Model" in result.err
    assert runs.open(out).heat_flux(1).max() > 1e4
    assert cli.main(["info", str(out)]) == 0
    assert (
        "Made from Community Fire Behavior Model\n  - times are taken from the file names"
        in capfd.readouterr().out
    )
    assert cli.main(["convert", *map(str, paths), "--out", str(out)]) == 1
    assert "already exists" in capfd.readouterr().err
    assert cli.main(["convert", str(paths[0]), "--out", str(tmp_path / "b"), "--at", "north"]) == 2
    assert cli.main(["info", str(paths[0])]) == 1
    assert "firetwin convert" in capfd.readouterr().err


def test_a_stopped_conversion_goes_on_and_is_no_run_before(tmp_path, monkeypatch):
    paths, _ = made.cfbm(tmp_path, count=6)
    in_process(paths, tmp_path / "whole")
    out, asked = tmp_path / "out", []

    def stop_at(moment):
        def progress(done, total, what=""):
            asked.append(done)
            if done == moment:
                raise KeyboardInterrupt

        return progress

    monkeypatch.setattr(write, "_OFTEN", 1)  # bytes: a journal entry each time
    words = [paths, out, ["", "", "", 0.0]]
    with pytest.raises(KeyboardInterrupt):
        convert.in_process(*words, progress=stop_at(4))
    assert not out.exists()
    assert not (write.part_of(out) / "run.toml").exists()
    with pytest.raises(InputError):
        runs.open(write.part_of(out))
    asked.clear()
    convert.in_process(*words, progress=stop_at(-1))
    assert asked[0] == 4  # finished work is not repeated
    assert not write.part_of(out).exists()
    for name in ("heat_flux", "wind_east", "fuel_arrival_time", "elevation"):
        assert (out / f"{name}.npy").read_bytes() == (tmp_path / "whole" / f"{name}.npy").read_bytes()


def test_what_was_made_of_other_files_is_made_again(tmp_path, monkeypatch):
    paths, _ = made.cfbm(tmp_path, count=6)
    out, asked = tmp_path / "out", []

    def progress(done, total, what=""):
        asked.append(done)
        if len(asked) == 5:
            raise KeyboardInterrupt

    monkeypatch.setattr(write, "_OFTEN", 1)
    words = [out, ["", "", "", 0.0]]
    with pytest.raises(KeyboardInterrupt):
        convert.in_process(list(paths), *words, progress=progress)
    convert.in_process(paths[:4], *words, progress=progress)
    assert asked[5] == 0
    assert len(runs.open(out).times) == 4


def test_a_full_disk_is_said_before_it_is_full(tmp_path, monkeypatch):
    paths, _ = damage.files_of("cfbm", tmp_path)
    usage = type("", (), {"free": 10})()
    monkeypatch.setattr(write.shutil, "disk_usage", lambda folder: usage)
    with pytest.raises(InputError, match="needs 0 MB and the disk has"):
        in_process(paths, tmp_path / "out")


def test_a_missing_package_is_one_line(tmp_path, monkeypatch):
    paths, _ = damage.files_of("forefire", tmp_path)
    monkeypatch.setitem(sys.modules, "netCDF4", None)
    with pytest.raises(
        Error,
        match=re.escape(f"needs the Python package netCDF4; install it with: {extras.install('models')}"),
    ):
        in_process(paths, tmp_path / "out")


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (np.full((5, 5), -9999.0), "nothing burns"),
        (np.full((5, 5), np.nan), "nothing burns"),
        (np.full((5, 5), 1e300), "its times are invalid"),
    ],
)
def test_absurd_arrivals(tmp_path, values, reason):
    path = made.forefire(tmp_path / "a.nc", values)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(Error, match=reason):
            in_process([path], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_options_are_checked():
    from firetwin.run.models.model import Options

    for wrong in (("noon", ""), ("", "95,0"), ("", "a,b"), ("", "1")):
        with pytest.raises(UsageError):
            Options.of(*wrong, "", 0.0, [])


def test_nothing_foreign_is_parsed_where_a_run_is_opened(tmp_path, monkeypatch):
    """Blender itself looks at first bytes only."""
    paths, _ = damage.files_of("wrf", tmp_path)
    monkeypatch.setitem(sys.modules, "netCDF4", None)
    assert readers.foreign(paths[0])
    assert readers.foreign(tmp_path)
    with pytest.raises(InputError, match="firetwin convert"):
        readers.open(tmp_path)


def test_what_is_no_models_output_is_told_apart(tmp_path):
    """One line each, with the fault; a damaged file of a model is not reported as another kind."""
    arrival = np.hypot(*np.mgrid[-8:9, -8:9])
    (tmp_path / "empty").mkdir()
    (cut,) = made.wrf(tmp_path, times=(60,))[0]
    cut.write_bytes(cut.read_bytes()[:-5000])
    for name, data in (("zero.nc", b""), ("text.nc", b"words"), ("c.npz", b"words"), ("notes.txt", b"words")):
        (tmp_path / name).write_bytes(data)
    np.savez(tmp_path / "b.npz", other=arrival)
    made.lcp(tmp_path / "d.lcp", np.ones((3, 3, 8), np.int16))
    made.ascii_grid(tmp_path / "fire.asc", arrival)
    bad = made.ascii_grid(tmp_path / "x_arrival.asc", arrival)
    bad.write_text(bad.read_text().replace("-9999\n", "-9999\n1.0 abc ", 1))
    absurd = made.forefire(tmp_path / "a.nc", np.full((5, 5), -9999.0))

    def one(name, tell):
        files = readers.gathered([tmp_path / name])
        convert.in_process(files, tmp_path / "out", ["2020-07-01", "", "", 0.0], tell=tell)

    for name, words in {
        "empty": "folder without files", "zero.nc": "is empty", "text.nc": "does not begin as a .nc",
        "c.npz": "does not begin as a .npz", "notes.txt": "no known fire model: WRF-SFIRE",
        "b.npz": "no array time_of_arrival", "d.lcp": "a landscape without a fire",
        "fire.asc": "identified by name", "x_arrival.asc": "x_arrival.asc:7:5: 'abc' is not a number",
        cut.name: "as a netCDF file: NetCDF: HDF error; export", absurd.name: "nothing burns in it",
    }.items():  # fmt: skip
        told = []
        with pytest.raises(InputError, match=words) as caught:
            one(name, told.append)
        assert str(caught.value).startswith(str(tmp_path / name))
        assert not any("latitude, longitude and time" in text for text in told)
