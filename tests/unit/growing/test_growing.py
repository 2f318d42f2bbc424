"""Growing runs: complete times are converted once, incomplete ones wait, and a restart keeps the old run."""

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import growing_model
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.growing import acceptance, model_log, revision, states, watch, watched
from firetwin.run import readers

pytest.importorskip("netCDF4")
KINDS = ("netcdf3", "netcdf4", "zarr")
NAMES = {"netcdf3": "fire.nc", "netcdf4": "fire.nc", "zarr": "fire.zarr"}
BEGIN = datetime(2020, 7, 1, 20, tzinfo=UTC)


@pytest.fixture
def in_process(monkeypatch):
    """Run steps in this process; tests/system starts workers."""
    monkeypatch.setenv("HDF5_USE_FILE_LOCKING", "FALSE")
    monkeypatch.setattr(watch.worker, "run", lambda work, **_: work())


class Watched:
    """A model and its watch, poll by poll."""

    def __init__(self, folder: Path, kind: str, **options) -> None:
        pytest.importorskip("zarr" if kind == "zarr" else "netCDF4")
        self.source, self.out, self.kind = folder / "model", folder / "DIR", kind
        self.source.mkdir()
        self.said = []
        self.path = self.source / NAMES[kind]
        self.model = growing_model.Writer(self.path, kind)
        self.watch = watch.Watch(watch.WatchRequest(self.source, self.out, **options), self.said.append)

    def poll(self, times=1) -> str:
        for _ in range(times):
            self.watch.poll()
        return self.watch.state

    def accepted(self) -> list[tuple[float, str]]:
        return [(each.seconds, each.complete) for each in watched.times(self.out)]


@pytest.mark.parametrize("kind", KINDS)
def test_a_time_is_read_when_the_next_one_exists_or_its_file_rests(in_process, tmp_path, kind):
    run = Watched(tmp_path, kind)
    assert run.poll() == "waiting"
    run.model.append()
    assert (run.poll(), run.accepted()) == ("waiting", [])
    run.model.append()
    assert (run.poll(), run.accepted()) == ("running", [(0.0, "next")])
    assert run.poll() == "running"
    assert run.accepted() == [(0.0, "next"), (600.0, "guessed")]
    assert "guessed complete" in run.said[-1]
    run.model.close()
    found = readers.open(run.out)
    assert list(found.times) == [0.0, 600.0]
    for index in range(2):
        np.testing.assert_array_equal(found.heat_flux(index), growing_model.flux(index))
    page = (run.out / watched.PAGE).read_text()
    assert "running" in page
    assert "2020-07-01 20:10:00 UTC" in page


@pytest.mark.parametrize("kind", KINDS)
def test_values_that_change_begin_a_generation_and_the_old_run_stays(in_process, tmp_path, kind):
    run = Watched(tmp_path, kind)
    for _ in range(3):
        run.model.append()
    run.poll(2)
    run.model.close()
    run.model = growing_model.Writer(run.path, kind)
    run.model.append(0.5)
    run.poll()  # times go back
    run.model.append(0.5)
    assert run.poll() == "restarted"
    run.poll()
    run.model.append(0.5)
    assert run.poll() == "running"
    run.model.close()
    found = watched.times(run.out)
    assert [each.generation for each in found] == [1, 1, 1, 2, 2]
    np.testing.assert_array_equal(readers.open(run.out).heat_flux(1), growing_model.flux(1, 0.5))
    old = readers.open(watched.revision_folder(run.out, 1, 3))
    np.testing.assert_array_equal(old.heat_flux(2), growing_model.flux(2))
    assert json.loads((run.out / watched.STATUS).read_text())["generation"] == 2


