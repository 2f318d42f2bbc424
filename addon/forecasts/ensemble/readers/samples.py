"""Reader of samples of any model, such as learned forecasts: one array, which a TOML file describes.

The array is in an ``.npz`` or ``.npy`` file, a netCDF file, a zarr store, or GeoTIFF files of one member each
(a band for each time). Nothing is guessed::

    [samples]
    variable = "prediction"             # of an archive, netCDF file or store
    axes = ["member", "time", "y", "x"] # "time" is left out of arrival times
    quantity = "burned"                 # values from `threshold` on have burned; or "arrival", with `unit`
    threshold = 0.5
    times_s = [3600, 7200]              # since the issue time
    transform = [30, 0, 700000, 0, -30, 4300000] # as rasterio writes it: x = a column + b row + c, y = d ...
    projection = "EPSG:32610"
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .... import unpacking
from ....errors import input_error, reading
from ....files import check_text_size
from ....run.models import netcdf, raster, zarr_store
from ....run.models.grid import Grid
from ....run.models.model import LONGEST, Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, describe

NAME, ORDER = "samples described in a TOML file ([samples])", 10

_LISTED = 300  # characters of listed names
_UNITS = {"s": 1.0, "min": 60.0, "h": 3600.0}
_AXES = {"burned": ("member", "time", "y", "x"), "arrival": ("member", "y", "x")}
_KEYS = {
    "variable",
    "axes",
    "quantity",
    "threshold",
    "unit",
    "times_s",
    "transform",
    "projection",
    "model",
    "perturbed",
}


@dataclass(frozen=True)
class Description:
    """Table ``[samples]``; see the head of this module."""

    path: Path
    variable: str
    axes: tuple[str, ...]
    quantity: str
    threshold: float
    unit: float
    times: NDArray[np.float64]
    transform: tuple[float, ...]
    projection: str
    model: str
    perturbed: str


def sniff(paths: list[Path]) -> bool:
    """Check for a TOML file with the table ``[samples]``."""
    return any(_table(path) is not None for path in _files(paths) if path.suffix == ".toml")


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each sample."""
    files = _files(paths)
    told = next(path for path in files if path.suffix == ".toml" and _table(path) is not None)
    said = _describe(told, options)
    data = [path for path in files if path.suffix != ".toml"]
    if not data:
        raise input_error(told, "has no data next to it; give the file of the array too")
    count, shape, get = _open(said, data)
    last = float(said.times[-1]) if said.times.size else 0.0
    if not (horizon or last):
        raise input_error(told, "gives no end of the forecast; add --horizon HOURS")
    source = f"{count} samples of {data[0].name}"
    head, _ = describe(options, told, said.model, horizon or last, source)
    head = replace(head, name=options.name or told.stem, perturbed=said.perturbed)
    note = "arrival times are as given"
    if said.quantity == "burned":
        note = f"a cell has burned from the first time at which its value is {said.threshold:g} or more"
    members = _members(said, count, get, head.horizon)
    return MemberSet(head, _grid(said, shape), members, [note])


def _members(
    said: Description, count: int, get: Callable[[int], NDArray], horizon: float
) -> Iterator[write.Read]:
    for index in range(count):
        values = np.asarray(get(index), np.float32)
        if said.quantity == "arrival":
            arrival = np.where(values >= 0.0, values * said.unit, np.where(np.isnan(values), np.inf, np.nan))
            if (values < 0.0).any():
                yield Member(f"{index:02}"), "has negative arrival times; write NaN in unburned cells"
                continue
        else:
            burned = values >= said.threshold
            arrival = np.where(burned.any(0), said.times[burned.argmax(0)], np.inf)
            arrival[np.isnan(values).all(0)] = np.nan
        arrival[arrival > horizon] = np.inf
        yield Member(f"{index:02}"), arrival.astype(np.float32)


def _open(said: Description, data: list[Path]) -> tuple[int, tuple[int, int], Callable[[int], NDArray]]:
    """Open the array: return the number of members, rows and columns, and a function of a member's values."""
    if raster.is_raster(data[0]):
        first = raster.read_bands(data[0])[0]
        count, shape, get = len(data), first.shape, lambda index: raster.read_bands(data[index])[0]
        if said.quantity == "arrival":
            shape, get = first[0].shape, lambda index: raster.read_bands(data[index])[0][0]
        _check(said, (count, *shape))
        return count, (int(shape[-2]), int(shape[-1])), get
    file = _File.of(data[0], said.variable)
    order = [said.axes.index(axis) for axis in _AXES[said.quantity]]
    sizes = [file.shape[axis] for axis in order] if len(file.shape) == len(order) else file.shape
    _check(said, tuple(sizes))

    def member(index: int) -> NDArray:
        at: list[int | slice] = [slice(None)] * len(order)
        at[order[0]] = index
        left = [axis for axis in said.axes if axis != "member"]
        return file.read(*at).transpose([left.index(axis) for axis in _AXES[said.quantity][1:]])

    return sizes[0], (sizes[-2], sizes[-1]), member


