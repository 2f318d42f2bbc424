"""Sets of WRF-SFIRE in one file, and a folder for each member: arrival times, early ends and refusals."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts import convert as members_convert
from firetwin.forecasts.ensemble import ensemble, statistics

netcdf = pytest.importorskip("netCDF4")
NEVER = np.inf
OPTIONS = ["2014-09-17T04:45Z", "", "", 0.0, "", ""]


def run(folder: Path, out: Path) -> tuple[ensemble.Ensemble, list[str]]:
    said: list[str] = []
    members_convert.in_process([folder], out, OPTIONS, tell=said.append)
    return ensemble.open(out), said


def write_set(path: Path, area: np.ndarray, units: str = "hours since 2014-09-17 05:00:00") -> None:
    with netcdf.Dataset(path, "w") as data:
        names = ("ens", "Time", "south_north_subgrid", "west_east_subgrid")
        for name, size in zip(names, area.shape, strict=True):
            data.createDimension(name, size)
        data.createVariable("FIRE_AREA", "f4", names)[:] = area
        east, north = (1e-3 * np.arange(size) for size in area.shape[:1:-1])
        longitude, latitude = np.meshgrid(-120.6 + east, 38.9 + north)
        data.createVariable("FXLONG", "f8", names[2:])[:] = longitude
        data.createVariable("FXLAT", "f8", names[2:])[:] = latitude
        labels = data.createVariable("ens", str, ("ens",))
        for index in range(area.shape[0]):
            labels[index] = f"ens_{index:03}"
        time = data.createVariable("Time", "f8", ("Time",))
        time.units = units
        time[:] = np.arange(area.shape[1])


def test_padding_is_no_unburned_cell(tmp_path):
    """The second member ends after an hour, and does not count later."""
    area = np.zeros((3, 3, 2, 2), np.float32)
    area[0, 1:, 0, 0] = 1.0
    area[1, 1, 0, 0] = 1.0
    area[1, 2] = np.nan
    area[2, 2, 1, 1] = 1.0
    write_set(tmp_path / "set.nc", area)
    made, said = run(tmp_path / "set.nc", tmp_path / "out")
    assert [member.name for member in made.members] == ["ens_000", "ens_001", "ens_002"]
    assert [member.end for member in made.members] == [7200.0, 3600.0, 7200.0]
    assert made.arrival(0)[0].tolist() == [1800.0, NEVER]  # half a cell, half-way between two times
    assert made.arrival(2)[1].tolist() == [NEVER, 5400.0]
    found = statistics.shares(made, [3600.0, 7200.0])
    assert found.counted.tolist() == [3, 2]
    assert found.share[:, 0, 0].tolist() == [pytest.approx(2 / 3), 0.5]
    assert said[0] == "3 of 3 members, up to 2 h after 2014-09-17 05:00 UTC"


def test_sets_without_sense_are_refused(tmp_path):
    area = np.zeros((2, 3, 2, 2), np.float32)
    area[:, 1:, 0, 0] = 1.0
    area[0, 1] = np.nan
    write_set(tmp_path / "gap.nc", area)
    made, _ = run(tmp_path / "gap.nc", tmp_path / "out")
    assert [each.reason for each in made.left_out] == ["has values again after a gap at time 2"]
    write_set(tmp_path / "nothing.nc", np.zeros((2, 3, 2, 2), np.float32))
    with pytest.raises(InputError, match="no member has arrival times; ens_000: nothing burns"):
        run(tmp_path / "nothing.nc", tmp_path / "other")


def write_grid(folder: Path, values: str, corner: float = 700000.0) -> None:
    """Write FlamMap's arrival times (min)."""
    folder.mkdir(parents=True)
    head = f"ncols 3\nnrows 2\nxllcorner {corner}\nyllcorner 4300000\ncellsize 30\nNODATA_value -9999\n"
    (folder / "FIRE_Arrival Time.asc").write_text(head + values)


def test_a_folder_for_each_member(tmp_path):
    pytest.importorskip("pyproj")
    write_grid(tmp_path / "all" / "a", "0 10 20\n5 15 -9999\n")
    write_grid(tmp_path / "all" / "b", "0 20 40\n10 30 50\n")
    write_grid(tmp_path / "all" / "c", "0 20 x\n10 30 50\n")
    options = [*OPTIONS[:2], "EPSG:32610", *OPTIONS[3:]]
    said: list[str] = []
    members_convert.in_process([tmp_path / "all"], tmp_path / "out", options, tell=said.append)
    made = ensemble.open(tmp_path / "out")
    assert [member.name for member in made.members] == ["a", "b"]
    assert made.left_out[0].name == "c"
    assert "'x' is not a number" in made.left_out[0].reason
    rows = slice(None, None, -1) if made.latitude[0] < made.latitude[-1] else slice(None)
    assert (made.arrival(0)[rows] / 60.0).tolist() == [[0, 10, 20], [5, 15, NEVER]]
    assert made.horizon >= 50 * 60.0
    write_grid(tmp_path / "all" / "d", "0 20 40\n10 30 50\n", corner=700015.0)
    with pytest.raises(InputError, match="d: has other cells than a; convert each folder to a run"):
        members_convert.in_process([tmp_path / "all"], tmp_path / "more", options)