@pytest.mark.parametrize("kind", ["netcdf3", "netcdf4"])
def test_a_file_that_is_cut_short_gives_no_time(in_process, tmp_path, kind):
    """Such a file of netCDF-3 opens, and its library returns zeros."""
    run = Watched(tmp_path, kind)
    for _ in range(3):
        run.model.append()
    run.model.close()
    whole = run.path.read_bytes()
    run.path.write_bytes(whole[: int(0.7 * len(whole))])
    assert run.poll(3) == "waiting"
    assert not run.accepted()
    assert "not readable yet" in run.said[-1] or "not readable yet" in run.said[0]
    run.path.write_bytes(whole)
    run.poll(2)
    assert len(run.accepted()) == 3


def test_a_time_whose_values_are_not_written_waits(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf4")
    run.model.append()
    run.model.append()
    run.model.data["time"][2] = 1200.0  # a later time, without its values
    run.model.data["time"][3] = 1800.0
    run.model.data.sync()
    run.poll(3)
    assert [seconds for seconds, _ in run.accepted()] == [0.0, 600.0]
    run.model.close()


def test_a_watch_continues_after_it_was_killed(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf3")
    for _ in range(2):
        run.model.append()
    run.poll(2)
    left = watched.revision_folder(run.out, 1, 3)  # a revision that was published, but not listed
    left.mkdir()
    (left.parent / ".000004.0123456789ab.part").mkdir()
    run.model.append()
    run.model.close()
    run.watch = watch.Watch(run.watch.request, run.said.append)
    run.poll(2)
    assert [seconds for seconds, _ in run.accepted()] == [0.0, 600.0, 1200.0]
    assert len(readers.open(run.out).times) == 3
    assert not list(left.parent.glob(".*"))


def test_two_watches_do_not_write_one_folder(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf3")
    run.model.append()
    run.poll(2)
    run.model.close()
    before = watched.times(run.out)
    with pytest.raises(InputError, match="another watch"):
        watched.append(run.out, [], before)


def test_the_log_of_wrf_names_complete_times(tmp_path):
    log = tmp_path / model_log.NAME
    line = "Timing for Writing wrfout_d01_2020-07-01_20:0{}:00 for domain        1:    0.2 elapsed seconds\n"
    log.write_text(line.format(0) + line.format(1))
    found = model_log.read(tmp_path)
    assert found.written == {"wrfout_d01_2020-07-01_20:00:00": 1, "wrfout_d01_2020-07-01_20:01:00": 1}
    assert not found.succeeded
    log.write_text(log.read_text() + "d01 2020-07-01_21:00:00 wrf: SUCCESS COMPLETE WRF\n")
    assert model_log.read(tmp_path).succeeded
    log.write_text(
        "-------------- FATAL CALLED ---------------\nFATAL CALLED FROM FILE:  <stdin>  LINE: 419\n"
    )
    assert "LINE: 419" in model_log.read(tmp_path).failure
    assert model_log.read(tmp_path / "missing") == model_log.ModelLog()


def test_reasons_stop_at_the_first_incomplete_time():
    path, other = Path("wrfout_a"), Path("wrfout_b")
    listed = [acceptance.Listed(BEGIN + timedelta(minutes=k), path, k) for k in range(3)]
    assert acceptance.reasons(listed, {}, [], False) == ["next", "next", ""]
    assert acceptance.reasons(listed, {"wrfout_a": 3}, [], False) == ["log"] * 3
    assert acceptance.reasons(listed, {}, ["wrfout_a"], False) == ["next", "next", "guessed"]
    assert acceptance.reasons(listed, {}, [], True) == ["next", "next", "end"]
    later = [*listed, acceptance.Listed(BEGIN + timedelta(minutes=3), other, 0)]
    assert acceptance.reasons(later, {}, [], False) == ["next", "next", "next", ""]


def test_states():
    plain = {"ended": False, "failed": False, "restarted": False}
    assert states.state([], 100.0, 5.0, **plain) == "waiting"
    assert states.state([0.0, 60.0, 120.0], 290.0, 5.0, **plain) == "running"
    assert states.state([0.0, 60.0, 120.0], 301.0, 5.0, **plain) == "stalled"
    assert states.state([0.0, 0.1, 0.2], 1000.0, 5.0, **plain) == "running"  # one poll read all of them
    assert states.state([0.0], 1.0, 5.0, **plain | {"restarted": True}) == "restarted"
    assert states.state([0.0], 1.0, 5.0, **plain | {"ended": True}) == "ended"
    assert states.state([0.0], 1.0, 5.0, **plain | {"ended": True, "failed": True}) == "failed"


def test_a_run_ends_at_a_stated_time_or_when_its_files_rest(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf3", end=BEGIN + timedelta(seconds=600))
    run.model.append()
    run.model.append()
    assert (run.poll(), run.poll()) == ("running", "ended")
    run.model.close()
    run.watch = watch.Watch(watch.WatchRequest(run.source, tmp_path / "two", idle=1e-6), run.said.append)
    assert run.poll(2) == "ended"
    assert [each.complete for each in watched.times(tmp_path / "two")] == ["next", "end"]


def test_wrf_files_become_the_run_that_a_conversion_makes(in_process, tmp_path):
    """One file per time; the log names complete ones, and says that the model has ended."""
    import model_files
    from firetwin.jobs import convert

    made, source = tmp_path / "made", tmp_path / "model"
    made.mkdir()
    source.mkdir()
    files, _ = model_files.wrf(made, times=(60, 120, 180), per_file=1)
    said, arrivals = [], []
    look = watch.Watch(watch.WatchRequest(source, tmp_path / "DIR", name="Fire"), said.append)
    log = source / model_log.NAME
    log.write_text("")
    for done, path in enumerate(files, start=1):
        (source / path.name).write_bytes(path.read_bytes())
        look.poll()
        assert len(watched.times(tmp_path / "DIR")) == done - 1
        with log.open("a") as file:
            file.write(f"Timing for Writing {path.name} for domain        1:    0.2 elapsed seconds\n")
        look.poll()
        assert watched.times(tmp_path / "DIR")[-1].complete == "log"
        assert len(watched.times(tmp_path / "DIR")) == done
        arrivals.append(readers.open(tmp_path / "DIR").fuel_arrival_time())
    with log.open("a") as file:
        file.write("wrf: SUCCESS COMPLETE WRF\n")
    look.poll()
    assert look.state == "ended"
    convert.in_process(list(files), tmp_path / "whole", ["", "", "", 0.0, "Fire", ""])
    grown, whole = readers.open(tmp_path / "DIR"), readers.open(tmp_path / "whole")
    assert (grown.start, list(grown.times)) == (whole.start, list(whole.times))
    np.testing.assert_array_equal(grown.fuel_arrival_time(), whole.fuel_arrival_time())
    for time, arrival in zip(whole.times, arrivals, strict=True):
        later = whole.fuel_arrival_time() > time
        np.testing.assert_array_equal(arrival, np.where(later, np.nan, whole.fuel_arrival_time()))
    np.testing.assert_array_equal(grown.surface_fuel, whole.surface_fuel)
    for index in range(3):
        np.testing.assert_array_equal(grown.heat_flux(index), whole.heat_flux(index))
    assert {*whole.fields} - {*grown.fields} <= {each for each in whole.fields if each.endswith("_3d")}


def test_a_model_that_fails_ends_the_watch(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf3")
    for _ in range(2):
        run.model.append()
    run.poll()
    run.model.close()
    (run.source / model_log.NAME).write_text("FATAL CALLED FROM FILE:  <stdin>  LINE: 419\n")
    assert run.poll() == "failed"
    assert "LINE: 419" in json.loads((run.out / watched.STATUS).read_text())["message"]


def test_zarr_metadata_before_its_chunks_is_no_time(in_process, tmp_path):
    run = Watched(tmp_path, "zarr")
    for _ in range(2):
        run.model.append()
    run.model.data["heat_flux"].resize((4, growing_model.CELLS, growing_model.CELLS))
    run.model.data["time"].resize((4,))
    run.model.data["time"][2:] = [1200.0, 1800.0]
    run.poll(3)
    assert [seconds for seconds, _ in run.accepted()] == [0.0, 600.0]


def test_pages_warn_that_the_model_had_not_ended(tmp_path):
    run = watched.revision_folder(tmp_path, 1, 13)
    times = "2014-09-17T10:00:00+00:00", "2014-09-17T11:30:00+00:00"
    watched.append(
        tmp_path, [], [watched.Accepted(1, 13, times[0], 0.0, "fire.nc", 12, "next", "", times[1])]
    )
    (tmp_path / watched.STATUS).write_text('{"state": "stalled"}')
    ((head, text),) = readers.folder.warnings(run, "Etc/GMT+8")
    assert head == "The model had not ended"
    assert "state: stalled" in text
    assert "17 Sep 2014 02:00:00 -08, read at 17 Sep 2014 03:30:00 -08" in text
    (tmp_path / watched.STATUS).write_text('{"state": "ended"}')
    assert readers.folder.warnings(run, "UTC") == []
    assert readers.folder.warnings(tmp_path / "other", "UTC") == []


def test_a_folder_behind_a_link_is_never_touched(in_process, tmp_path):
    mine, run = tmp_path / "mine", Watched(tmp_path, "netcdf3")
    for number in range(1, 5):
        (mine / f"{number:06d}").mkdir(parents=True)
        (mine / f"{number:06d}" / "mine.npy").write_text("mine")
    before = sorted(mine.rglob("*"))
    run.out.mkdir()
    (run.out / "generation_1").symlink_to(mine)
    with pytest.raises(InputError, match="generation_1: is a link"):
        watch.Watch(run.watch.request, run.said.append)
    for _ in range(5):  # the link was made after the check
        run.model.append()
    run.poll(3)
    assert any("generation_1: is a link" in line for line in run.said)
    revision.remove_old(run.out, 1)
    revision.remove_parts(run.out)
    assert sorted(mine.rglob("*")) == before


@pytest.mark.parametrize("name", [watched.STATUS, watched.TIMES, watched.PAGE, "notes.txt"])
def test_a_folder_of_others_is_no_watched_folder(tmp_path, name):
    (tmp_path / "DIR").mkdir()
    (tmp_path / "DIR" / name).write_text('{"state": "mine"}')
    with pytest.raises(InputError, match="did not write"):
        Watched(tmp_path, "netcdf3")
    assert (tmp_path / "DIR" / name).read_text() == '{"state": "mine"}'


def test_files_of_others_in_a_revision_stay(in_process, tmp_path):
    run = Watched(tmp_path, "netcdf3")
    for _ in range(2):
        run.model.append()
    run.poll(2)
    kept = watched.revision_folder(run.out, 1, 2) / "notes.txt"
    kept.write_text("mine")
    for _ in range(6):
        run.model.append()
        run.poll(2)
    assert kept.read_text() == "mine"
    assert [path.name for path in kept.parent.iterdir()] == ["notes.txt"]


FORGED = {
    "generation": ("1/../../x", 0, -1, True, 1.5),
    "revision": ("../x", 0, None),
    "seconds": ("0", float("nan"), float("inf")),
    "time": ("", "2020-07-01", "9999-12-31T23:59:59-12:00", 7),
    "source": (7, None),
    "accepted": ("yesterday", 7),
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name in FORGED for value in FORGED[name]])
def test_forged_times_are_refused(tmp_path, name, value):
    """Their numbers become names of folders."""
    entry = {
        "generation": 1, "revision": 1, "time": "2020-07-01T20:00:00+00:00", "seconds": 0.0, "source": "a.nc",
        "index": 0, "complete": "log", "sha256": "0", "accepted": "2026-07-01T20:00:00+00:00",
    }  # fmt: skip
    (tmp_path / watched.TIMES).write_text(json.dumps([entry]))
    assert watched.newest(tmp_path) == tmp_path / "generation_1" / "000001"
    (tmp_path / watched.TIMES).write_text(json.dumps([entry | {name: value}]))
    with pytest.raises(InputError, match=r"times\.json: cannot be read"):
        watched.newest(tmp_path)
