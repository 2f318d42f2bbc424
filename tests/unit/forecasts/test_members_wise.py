"""Scenarios of W.I.S.E. in KML as members: names, times, cells and damaged files."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from small_ensemble import convert

pytest.importorskip("shapely")
PLACEMARK = """<Placemark><TimeSpan><begin>{time}</begin>{end}</TimeSpan><name>Polygon</name><ExtendedData>
<SchemaData><SimpleData name="SCENARIO">{name}</SimpleData></SchemaData></ExtendedData>
<Polygon><outerBoundaryIs><LinearRing><coordinates>{ring}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"""


def square(half: float) -> str:
    """Ring of a square about 63 N, 116 W; half its side in degrees of latitude."""
    wide = half / np.cos(np.radians(63.0))
    corners = (-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)
    return " ".join(f"{-116 + x * wide},{63 + y * half},0" for x, y in corners)


def scenario(path: Path, name: str, *halves: float, hour: str = "{hour:02}:00:00-06:00") -> None:
    """Write a scenario whose square grows each hour from 13:00."""
    marks = [
        PLACEMARK.format(
            time="2021-07-25T" + hour.format(hour=13 + index),
            end="" if index + 1 == len(halves) else "<end>2021-07-25T13:59:59-06:00</end>",
            name=name,
            ring=square(half),
        )
        for index, half in enumerate(halves)
    ]
    path.write_text(
        f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{"".join(marks)}</Document></kml>'
    )


def test_each_file_is_a_scenario(tmp_path):
    scenario(tmp_path / "best.kml", "Best case", 0.01, 0.02)
    scenario(tmp_path / "worst.kml", "Worst case", 0.01, 0.04, 0.08)
    forecast, _, _ = convert(tmp_path, tmp_path / "out")
    assert forecast.manifest.kind == "scenarios"
    assert [member.name for member in forecast.members] == ["Best case", "Worst case"]
    assert [member.end for member in forecast.members] == [3600.0, 7200.0]
    assert forecast.horizon == 7200.0
    assert f"{forecast.issued:%F %H:%M}" == "2021-07-25 19:00"
    middle, row = np.abs(forecast.longitude + 116).argmin(), np.abs(forecast.latitude - 63.03).argmin()
    assert forecast.arrival(0)[np.abs(forecast.latitude - 63).argmin(), middle] == 0.0
    assert forecast.arrival(0)[row, middle] == np.inf
    assert forecast.arrival(1)[row, middle] == 1800.0  # between 13:00 and 14:00
    areas = [float(forecast.areas[np.isfinite(forecast.arrival(index))].sum()) for index in range(2)]
    assert areas[1] / areas[0] == pytest.approx(16.0, rel=0.05)


def test_a_damaged_scenario_is_left_out(tmp_path):
    scenario(tmp_path / "a.kml", "A", 0.01)
    scenario(tmp_path / "b.kml", "B", 0.01, hour="13:00")
    forecast, _, _ = convert(tmp_path, tmp_path / "out", horizon=60.0)
    assert [member.name for member in forecast.members] == ["A"]
    assert "not a time with an offset from UTC" in forecast.left_out[0].reason
    (tmp_path / "a.kml").unlink()
    with pytest.raises(InputError, match="none of 1 scenarios can be read"):
        convert(tmp_path / "b.kml", tmp_path / "other")
