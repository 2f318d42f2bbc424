"""Samples of any model as members, described in a TOML file: all containers, axes, and refusals."""

from pathlib import Path

import numpy as np
import pytest
from firetwin.errors import InputError
from small_ensemble import convert

VALUES = np.zeros((2, 3, 2, 4))  # member, time, y, x
VALUES[0, 1:, 0, 0] = 0.6
VALUES[0, 2, 0, 1] = 0.5
VALUES[1, :, 1, 3] = 0.9
VALUES[1, :, 0, 0] = np.nan
NEVER = np.inf
ARRIVAL = np.full((2, 2, 4), NEVER, np.float32)
ARRIVAL[0, 0, :2] = 7200.0, 10800.0
ARRIVAL[1, 1, 3], ARRIVAL[1, 0, 0] = 3600.0, np.nan

TOLD = {
    "variable": '"prediction"',
    "quantity": '"burned"',
    "threshold": "0.5",
    "times_s": "[3600, 7200, 10800]",
    "transform": "[30, 0, 700000, 0, -30, 4300000]",
    "projection": '"EPSG:32610"',
}


@pytest.fixture
def describe(tmp_path: Path):
    """Write the TOML file with some keys replaced, or left out for None; return the folder."""
    pytest.importorskip("pyproj")
    folder = tmp_path / "samples"
    folder.mkdir()

    def make(**changes: str | None) -> Path:
        lines = [f"{key} = {value}" for key, value in (TOLD | changes).items() if value is not None]
        (folder / "samples.toml").write_text("[samples]\n" + "\n".join(lines))
        return folder

    return make


def npz(folder: Path) -> None:
    np.savez(folder / "a.npz", prediction=VALUES, other=1)


def npy(folder: Path) -> None:
    np.save(folder / "a.npy", VALUES)


def netcdf(folder: Path) -> None:
    library = pytest.importorskip("netCDF4")
    with library.Dataset(folder / "a.nc", "w") as data:
        for name, size in zip(("member", "time", "y", "x"), VALUES.shape, strict=True):
            data.createDimension(name, size)
        data.createVariable("prediction", "f4", ("member", "time", "y", "x"))[:] = VALUES


def store(folder: Path) -> None:
    zarr = pytest.importorskip("zarr")
    zarr.open_group(folder / "a.zarr", mode="w").create_array("prediction", data=VALUES.astype("f4"))


def geotiff(folder: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    for index, values in enumerate(VALUES):
        like = {"driver": "GTiff", "count": 3, "height": 2, "width": 4, "dtype": "float32"}
        like["transform"] = rasterio.Affine(30, 0, 700000, 0, -30, 4300000)
        with rasterio.open(folder / f"member_{index}.tif", "w", **like) as file:
            file.write(values.astype("f4"))


@pytest.mark.parametrize("write", [npz, npy, netcdf, store, geotiff])
def test_every_container_gives_the_same_members(describe, tmp_path, write):
    folder = describe()
    write(folder)
    np.testing.assert_array_equal(convert(folder, tmp_path / "out", projection="").arrival, ARRIVAL)


def test_axes_in_any_order(describe, tmp_path):
    folder = describe(axes='["y", "time", "x", "member"]')
    np.savez(folder / "a.npz", prediction=VALUES.transpose(2, 1, 3, 0))
    np.testing.assert_array_equal(convert(folder, tmp_path / "out", projection="").arrival, ARRIVAL)


def test_arrival_times_in_hours(describe, tmp_path):
    folder = describe(quantity='"arrival"', unit='"h"', threshold=None, times_s="[10800]")
    hours = np.where(np.isfinite(ARRIVAL), ARRIVAL / 3600.0, np.nan)
    hours[1, 0, 0] = np.nan
    np.savez(folder / "a.npz", prediction=hours)
    expected = np.where(np.isnan(ARRIVAL), NEVER, ARRIVAL)
    np.testing.assert_array_equal(convert(folder, tmp_path / "out", projection="").arrival, expected)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"threshold": None}, "threshold is missing; a value from which a cell has burned is a decision"),
        ({"quantity": None}, 'quantity is missing; write "burned" or "arrival"'),
        ({"times_s": "[1, 2]"}, "gives 2 times_s, and the array has 3"),
        ({"times_s": "[3, 2, 1]"}, "times_s does not ascend"),
        ({"times_s": "[1, 2, nan]"}, "times_s is not a list of seconds"),
        ({"transform": "[1, 2]"}, "transform is missing; write six numbers"),
        ({"transform": "[30, 1, 700000, 0, -30, 4300000]"}, "has a turned transform"),
        ({"projection": None}, "projection is missing"),
        ({"axes": '["time", "y", "x"]'}, "axes are not member, time, y, x in some order"),
        ({"variable": '"p"'}, 'has no array "p"; variable is one of prediction, other'),
        ({"limit": "1"}, 'has an unknown key "limit"'),
    ],
)
def test_nothing_is_guessed(describe, tmp_path, changes, reason):
    folder = describe(**changes)
    npz(folder)
    with pytest.raises(InputError, match=reason):
        convert(folder, tmp_path / "out", projection="")
    assert not (tmp_path / "out").exists()