@dataclass(frozen=True)
class _File:
    shape: tuple[int, ...]
    read: Callable[..., NDArray]

    @classmethod
    def of(cls, path: Path, variable: str) -> _File:
        """Open the array of a NumPy file, a netCDF file or a zarr store."""
        if netcdf.is_netcdf(path) or zarr_store.is_store(path):
            opened = netcdf.File(path) if netcdf.is_netcdf(path) else zarr_store.ZarrFile(path)
            return cls(opened.shape(variable), lambda *at: opened.read(variable, *at))
        if path.suffix == ".npy":
            with reading(path, "NumPy file"):
                array = np.load(path, mmap_mode="r", allow_pickle=False)
        else:
            array = _archived(path, variable)
        return cls(array.shape, lambda *at: np.asarray(array[at]))


def _archived(path: Path, variable: str) -> NDArray:
    """Read an array of an .npz file."""
    if variable not in (names := unpacking.npz_names(path)):
        listed = ", ".join(names)
        raise input_error(path, f'has no array "{variable}"; variable is one of {listed[:_LISTED]}')
    return unpacking.read_npz(path, [variable])[variable]


def _check(said: Description, sizes: tuple[int, ...]) -> None:
    axes = _AXES[said.quantity]
    if len(sizes) != len(axes):
        reason = f"describes axes {', '.join(said.axes)}, and the array has {len(sizes)} axes"
        raise input_error(said.path, reason)
    if said.quantity == "burned" and sizes[1] != len(said.times):
        reason = f"gives {len(said.times)} times_s, and the array has {sizes[1]}"
        raise input_error(said.path, reason)


def _grid(said: Description, shape: tuple[int, int]) -> Grid:
    a, b, c, d, e, f = said.transform
    if b or d:
        raise input_error(said.path, "has a turned transform; gdalwarp makes its grid upright")
    x, y = c + a * (np.arange(shape[1]) + 0.5), f + e * (np.arange(shape[0]) + 0.5)
    return Grid.projected(x, y, said.projection)


def _table(path: Path) -> dict[str, Any] | None:
    """Read the table ``[samples]`` of a TOML file; None without one."""
    try:
        check_text_size(path)
        found = tomllib.loads(path.read_text(encoding="utf-8-sig")).get("samples")
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def _describe(path: Path, options: Options) -> Description:
    """Check the table ``[samples]``.

    Raises
    ------
    InputError
        A value is missing or invalid.
    """
    table = _table(path) or {}

    def wrong(reason: str) -> Exception:
        return input_error(path, f"samples: {reason}")

    if unknown := sorted(set(table) - _KEYS):
        raise wrong(f'has an unknown key "{unknown[0]}"; known are {", ".join(sorted(_KEYS))}')
    quantity = table.get("quantity")
    if quantity not in _AXES:
        raise wrong('quantity is missing; write "burned" or "arrival"')
    axes = table.get("axes", list(_AXES[quantity]))
    if not isinstance(axes, list) or sorted(map(str, axes)) != sorted(_AXES[quantity]):
        raise wrong(f"axes are not {', '.join(_AXES[quantity])} in some order")
    threshold, unit, times = table.get("threshold"), table.get("unit"), table.get("times_s", [])
    if quantity == "burned" and not _number(threshold):
        raise wrong("threshold is missing; a value from which a cell has burned is a decision: write it")
    if quantity == "arrival" and unit not in _UNITS:
        raise wrong('unit is missing; write "s", "min" or "h"')
    if not isinstance(times, list) or not all(_number(each) and 0 <= each <= LONGEST for each in times):
        raise wrong("times_s is not a list of seconds since the issue time")
    moments = np.array(times, np.float64)
    if (quantity == "burned" and not times) or (np.diff(moments) <= 0.0).any():
        raise wrong("times_s does not ascend; write the seconds of each time since the issue time")
    transform = table.get("transform")
    if not isinstance(transform, list) or len(transform) != 6 or not all(map(_number, transform)):
        raise wrong("transform is missing; write six numbers, as rasterio prints them")
    projection = options.projection or table.get("projection")
    if not isinstance(projection, str) or not projection:
        raise wrong('projection is missing; write such as "EPSG:32610"')
    texts = [str(table.get(key, "")) for key in ("variable", "model", "perturbed")]
    return Description(
        path, texts[0], tuple(map(str, axes)), quantity, float(threshold or 0.0),
        _UNITS.get(str(unit), 1.0), moments, tuple(map(float, transform)), projection, *texts[1:],
    )  # fmt: skip


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e15


def _files(paths: list[Path]) -> list[Path]:
    """Collect these files and stores, and the files in these folders."""
    found = []
    for path in paths:
        inner = [path] if path.is_file() or zarr_store.is_store(path) else sorted(path.iterdir())
        found += [each for each in inner if each.is_file() or zarr_store.is_store(each)]
    return found
