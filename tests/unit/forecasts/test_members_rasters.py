"""Rasters of arrival times as members: FARSITE's simulations, ranks of fire size, and their units."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.run import readers
from firetwin.run.models import probability_maps
from small_ensemble import convert

pytest.importorskip("pyproj")
ASCII = "ncols 2\nnrows 2\nxllcorner {x}\nyllcorner 4300000\ncellsize 30\nNODATA_value -9999\n"
NEVER = np.inf


def grid(path: Path, rows: str, x: float = 700000) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(ASCII.format(x=x) + rows)
    return path


def test_rasters_of_farsite_are_in_minutes(tmp_path):
    folder = tmp_path / "farsite"
    grid(folder / "dry_ArrivalTime.asc", "1 2\n-9999 4\n")
    grid(folder / "wet_Arrival Time.asc", "1 -9999\n-9999 -9999\n")
    grid(folder / "no_ArrivalTime.asc", "-9999 -9999\n-9999 -9999\n")
    grid(folder / "bad_ArrivalTime.asc", "1 two\n3 4\n")
    forecast, arrival, _ = convert(folder, tmp_path / "out")
    assert [member.name for member in forecast.members] == ["dry", "wet"]
    np.testing.assert_array_equal(arrival, [[[60, 120], [NEVER, 240]], [[60, NEVER], [NEVER, NEVER]]])
    assert [each.name for each in forecast.left_out] == ["bad", "no"]
    assert forecast.horizon == 240.0
    grid(folder / "moved_ArrivalTime.asc", "1 2\n3 4\n", x=700001)
    with pytest.raises(InputError, match=r"moved_ArrivalTime.asc: has other cells than dry_Arr"):
        convert(folder, tmp_path / "other")


def test_members_need_one_coordinate_system(tmp_path):
    """Equal numbers in two zones of UTM are 520 km apart; two spellings of one zone are one grid."""
    import pyproj

    folder = tmp_path / "farsite"
    for name, zone in (("dry", 32610), ("wet", 32611)):
        path = grid(folder / f"{name}_ArrivalTime.asc", "1 2\n-9999 4\n")
        path.with_suffix(".prj").write_text(pyproj.CRS.from_epsg(zone).to_wkt("WKT1_ESRI"))
    with pytest.raises(InputError, match=r"wet_ArrivalTime.asc: has another coordinate system than dry_Arr"):
        convert(folder, tmp_path / "out", projection="")
    path.with_suffix(".prj").write_text(pyproj.CRS.from_epsg(32610).to_wkt())
    assert len(convert(folder, tmp_path / "out", projection="").arrival) == 2


def test_members_with_other_ignitions_are_not_a_forecast(tmp_path):
    """Fires that begin 600 m apart, in cells of 30 m; 30 m apart they are one fire."""
    for name, first, second, kind in (("far", 0, 20, "ignitions"), ("near", 0, 1, "forecast")):
        folder = tmp_path / name
        for member, at in (("dry", first), ("wet", second)):
            row = " ".join("1" if column == at else "-9999" for column in range(24))
            path = grid(folder / f"{member}_ArrivalTime.asc", f"{row}\n{row}\n")
            path.write_text(path.read_text().replace("ncols 2", "ncols 24"))
        forecast, _, messages = convert(folder, tmp_path / f"{name}_out")
        assert forecast.manifest.kind == kind
        told = [text for text in messages if "the members begin up to 0.6 km apart" in text]
        assert len(told) == (kind == "ignitions")


def test_ranks_are_in_hours_and_are_not_a_forecast(tmp_path):
    folder = tmp_path / "ky-town_20231105_191700"
    grid(folder / "time-of-arrival_10.asc", "0 0\n0 0.5\n")
    grid(folder / "time-of-arrival_90.asc", "0 2\n1 0.5\n")
    forecast, arrival, _ = convert(folder, tmp_path / "out", "")
    assert forecast.manifest.kind == "ranked"
    assert [member.name for member in forecast.members] == ["size percentile 10", "size percentile 90"]
    np.testing.assert_array_equal(arrival, [[[NEVER, NEVER], [NEVER, 1800]], [[NEVER, 7200], [3600, 1800]]])
    assert f"{forecast.issued:%F %T}" == "2023-11-05 19:17:00"
    grid(folder / "time-of-arrival_05.asc", "0 two\n0 0.5\n")
    forecast, _, _ = convert(folder, tmp_path / "damaged", "")
    assert [each.name for each in forecast.left_out] == ["size percentile 05"]
    assert len(forecast.members) == 2
    other = tmp_path / "20231105_191700" / "elmfire" / "landfire"
    for name in ("10", "90"):
        grid(other / name / "time-of-arrival.asc", "0 0\n0 0.5\n")
    assert len(convert(other, tmp_path / "pyrecast").ensemble.members) == 2


def test_a_name_in_two_folders_is_refused(tmp_path):
    folders = [grid(tmp_path / name / "dry_ArrivalTime.asc", "1 2\n3 4\n").parent for name in "ab"]
    with pytest.raises(InputError, match=r"b.dry_ArrivalTime.asc: is the same member as .*a.dry_Arr"):
        convert(folders, tmp_path / "out")


@pytest.mark.parametrize("name", ["min_arrival_time_60", "time-of-arrival_50"])
def test_other_arrival_maps_are_not_farsite_minutes(tmp_path, name):
    """A run of seconds or hours read as minutes would burn at a wrong pace."""
    path = grid(tmp_path / f"{name}.asc", "1 2\n3 4\n")
    with pytest.raises(InputError, match="no fire can burn from it"):
        readers.reader([path])


def test_the_name_of_flammap_alone_is_not_a_probability():
    assert probability_maps.refusal(Path("FlamMap_Arrival Time.asc")) is None
    assert probability_maps.refusal(Path("FlamMap_BurnProbability.tif"))
