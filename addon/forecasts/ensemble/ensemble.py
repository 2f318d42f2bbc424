"""Ensemble: arrival times of the members of one forecast, on one grid, in a folder.

A folder holds ``ensemble.toml`` (the manifest), ``latitude.npy`` and ``longitude.npy`` (cell centres,
degrees) and ``arrival.npy`` (member, y, x), float32, s since the issue time: 0 or less where it burned
before, +inf where the fire does not arrive before the member ends, NaN where a member simulated nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from ... import unpacking
from ...errors import Error, input_error, reading
from ...run.areas import cell_areas
from .manifest import MANIFEST, LeftOut, Manifest, Member, read

ARRIVAL = "arrival.npy"
_BLOCK = 1 << 21  # values of all members that are read at once: 8 MiB


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Members of one forecast, and access to their arrival times.

    Attributes
    ----------
    path
        Folder.
    manifest
        Names, weights, issue time, horizon and provenance.
    latitude, longitude
        Cell centres (ny,) and (nx,), degrees.
    """

    path: Path
    manifest: Manifest
    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]

    @property
    def members(self) -> tuple[Member, ...]:
        """Members that have arrival times, in their order in ``arrival.npy``."""
        return self.manifest.members

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """Members that failed or are empty: no statistic counts them."""
        return self.manifest.left_out

    @property
    def horizon(self) -> float:
        """Length of the forecast, s."""
        return self.manifest.horizon

    @property
    def issued(self) -> datetime:
        """Issue time, UTC."""
        assert self.manifest.issued is not None  # `open` checks it
        return self.manifest.issued.astimezone(UTC)

    @property
    def weights(self) -> NDArray[np.float64]:
        """Weights of the members (m,)."""
        return np.array([member.weight for member in self.members])

    @property
    def shape(self) -> tuple[int, int, int]:
        """Members, rows and columns."""
        return len(self.members), len(self.latitude), len(self.longitude)

    @property
    def areas(self) -> NDArray[np.float64]:
        """Cell areas (ny, nx), m2."""
        return cell_areas(self.latitude, self.longitude)

    def valid(self, time: float) -> datetime:
        """Convert a time since the issue time (s) to UTC."""
        return self.issued + timedelta(seconds=time)

    def counted(self, time: float) -> NDArray[np.bool_]:
        """Return which members (m,) were simulated up to a time (s): statistics at this time count these."""
        return np.array([member.end >= time for member in self.members])

    def counted_at_end(self) -> NDArray[np.bool_]:
        """Return which members (m,) were simulated up to the horizon.

        Raises
        ------
        Error
            No member reaches it.
        """
        counted = self.counted(self.horizon)
        if not counted.any():
            raise Error(f"{self.path}: no member reaches the horizon; lower horizon_s")
        return counted

    def arrival(self, member: int) -> NDArray[np.float32]:
        """Read the arrival times (ny, nx) of one member, s since the issue time."""
        return self._array()[member].copy()

    def at(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> NDArray[np.float32]:
        """Read the arrival times (m, n) of all members in n cells, s since the issue time."""
        arrival = self._array()
        return np.stack([arrival[member][rows, columns] for member in range(len(arrival))])

    def blocks(self) -> Iterator[tuple[slice, NDArray[np.float32]]]:
        """Read all members in blocks of rows: yield the rows, and a new array (m, rows, nx) of their times.

        The rows are read, not mapped: the system maps up to megabytes around each, 1 GB for 1,000 members.
        """
        members, rows, columns = self.shape
        step = max(1, _BLOCK // (members * columns))
        path = self.path / ARRIVAL
        with reading(path, "NumPy file"), path.open("rb", buffering=0) as file:
            start = self._array().offset
            for first in range(0, rows, step):
                these = slice(first, min(first + step, rows))
                arrival = np.empty((members, these.stop - first, columns), np.float32)
                for member in range(members):
                    file.seek(start + 4 * columns * (member * rows + first))
                    if file.readinto(arrival[member]) != arrival[member].nbytes:
                        raise input_error(path, "has become shorter; convert the ensemble again")
                yield these, arrival

    def _array(self) -> np.memmap[Any, np.dtype[np.float32]]:
        """Map the arrival times (m, ny, nx); pages that were read are released with the array."""
        return cast(Any, np.load(self.path / ARRIVAL, mmap_mode="r"))


def sniff(path: Path) -> bool:
    """Check whether a folder is an ensemble with arrival times."""
    return (path / MANIFEST).is_file() and (path / ARRIVAL).is_file()


def open(path: Path) -> Ensemble:
    """Open the ensemble in a folder.

    Raises
    ------
    InputError
        A file is missing or damaged, or sizes differ.
    """
    manifest = read(path / MANIFEST)
    if manifest.issued is None:
        reason = "has no issue time; write issued = 2014-09-17T04:45:00Z"
        raise input_error(path / MANIFEST, reason)
    axes = [_axis(path / f"{name}.npy") for name in ("latitude", "longitude")]
    ensemble = Ensemble(path, manifest, axes[0], axes[1])
    with reading(path / ARRIVAL, "NumPy file"):
        arrival = np.load(path / ARRIVAL, mmap_mode="r", allow_pickle=False)
    if arrival.dtype != np.dtype("<f4") or arrival.shape != ensemble.shape:
        reason = f"holds {arrival.dtype} {arrival.shape}, not float32 {ensemble.shape} as the other files say"
        raise input_error(path / ARRIVAL, f"{reason}; convert the ensemble again")
    return ensemble


def _axis(path: Path) -> NDArray[np.float64]:
    """Read cell centres, degrees.

    Raises
    ------
    InputError
        The file is damaged, or its values do not ascend or descend.
    """
    axis = unpacking.read_npy(path)
    axis = axis.astype(np.float64) if axis.dtype.kind in "iuf" else np.empty(0)
    step = np.diff(axis) if axis.ndim == 1 else np.array([np.nan])
    if not axis.size or not np.isfinite(axis).all() or not ((step > 0).all() or (step < 0).all()):
        raise input_error(path, "is not a list of ascending or descending degrees; convert it again")
    return axis
