"""Snapshots of a solved flow: one file with the smoke's block of cells at one time. Needs no Blender."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray

from .. import files

_CLEAR = 1e-15  # kg/m3; thinner smoke is not stored
_THIN = 3e-10  # kg/m3; other fields of thinner smoke are not stored
_DRIFT_STEP = 4.0  # m, quantization of drift
_PACKING = 1  # zlib level: three times as fast as the default, files a tenth larger

_NAMES = ("smoke", "age", "rise", "temperature_excess", "drift", "low", "weights", "turns", "mass", "heat")
_MASS = ("airborne", "emitted", "entered", "initial", "left", "rounding")
_HEAT = ("given", "held", "warmed")

Fields = dict[str, NDArray[Any]]


_UNREADABLE = (OSError, EOFError, LookupError, TypeError, ValueError, zipfile.BadZipFile, zlib.error)
"""Errors of reading a damaged .npz file."""


class BrokenError(Exception):
    """The file is truncated or is not a snapshot of this flow."""


@dataclass(frozen=True)
class Snapshot:
    """Block of a flow's cells above the ground.

    Attributes
    ----------
    low
        Column and row of the block's first cell.
    fields
        smoke, age, rise, temperature_excess (nz, ny, nx) and drift (nz, ny, nx, 2, 3), as in
        `firetwin_core.flow`.
    weights, turns
        Blend weights and restart counts of the drift's two phases.
    mass
        Mass budget of smoke, kg.
    heat
        Heat budget of the air, J.
    """

    low: tuple[int, int]
    fields: Fields
    weights: tuple[float, float]
    turns: tuple[int, int]
    mass: dict[str, float]
    heat: dict[str, float]


def save(path: Path, solver: flow.Solver, drift: flow.Drift) -> None:
    """Write a snapshot of a flow's present state."""
    smoke = solver.smoke()
    there = smoke > _CLEAR
    block = tuple(_range(there.any(axis=axes)) for axes in ((1, 2), (0, 2), (0, 1)))
    block = (slice(0, max(block[0].stop, 2)), *(slice(part.start // 2 * 2, part.stop) for part in block[1:]))
    unseen = smoke[block] < _THIN
    arrays: Fields = {"smoke": smoke[block]}
    for name, values in (
        ("age", solver.age()),
        ("rise", solver.velocity()[..., 2]),
        ("temperature_excess", solver.temperature_excess()),
    ):
        arrays[name] = np.where(unseen, 0.0, np.clip(values[block], -6e4, 6e4)).astype(np.float16)
    moved = drift.values()[tuple(slice(part.start // 2, part.stop // 2 + 1) for part in block)]
    arrays["drift"] = (np.round(moved / _DRIFT_STEP) * _DRIFT_STEP).astype(np.float16)
    mass, heat = solver.mass(), solver.heat()
    arrays |= {
        "low": np.array([block[2].start, block[1].start]),
        "weights": np.array(drift.weights),
        "turns": np.array(drift.turns),
        "mass": np.array([mass[name] for name in _MASS]),
        "heat": np.array([heat[name] for name in _HEAT]),
    }
    files.write(path, lambda part: write(part, arrays, _PACKING))


def load(path: Path) -> Snapshot:
    """Read a snapshot.

    Raises
    ------
    BrokenError
        The file is not complete.
    """
    arrays = read(path)
    try:
        smoke, drift = arrays["smoke"], arrays["drift"].astype(np.float32)
        for axis, count in enumerate(smoke.shape):
            drift = _upsampled(drift, axis, count)
        fields = {
            name: arrays[name].astype(np.float32) for name in ("smoke", "age", "rise", "temperature_excess")
        }
        if drift.shape != (*smoke.shape, 2, 3) or any(
            field.shape != smoke.shape for field in fields.values()
        ):
            raise BrokenError(path)
        return Snapshot(
            (int(arrays["low"][0]), int(arrays["low"][1])),
            fields | {"drift": drift},
            (float(arrays["weights"][0]), float(arrays["weights"][1])),
            (int(arrays["turns"][0]), int(arrays["turns"][1])),
            dict(zip(_MASS, map(float, arrays["mass"]), strict=True)),
            dict(zip(_HEAT, map(float, arrays["heat"]), strict=True)),
        )
    except (LookupError, TypeError, ValueError) as error:
        raise BrokenError(path) from error


def load_smoke(path: Path) -> tuple[tuple[int, int], NDArray[np.float32]]:
    """Read only the smoke (nz, ny, nx), kg/m3, of a snapshot, as `load_field`."""
    return load_field(path, "smoke")


def load_field(path: Path, name: str) -> tuple[tuple[int, int], NDArray[Any]]:
    """Read one field (nz, ny, nx) of a snapshot, with its block's first column and row.

    Raises
    ------
    BrokenError
        The file is not complete.
    """
    try:
        with _opened(path) as file:
            west, south = file["low"]
            return (int(west), int(south)), file[name]
    except _UNREADABLE as error:
        raise BrokenError(path) from error


def is_complete(path: Path, shape: tuple[int, int, int]) -> bool:
    """Return whether a file's headers describe a complete snapshot of a flow of `shape` cells."""
    try:
        with zipfile.ZipFile(path) as file:
            if set(file.namelist()) != {f"{name}.npy" for name in _NAMES}:
                return False
            low, smoke = (_header(file, "low"), _header(file, "smoke"))
            west, south = np.lib.format.read_array(io.BytesIO(file.read("low.npy")))
    except (OSError, LookupError, TypeError, ValueError, zipfile.BadZipFile):
        return False
    ends = (0, int(south), int(west))
    return (
        low == (2,)
        and len(smoke) == 3
        and all(at >= 0 and at + count <= most for at, count, most in zip(ends, smoke, shape, strict=True))
    )


def read(path: Path) -> Fields:
    """Read all arrays of a file written by `write`.

    Raises
    ------
    BrokenError
        The file is not complete.
    """
    try:
        with _opened(path) as file:
            return {name: file[name] for name in file.files}
    except FileNotFoundError:
        raise
    except _UNREADABLE as error:
        raise BrokenError(path) from error


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open arrays of a file. `np.load` leaves a broken file open, which Windows then does not remove."""
    with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
        yield file


def _header(file: zipfile.ZipFile, name: str) -> tuple[int, ...]:
    """Read the shape of an array in an .npz file."""
    with file.open(f"{name}.npy") as part:
        np.lib.format.read_magic(part)
        return np.lib.format.read_array_header_1_0(part)[0]


def write(path: Path, arrays: Fields, packing: int = 0) -> None:
    """Write arrays as an .npz file, reproducible to the byte."""
    way = zipfile.ZIP_DEFLATED if packing else zipfile.ZIP_STORED
    with zipfile.ZipFile(path, "w", way) as file:
        for name, array in arrays.items():
            part = io.BytesIO()
            np.lib.format.write_array(part, np.ascontiguousarray(array), allow_pickle=False)
            file.writestr(zipfile.ZipInfo(f"{name}.npy"), part.getbuffer(), way, packing or None)


def _upsampled(values: NDArray[np.float32], axis: int, count: int) -> NDArray[np.float32]:
    """Upsample every second of `count` points linearly to all points along an axis."""
    values = np.moveaxis(values, axis, 0)
    doubled = np.repeat(values, 2, 0)
    doubled[1:-1:2] = 0.5 * (values[:-1] + values[1:])
    return np.moveaxis(doubled[:count], 0, axis)


def _range(there: NDArray[np.bool_]) -> slice:
    """Return the slice from the first to the last true element; one element if there is none."""
    indices = np.flatnonzero(there)
    return slice(int(indices[0]), int(indices[-1]) + 1) if len(indices) else slice(0, 1)
