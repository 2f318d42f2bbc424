"""Fire model output as readers supply it: grids, times, and a function for each field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import limits
from ...errors import UsageError
from .. import zone
from .grid import Grid

Array = NDArray[np.float32]
Still = Callable[[], NDArray]
Moving = Callable[[int], NDArray]

LONGEST = 400 * 366 * 86400.0  # s, upper limit of a run's length

ON_FUEL = (
    *("surface_fuel", "canopy_fuel", "fuel_arrival_time", "fuel_elevation", "fuel_category"),
    "burned_fraction",
)
OF_AIR = ("temperature", "wind_east", "wind_north")


@dataclass(frozen=True)
class Options:
    """User's information that is missing in the files.

    Attributes
    ----------
    start
        Time origin of the files.
    at
        Latitude and longitude (degrees) of the centre of a grid in metres.
    projection
        Projection of grids in metres, as PROJ takes it: ``EPSG:5070``.
    interval
        Interval of a computed heat flux, s.
    mapping
        TOML file that maps fields to variables (readers/netcdf_cf.py).
    name
        Name of the run; "": the folder's name with the model's.
    zone
        Time zone of the run, by default from the offset of `start`; "": none.
    growing
        The files are still being written: times without values at their end are left out.
    until
        Last time to read; None: all.
    """

    start: datetime | None = None
    at: tuple[float, float] | None = None
    projection: str = ""
    interval: float = 0.0
    mapping: Path | None = None
    name: str = ""
    zone: str = ""
    growing: bool = False
    until: datetime | None = None

    @classmethod
    def of(
        cls, start: str, at: str, projection: str, interval: float, paths: list[Path],
        name: str = "", there: str = "",
    ) -> Options:  # fmt: skip
        """Parse options from command line text.

        Raises
        ------
        UsageError
        """
        place = _place(at) if at else None
        mapping = next((path for path in paths if path.suffix.lower() == ".toml"), None)
        if there and not zone.known(there):
            raise UsageError(f"--zone: {there!r} {zone.NOT_KNOWN}")
        begun, there = _moment(start) if start else None, there or _zone(start)
        return cls(begun, place, projection, interval, mapping, name, there)


@dataclass
class Model:
    """A run of a fire model.

    Attributes
    ----------
    times
        (nt,) s since `start`.
    grid, fuel_grid
        Grids of the heat flux, and of fuels, arrival times and burned fractions.
    air
        Grid of wind, temperature and 3D fields; None: `grid`.
    still
        ``elevation`` [ny, nx] on `grid`; ``surface_fuel``, ``canopy_fuel``, ``fuel_arrival_time``,
        ``fuel_elevation`` and ``fuel_category`` [fy, fx] on `fuel_grid`; in a run's units.
    moving
        Function of the time index for each field, [ny, nx] or [nz, ny, nx] on its grid; in a run's units.
    mean_s
        Averaging time of heat fluxes before each time, s; None: the whole interval.
    levels
        Shape [nz] of each 3D field.
    sources
        File of each time, and its index among the times of that file; empty if times are computed.
    """

    source: str
    name: str
    start: datetime
    times: NDArray[np.float64]
    grid: Grid
    fuel_grid: Grid
    still: dict[str, Still]
    moving: dict[str, Moving]
    files: list[Path]
    air: Grid | None = None
    version: str = ""
    projection: str = ""
    zone: str = ""
    mean_s: float | None = None
    levels: dict[str, int] = field(default_factory=dict)
    sources: list[tuple[Path, int]] = field(default_factory=list)
    assumptions: list[str] = field(default_factory=list)
    close: Callable[[], None] = lambda: None

    def grid_of(self, field: str) -> Grid:
        """Return the grid of a field."""
        if field in ON_FUEL:
            return self.fuel_grid
        return self.air if self.air is not None and (field in OF_AIR or field in self.levels) else self.grid

    def moment(self, index: int) -> datetime:
        """Return the UTC time of a time index."""
        return self.start + timedelta(seconds=float(self.times[index]))

    @property
    def grids(self) -> dict[str, Grid]:
        """Each grid of the run, by prefix of its axis names."""
        return {"": self.grid, "fuel_": self.fuel_grid} | ({} if self.air is None else {"air_": self.air})


def read_until(moment: datetime, options: Options) -> bool:
    """Return whether a time of a file is to be read."""
    return options.until is None or moment <= options.until


def _moment(text: str) -> datetime:
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise UsageError(f"--start: {text!r} is not a date and time such as 2014-09-17T04:45:00Z") from None
    first, last = limits.RUN_YEARS
    if not first <= moment.year <= last:
        raise UsageError(f"--start: {text!r} is not in the years {first} to {last}; correct it")
    return moment.astimezone(UTC) if moment.tzinfo else moment.replace(tzinfo=UTC)


def _zone(start: str) -> str:
    """Return the time zone of a start's offset; "" for UTC."""
    offset = datetime.fromisoformat(start).utcoffset() if start else None
    return zone.of_offset(round(offset.total_seconds() / 60.0)) if offset else ""


def _place(text: str) -> tuple[float, float]:
    try:
        latitude, longitude = map(float, text.split(","))
        if abs(latitude) < 89 and abs(longitude) <= 360:
            return latitude, longitude
    except ValueError:
        pass
    raise UsageError(f"--at: {text!r} is not a latitude and longitude such as 38.78,-120.6")
