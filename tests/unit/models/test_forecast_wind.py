"""Wind of HRRR for runs without wind: turned to true north, in place and time; files that do not fit."""

from pathlib import Path

import grib_files
import numpy as np
import pytest
from firetwin.errors import InputError
from firetwin.jobs import convert
from firetwin.run import opening as runs

pytest.importorskip("rasterio")
pytest.importorskip("pyproj")
EAST, NORTH = 6.0, 2.0  # m/s
OPTIONS = ["2014-09-17T00:00Z", "38.78,-120.6", "", 0.0]


def turned(scale=1.0):
    """Wind of these components in the axes of the grid: by the closed form of a Lambert cone."""

    def angle(longitude):
        return np.sin(np.radians(38.5)) * np.radians(longitude + 97.5)

    return {
        "UGRD": lambda _, at: scale * (EAST * np.cos(angle(at)) - NORTH * np.sin(angle(at))),
        "VGRD": lambda _, at: scale * (EAST * np.sin(angle(at)) + NORTH * np.cos(angle(at))),
    }


@pytest.fixture
def arrivals(tmp_path: Path) -> Path:
    """Write a front of FARSITE that lasts about 100 min."""
    rows = "\n".join(" ".join(f"{column:.1f}" for column in range(100)) for _ in range(8))
    path = tmp_path / "FlamMap_Arrival Time.asc"
    path.write_text(f"ncols 100\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 30\n{rows}\n")
    return path


def converted(arrivals: Path, out: Path, *wind: Path):
    convert.in_process([arrivals], out, OPTIONS, wind=list(wind))
    return runs.open(out)


def test_wind_is_turned_to_true_north_and_changes_with_time(arrivals, tmp_path):
    files = [
        grib_files.write(tmp_path / f"f{hours}.grib2", turned(1.0 + hours), hours) for hours in (0, 2, 4)
    ]
    run = converted(arrivals, tmp_path / "run", *files)
    for index in (0, len(run.times) // 2, len(run.times) - 1):
        scale = 1.0 + run.times[index] / 3600.0
        east, north = run.wind(index)
        np.testing.assert_allclose(east, EAST * scale, rtol=1e-5)
        np.testing.assert_allclose(north, NORTH * scale, rtol=1e-5)
    assert (len(run.air_latitude), len(run.air_longitude)) == (3, 3)  # cells of 3 km
    assert run.latitude.min() > run.air_latitude.min()
    assert run.latitude.max() < run.air_latitude.max()
    text = (tmp_path / "run" / "run.toml").read_text()
    assert "turned from the grid's axes to true north; it did not drive the fire model" in text


def test_wind_of_east_and_north_is_not_turned(arrivals, tmp_path):
    """Without the turn, the wind would be 14 degrees off at this place."""
    uniform = {"UGRD": lambda *_: np.array(EAST), "VGRD": lambda *_: np.array(NORTH)}
    files = [
        grib_files.write(tmp_path / f"f{hours}.grib2", uniform, hours, along_grid=False) for hours in (0, 3)
    ]
    run = converted(arrivals, tmp_path / "run", *files)
    np.testing.assert_allclose(run.wind(0)[0], EAST, rtol=1e-6)
    np.testing.assert_allclose(run.wind(0)[1], NORTH, rtol=1e-6)


def test_the_last_wind_is_held_and_printed(arrivals, tmp_path):
    files = [grib_files.write(tmp_path / f"f{hours}.grib2", turned(1.0 + hours), hours) for hours in (0, 1)]
    run = converted(arrivals, tmp_path / "run", *files)
    np.testing.assert_allclose(run.wind(len(run.times) - 1)[0], 2.0 * EAST, rtol=1e-5)
    late = int((run.times > 3601).sum())
    assert f"{late} of {len(run.times)} times have its" in (tmp_path / "run" / "run.toml").read_text()


def test_files_that_do_not_fit_are_one_line(arrivals, tmp_path):
    first = grib_files.write(tmp_path / "f0.grib2", turned())
    late = grib_files.write(tmp_path / "late.grib2", turned(), 9)
    with pytest.raises(InputError, match="valid at 2014-09-17 09:00 to 2014-09-17 09:00 UTC, and the run"):
        converted(arrivals, tmp_path / "run", late)
    with pytest.raises(InputError, match=r"f0b.grib2: has UGRD for 2014-09-17 00:00 UTC, as f0.grib2 has"):
        converted(arrivals, tmp_path / "run", first, grib_files.write(tmp_path / "f0b.grib2", turned()))
    alone = grib_files.write(tmp_path / "alone.grib2", {"UGRD": turned()["UGRD"]})
    with pytest.raises(InputError, match="has no pair of UGRD and VGRD at 10 m"):
        converted(arrivals, tmp_path / "run", alone)
    with pytest.raises(InputError, match="is not a GRIB2 file"):
        converted(arrivals, tmp_path / "run", arrivals)
    cut = tmp_path / "cut.grib2"
    cut.write_bytes(first.read_bytes()[:3000])
    with pytest.raises(InputError, match=r"cut.grib2: "):
        converted(arrivals, tmp_path / "run", cut)
    OPTIONS[1] = "45,-120"
    try:
        with pytest.raises(InputError, match="does not contain the grid of the run"):
            converted(arrivals, tmp_path / "run", first)
    finally:
        OPTIONS[1] = "38.78,-120.6"


def test_a_model_with_wind_keeps_it(tmp_path):
    from types import SimpleNamespace

    from firetwin.run.models import forecast_wind

    model = SimpleNamespace(moving={"wind_east": None}, files=[tmp_path / "wrfout"])
    with pytest.raises(InputError, match="wrfout: already has wind; leave out --wind"):
        forecast_wind.add(model, [])
