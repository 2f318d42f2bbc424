"""Sets of WRF-SFIRE in one file, and a folder for each member: arrival times, early ends and refusals."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts.ensemble import statistics
from small_ensemble import convert

netcdf = pytest.importorskip("netCDF4")
NEVER = np.inf


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
    forecast, _, messages = convert(tmp_path / "set.nc", tmp_path / "out")
    assert [member.name for member in forecast.members] == ["ens_000", "ens_001", "ens_002"]
    assert [member.end for member in forecast.members] == [7200.0, 3600.0, 7200.0]
    assert forecast.arrival(0)[0].tolist() == [1800.0, NEVER]  # half a cell, half-way between two times
    assert forecast.arrival(2)[1].tolist() == [NEVER, 5400.0]
    shares = statistics.shares(forecast, [3600.0, 7200.0])
    assert shares.counted.tolist() == [3, 2]
    assert shares.share[:, 0, 0].tolist() == [pytest.approx(2 / 3), 0.5]
    assert messages[0] == "3 of 3 members, up to 2 h after 2014-09-17 05:00 UTC"


def test_sets_without_sense_are_refused(tmp_path):
    area = np.zeros((2, 3, 2, 2), np.float32)
    area[:, 1:, 0, 0] = 1.0
    area[0, 1] = np.nan
    write_set(tmp_path / "gap.nc", area)
    forecast, _, _ = convert(tmp_path / "gap.nc", tmp_path / "out")
    assert [each.reason for each in forecast.left_out] == ["has values again after a gap at time 2"]
    write_set(tmp_path / "nothing.nc", np.zeros((2, 3, 2, 2), np.float32))
    with pytest.raises(InputError, match="no member has arrival times; ens_000: nothing burns"):
        convert(tmp_path / "nothing.nc", tmp_path / "other")


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
    forecast, arrival, _ = convert(tmp_path / "all", tmp_path / "out")
    assert [member.name for member in forecast.members] == ["a", "b"]
    assert forecast.left_out[0].name == "c"
    assert "'x' is not a number" in forecast.left_out[0].reason
    assert (arrival[0] / 60.0).tolist() == [[0, 10, 20], [5, 15, NEVER]]
    assert forecast.horizon >= 50 * 60.0
    write_grid(tmp_path / "all" / "d", "0 20 40\n10 30 50\n", corner=700015.0)
    with pytest.raises(InputError, match="d: has other cells than a; convert each folder to a run"):
        convert(tmp_path / "all", tmp_path / "more")
