"""Folders of QUIC-Fire as members: cells, times, place, and folders that differ or are damaged."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from small_ensemble import convert

pytest.importorskip("pyproj")
GRID = """!QUIC 6.26
3 !nx - Domain Length(X) Grid Cells
2 !ny - Domain Width(Y) Grid Cells
25 ! NZ - domain height(Z) grid cells
2 ! DX [m]
2 ! DY [m]
{turn} ! Domain rotation relative to true north [degrees] (cw = +)
{x} ! UTMX of domain origin [m]
4300000.0 ! UTMY of domain origin [m]
10 ! UTM zone
19 ! UTM zone leter (1 = A, 2 = B, etc.)
"""
FIRE = """1 ! Fire flag
! FIRE TIMES
{begun}		! When the fire is ignited in Unix Epoch time
600 ! Total simulation time
"""


def simulation(path: Path, *masses: tuple[int, list], begun=1653321600, x=700000.0, turn=0) -> Path:
    """Write a folder: (seconds, per cent (2, 3) with rows from the south) for each output."""
    (path / "Output").mkdir(parents=True)
    (path / "QU_simparams.inp").write_text(GRID.format(x=x, turn=turn))
    (path / "QUIC_fire.inp").write_text(FIRE.format(begun=begun))
    for seconds, values in masses:
        data, size = np.array(values, "<f4").tobytes(), np.array(24, "<i4").tobytes()
        (path / "Output" / f"mburnt_integ-{seconds:05}.bin").write_bytes(size + data + size)
    return path


NONE = [[0, 0, 0], [0, 0, 0]]
SOUTH = [[30, 0, 0], [0, 0, 0]]
BOTH = [[90, 0, 0], [0, 0, 2]]


def test_each_folder_is_a_member(tmp_path):
    simulation(tmp_path / "set" / "01", (0, NONE), (60, SOUTH), (120, BOTH))
    simulation(tmp_path / "set" / "02", (0, NONE), (60, SOUTH))
    simulation(tmp_path / "set" / "03", (0, NONE), (60, NONE))
    forecast, arrival, _ = convert(tmp_path / "set", tmp_path / "out", "", projection="")
    never = np.inf
    expected = [[[30, never, never], [never, never, 90]], [[30, never, never], [never] * 3]]
    np.testing.assert_array_equal(arrival[:, ::-1], np.array(expected, np.float32))
    assert [member.end for member in forecast.members] == [120.0, 60.0]
    assert forecast.left_out[0].reason == "nothing burns"
    assert forecast.horizon == 120.0
    assert f"{forecast.issued:%F %H:%M}" == "2022-05-23 16:00"
    from pyproj import Transformer

    x, y = Transformer.from_crs(4326, 32610, always_xy=True).transform(
        forecast.longitude[0], forecast.latitude.min()
    )
    assert (x, y) == pytest.approx((700001.0, 4300001.0), abs=0.5)


def test_members_need_one_start_and_one_grid(tmp_path):
    simulation(tmp_path / "set" / "01", (60, SOUTH))
    simulation(tmp_path / "set" / "02", (60, SOUTH), begun=1653325200)
    with pytest.raises(InputError, match=r"02: begins \+1.00 h from 01; members have one start"):
        convert(tmp_path / "set", tmp_path / "out", "", projection="")
    simulation(tmp_path / "moved" / "01", (60, SOUTH))
    simulation(tmp_path / "moved" / "02", (60, SOUTH), x=700001.0)
    with pytest.raises(InputError, match="02: has other cells than 01"):
        convert(tmp_path / "moved", tmp_path / "out", "", projection="")


def test_damaged_folders_are_left_out(tmp_path):
    simulation(tmp_path / "set" / "01", (60, SOUTH))
    (simulation(tmp_path / "set" / "02", (60, SOUTH)) / "Output/mburnt_integ-00060.bin").write_bytes(b"x")
    simulation(tmp_path / "set" / "03", (60, [[-1, 0, 0], [0, 0, 0]]))
    simulation(tmp_path / "set" / "04", (60, SOUTH), turn=10)
    (simulation(tmp_path / "set" / "05", (60, SOUTH)) / "QU_simparams.inp").write_text("!QUIC 6.26\n3\n")
    simulation(tmp_path / "set" / "06", (60, SOUTH), begun="soon")
    forecast, _, _ = convert(tmp_path / "set", tmp_path / "out", "", projection="")
    assert [member.name for member in forecast.members] == ["01"]
    reasons = [each.reason for each in forecast.left_out]
    assert "holds 1 bytes, not a record of 2 x 3 cells" in reasons[0]
    assert "outside of 0 to 100 per cent" in reasons[1]
    assert "is turned by 10 degrees" in reasons[2]
    assert "has no number where QUIC-Fire has one" in reasons[3]
    assert "has no number where QUIC-Fire has one" in reasons[4]


def test_a_grid_without_a_place_takes_the_option(tmp_path):
    folder = simulation(tmp_path / "set" / "01", (60, SOUTH))
    text = (folder / "QU_simparams.inp").read_text().replace("4300000.0", "0").replace("700000.0", "0")
    (folder / "QU_simparams.inp").write_text(text)
    forecast, _, _ = convert(tmp_path / "set", tmp_path / "out", "", "38.5,-120.5", "")
    assert forecast.latitude.mean() == pytest.approx(38.5, abs=1e-6)
    assert forecast.longitude.mean() == pytest.approx(-120.5, abs=1e-6)
