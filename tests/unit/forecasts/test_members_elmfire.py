"""ELMFIRE's Monte Carlo cases as members: maps, lists of burned cells, and cases that are missing."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.forecasts.ensemble import statistics
from small_ensemble import convert

ASCII = "ncols 3\nnrows 2\nxllcorner 700000\nyllcorner 4300000\ncellsize 30\nNODATA_value -9999\n"
HEAD = "icase, Meteorology band, x, y, tstop (h)\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    pytest.importorskip("pyproj")
    cases = tmp_path / "cases"
    cases.mkdir()
    return cases


def arrival_map(folder: Path, case: int, seconds: int, rows: str) -> None:
    (folder / f"time_of_arrival_{case:07}_{seconds:07}.asc").write_text(ASCII + rows)


def burned_list(path: Path, cells: list[tuple[int, int, float]]) -> None:
    """Write (column, row from the south, s) as ELMFIRE does, with two more records behind them."""
    column, row, seconds = zip(*cells, strict=True)
    parts = [
        np.array(column, "<i2"),
        np.array(row, "<i2"),
        np.array(seconds, "<f4"),
        np.ones(len(cells), "<f4"),
    ]
    records = [np.int32(len(cells)).tobytes(), *(part.tobytes() for part in parts)]
    path.write_bytes(
        b"".join(np.int32(len(each)).tobytes() + each + np.int32(len(each)).tobytes() for each in records)
    )


def test_each_case_is_a_member_by_its_last_map(folder, tmp_path):
    arrival_map(folder, 1, 3600, "10 -9999 -9999\n-9999 -9999 -9999\n")
    arrival_map(folder, 1, 7200, "10 5000 -9999\n-9999 -9999 -9999\n")
    arrival_map(folder, 2, 7200, "10 -9999 -9999\n6000 -9999 -9999\n")
    arrival_map(folder, 3, 7200, "-9999 -9999 -9999\n-9999 -9999 -9999\n")
    (folder / "fire_size_stats.csv").write_text(
        HEAD + "".join(f"{case}, 1, 5.0, 6.0, 2\n" for case in (1, 2, 3, 4))
    )
    forecast, arrival, messages = convert(folder, tmp_path / "out")
    never = np.inf
    expected = [[[10, 5000, never], [never] * 3], [[10, never, never], [6000, never, never]]]
    np.testing.assert_array_equal(arrival, np.array(expected, np.float32))
    assert [each.reason for each in forecast.left_out] == [
        "nothing burns",
        "is in fire_size_stats.csv, and has no arrival times",
    ]
    assert forecast.horizon == 7200.0
    assert forecast.manifest.kind == "forecast"
    assert messages[0].startswith("2 of 4 members")


def test_a_case_ends_with_its_last_map(folder, tmp_path):
    """Case 1 was simulated for 3 h, and case 2 for 6 h: after 3 h only the latter counts."""
    arrival_map(folder, 1, 10800, "10 -9999 -9999\n-9999 -9999 -9999\n")
    arrival_map(folder, 2, 21600, "10 14400 -9999\n-9999 -9999 -9999\n")
    forecast, _, _ = convert(folder, tmp_path / "out")
    assert [member.end for member in forecast.members] == [10800.0, 21600.0]
    shares = statistics.shares(forecast, [10000.0, 20000.0])
    assert shares.counted.tolist() == [2, 1]
    assert shares.share[1].max() == 1.0


def test_lists_of_burned_cells_count_rows_from_the_south(folder, tmp_path):
    (folder / "fbfm40.asc").write_text(ASCII + "1 1 1\n1 1 1\n")
    burned_list(folder / "toa_0001_0000001.bin", [(1, 1, 60.0), (3, 2, 120.0)])
    burned_list(folder / "toa_0001_0000002.bin", [(2, 2, 30.0)])
    _, arrival, _ = convert(folder, tmp_path / "out")
    assert arrival[0, 1, 0] == 60.0
    assert arrival[0, 0, 2] == 120.0
    assert arrival[1, 0, 1] == 30.0
    assert np.isinf(arrival).sum() == 9


def test_maps_on_other_cells_are_refused(folder, tmp_path):
    for case in (1, 2):
        arrival_map(folder, case, 7200, "10 -9999 -9999\n-9999 -9999 -9999\n")
    moved = folder / "time_of_arrival_0000002_0007200.asc"
    moved.write_text(moved.read_text().replace("700000", "700001"))
    with pytest.raises(InputError, match=r"0000002_0007200.asc: has other cells than time_of_"):
        convert(folder, tmp_path / "out")


def test_a_cut_list_is_left_out(folder, tmp_path):
    (folder / "fbfm40.asc").write_text(ASCII + "1 1 1\n1 1 1\n")
    burned_list(folder / "toa_0001_0000001.bin", [(1, 1, 60.0)])
    burned_list(folder / "toa_0001_0000002.bin", [(2, 2, 30.0), (1, 2, 40.0)])
    whole = (folder / "toa_0001_0000002.bin").read_bytes()
    (folder / "toa_0001_0000002.bin").write_bytes(whole[:24])
    forecast, _, _ = convert(folder, tmp_path / "out")
    assert [each.name for each in forecast.left_out] == ["0000002"]
    assert "its records have other lengths" in forecast.left_out[0].reason


def test_other_starts_are_refused_and_other_ignitions_are_named(folder, tmp_path):
    for case in (1, 2):
        arrival_map(folder, case, 7200, "10 -9999 -9999\n-9999 -9999 -9999\n")
    table = folder / "fire_size_stats.csv"
    table.write_text(HEAD + "1, 1, 5.0, 6.0, 2\n2, 7, 5.0, 6.0, 2\n")
    with pytest.raises(InputError, match="begin at 2 weather bands, and members have one start"):
        convert(folder, tmp_path / "out")
    table.write_text(HEAD + "1, 1, 5.0, 6.0, 2\n2, 1, 5.0, 8.0, 2\n")
    assert convert(folder, tmp_path / "out").ensemble.manifest.kind == "ignitions"
    table.write_text(HEAD + "1, 1, five, 6.0, 2\n")
    with pytest.raises(InputError, match=r"stats.csv:2: has a case without the numbers"):
        convert(folder, tmp_path / "other")
