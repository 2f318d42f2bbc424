"""GridFire's simulations as members: lists of burned cells, ignitions, run times, and damaged files."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from small_ensemble import convert

pytest.importorskip("pyproj")
ASCII = "ncols 3\nnrows 2\nxllcorner 700000\nyllcorner 4300000\ncellsize 30\n1 1 1\n1 1 1\n"
HEAD = "simulation,ignition-row,ignition-col,max-runtime,temperature\n"
NEVER = np.inf


def burned_list(folder: Path, number: int, cells: list[tuple[int, int, float]]) -> Path:
    """Write (column, row from the south, s) as GridFire does, with the three layers behind the times."""
    column, row, seconds = zip(*cells, strict=True)
    parts = [np.array([len(cells)], ">i4"), np.array(column, ">i4"), np.array(row, ">i4")]
    parts += [np.array(seconds, ">f4"), np.ones(len(cells), ">f4"), np.ones(len(cells), ">f4")]
    path = folder / f"toa_0001_{number:05}.bin"
    path.write_bytes(b"".join(part.tobytes() for part in parts) + np.ones(len(cells), ">i4").tobytes())
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    outputs = tmp_path / "outputs"
    outputs.mkdir()
    (outputs / "dem.asc").write_text(ASCII)
    burned_list(outputs, 1, [(1, 1, 60.0), (3, 2, 120.0)])
    burned_list(outputs, 2, [(2, 2, 30.0)])
    return outputs


def test_rows_count_from_the_south(folder, tmp_path):
    forecast, arrival, messages = convert(folder, tmp_path / "out")
    expected = [[[NEVER, NEVER, 120], [60, NEVER, NEVER]], [[NEVER, 30, NEVER], [NEVER] * 3]]
    np.testing.assert_array_equal(arrival, np.array(expected, np.float32))
    assert forecast.manifest.kind == "forecast"
    assert forecast.horizon == 120.0
    assert any("which burn at time 0, are not known" in text for text in messages)


def test_ignitions_and_run_times_come_from_the_table(folder, tmp_path):
    table = folder / "summary_stats.csv"
    table.write_text(HEAD + "1,1,1,60,80\n2,1,1,30,80\n3,1,1,60,80\n")
    forecast, arrival, _ = convert(folder, tmp_path / "out")
    assert arrival[0, 1, 1] == arrival[1, 1, 1] == 0.0
    assert [member.end for member in forecast.members] == [3600.0, 1800.0]
    assert forecast.horizon == 3600.0
    assert forecast.left_out[0].reason == "is in summary_stats.csv, and has no arrival times"
    table.write_text(HEAD + "1,1,1,60,80\n2,0,1,60,80\n")
    assert convert(folder, tmp_path / "moved").ensemble.manifest.kind == "ignitions"
    table.write_text(HEAD + "1,1,1,60,80\n2,0,,60,80\n")
    with pytest.raises(InputError, match=r"summary_stats.csv:3: has no numbers simulation, ignition-row"):
        convert(folder, tmp_path / "other")


def test_a_number_in_two_folders_is_refused(folder, tmp_path):
    (tmp_path / "more").mkdir()
    other = burned_list(tmp_path / "more", 2, [(1, 1, 60.0)])
    with pytest.raises(InputError, match=rf"{other.name}: is the same member as .*outputs"):
        convert([folder, other.parent], tmp_path / "out")


def test_damaged_lists_are_left_out(folder, tmp_path):
    path = burned_list(folder, 3, [(1, 1, 60.0)])
    path.write_bytes(path.read_bytes()[:12])
    burned_list(folder, 4, [(4, 1, 60.0)])
    burned_list(folder, 5, [(1, 1, -60.0)])
    forecast, _, _ = convert(folder, tmp_path / "out")
    reasons = [each.reason for each in forecast.left_out]
    assert "too few for its cells" in reasons[0]
    assert "has cell (4, 1) where the raster has 3 x 2" in reasons[1]
    assert "negative or not numbers" in reasons[2]
    (folder / "dem.asc").unlink()
    with pytest.raises(InputError, match="give a raster of the inputs too"):
        convert(folder, tmp_path / "other")
