"""Model runs on disk."""

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

FIELDS: list[str]
"""Names of all fields that a run may contain."""

def read_grid(path: str | PathLike[str]) -> NDArray[np.float32]:
    """Read a text or .npy grid (ny, nx). Each value is rounded to the nearest float32.

    Text: numbers separated by spaces, tabs or single commas (a comma may end a row); `#` comments; LF or
    CRLF; exponents with E or D; nan and inf. .npy: float32, float64 and integers of 1 to 8 bytes, in either
    byte order, in C or Fortran order. A one-dimensional array is one row.

    Raises
    ------
    InputError
        The file is malformed (with line and column), or a number is too large for a float32.
    """

def read_description(folder: str | PathLike[str]) -> bytes:
    """Read the run.toml of a run folder, at most 16 MiB.

    Raises
    ------
    InputError
        The folder or the file is missing, is a link to a place outside of the folder, or cannot be read.
    """

def open(
    folder: str | PathLike[str],
    *,
    name: str,
    start: str,
    offset: int = 0,
    vertical: str = "orthometric",
    interval_s: float | None = None,
    times_s: Sequence[float] = ...,
    zero_s: float = 0.0,
    mean_s: float | None = None,
    no_data: float | None = None,
    synthetic: bool = False,
    event: str = "",
    zone: str = "",
    warnings: Sequence[str] = ...,
) -> Run:
    """Open the fields of a run folder. Checks the axes and the shape of every field; frames stay on disk.

    Files have the formats of `read_grid`. Longitudes may be in -180..180, 0..360, or cross the antimeridian.
    `firetwin.run.opening.open` reads the other arguments from run.toml; properties of `Run` describe them.
    Exactly one of interval_s and times_s is given.

    Parameters
    ----------
    zero_s
        Time at `start` in the run's files, s; it is subtracted from fuel_arrival_time.
    no_data
        Value that marks missing data.
    warnings
        First of `Run.warnings`.

    Raises
    ------
    InputError
        The folder is not a valid run.
    """

class Frames(Iterator[NDArray[np.float32]]):
    """Iterator over the frames (ny, nx) of a series, prefetched by worker threads (see `Run.frames`)."""

    def __iter__(self) -> Frames: ...
    def __next__(self) -> NDArray[np.float32]: ...

class Run:
    """A model run on disk. Axes and elevation are read when it is opened, frames on demand."""

    @property
    def path(self) -> str:
        """Path of the run folder."""
    @property
    def name(self) -> str:
        """Name of the run in run.toml."""
    @property
    def synthetic(self) -> bool:
        """True if run.toml marks the run as synthetic instead of model output."""
    @property
    def zone(self) -> str:
        """Time zone in run.toml, such as "Europe/Paris"; empty if not given."""
    @property
    def offset(self) -> int:
        """Offset of `start` in run.toml, minutes east of UTC."""
    @property
    def event(self) -> str:
        """Name of the fire that the run simulates, such as "king_fire"; empty if not given."""
    @property
    def start(self) -> str:
        """Origin of `times`, ISO 8601 UTC.

        It is the start in run.toml, or a full second near the first time if that is more than a million
        seconds later, for example for times since 1970: 32-bit floats would lose fractions of a second.
        """
    @property
    def mean_s(self) -> float | None:
        """Each heat flux is the mean over these seconds before its time; None: of the interval."""
    @property
    def vertical(self) -> str:
        """Vertical reference: "orthometric" or "ellipsoidal"."""
    @property
    def times(self) -> NDArray[np.float64]:
        """Model times (nt,), seconds since start, ascending."""
    @property
    def latitude(self) -> NDArray[np.float64]:
        """(ny,) degrees north."""
    @property
    def longitude(self) -> NDArray[np.float64]:
        """(nx,) degrees east without a jump (179, 180, 181); the centre of the axis is in -180..180."""
    @property
    def elevation(self) -> NDArray[np.float32]:
        """(ny, nx) metres."""
    @property
    def fuel_latitude(self) -> NDArray[np.float64]:
        """(fy,) degrees north."""
    @property
    def fuel_longitude(self) -> NDArray[np.float64]:
        """(fx,) degrees east, in the same range as `longitude`."""
    @property
    def air_latitude(self) -> NDArray[np.float64]:
        """(ay,) degrees north of fields on levels: the run's axis, or `latitude` by default."""
    @property
    def air_longitude(self) -> NDArray[np.float64]:
        """(ax,) degrees east of fields on levels, in the same range as `longitude`."""
    @property
    def surface_fuel(self) -> NDArray[np.float32]:
        """(fy, fx) kg/m2."""
    @property
    def canopy_fuel(self) -> NDArray[np.float32]:
        """(fy, fx) kg/m2."""
    @property
    def fuel_elevation(self) -> NDArray[np.float32]:
        """(fy, fx) metres: the run's field fuel_elevation, or `elevation` resampled bilinearly."""
    @property
    def fields(self) -> list[str]:
        """Names of the fields in the run folder."""
    @property
    def warnings(self) -> list[str]:
        """Unusual but usable properties of the data, one sentence each."""
    def heat_flux(self, index: int) -> NDArray[np.float32]:
        """Read the heat flux (ny, nx) at times[index], W/m2."""
    def burned_fraction(self, index: int) -> NDArray[np.float32]:
        """Read the burned fraction (fy, fx) at times[index], 0..1. Raises Error if the run has none."""
    def temperature(self, index: int) -> NDArray[np.float32]:
        """Read the air temperature at times[index], resampled bilinearly to the model grid: (ny, nx) K.

        Raises
        ------
        Error
            The run has no temperature.
        """
    def wind(self, index: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Read the wind to east and north at times[index], resampled to the model grid: (ny, nx) m/s.

        Raises
        ------
        Error
            The run has no wind.
        """
    def has(self, field: str) -> bool:
        """Return True if the run folder contains a field."""
    def smoke_3d(self, index: int) -> NDArray[np.float32]:
        """Read smoke (nz, ay, ax) on terrain-following levels, kg/m3. Raises Error if there is none."""
    def height_3d(self, index: int) -> NDArray[np.float32]:
        """Read level heights (nz, ay, ax), m (see `vertical`). Raises Error if there are none."""
    def temperature_3d(self, index: int) -> NDArray[np.float32]:
        """Read the temperature (nz, ay, ax) at times[index], K. Raises Error if the run has none."""
    def smoke_3d_at(self, time: float) -> NDArray[np.float32]:
        """Interpolate `smoke_3d` linearly to a time (s) within the run."""
    def height_3d_at(self, time: float) -> NDArray[np.float32]:
        """Interpolate `height_3d` linearly to a time (s) within the run."""
    def temperature_3d_at(self, time: float) -> NDArray[np.float32]:
        """Interpolate `temperature_3d` linearly to a time (s) within the run."""
    def frames(self, field: str = "heat_flux", indices: ArrayLike | None = None, ahead: int = 8) -> Frames:
        """Iterate over the frames (ny, nx) of a series while worker threads prefetch the next ones.

        The iterator is thread-safe: each frame goes to one thread. A frame that cannot be read raises
        InputError in its turn.

        Parameters
        ----------
        field
            heat_flux, burned_fraction (frames of shape (fy, fx)), temperature, wind_east or wind_north.
        indices
            (n,) time indices; None: all.
        ahead
            Maximum number of prefetched frames.

        Raises
        ------
        ValueError
            Indices are not integers, or there is no such field.
        IndexError
            An index is outside the run.
        """
    def fuel_rows(self, field: str, first: int, last: int) -> NDArray[np.float32]:
        """Read rows `first` to `last` - 1 of a field on the fuel grid: (last - first, fx).

        If the field is a .npy in C order, only these rows are read. `field` is surface_fuel or canopy_fuel
        (kg/m2), fuel_elevation (m), or one of the optional fields fuel_arrival_time (s, NaN if never) and
        fuel_category (fuel model numbers, NaN if unknown).

        Raises
        ------
        ValueError
            There is no such field.
        IndexError
            The rows are outside the grid.
        Error
            The run does not have the field, or it cannot be read.
        """
    def flux_range(self) -> tuple[float, float]:
        """Return the smallest and largest finite heat flux of the run, W/m2; (0, 0) without any."""
    def heat_released(self) -> NDArray[np.float64]:
        """Integrate fluxes above 0 over the complete run by the trapezoidal rule: (ny, nx) J/m2."""
    def arrival_time(self) -> NDArray[np.float64]:
        """Compute when the front passes the centre of each cell: (ny, nx) seconds since start; NaN if never.

        It is the run's fuel_arrival_time if there is one. Otherwise it is estimated from the heat flux with a
        resolution finer than the model times: from the time when a cell reaches 1 W/m2, the growth of its
        flux and the time course of its heat release. The mean error on the sample run with cells of 370 m is
        64 m (cpp/flux/arrival.hpp).
        """
    def fuel_arrival_time(self) -> NDArray[np.float64]:
        """Compute arrival times on the fuel grid: (fy, fx) seconds since start; NaN if never.

        Cells that burned before the start have negative times. The result is the run's field
        fuel_arrival_time if there is one, else `arrival_time` interpolated within the line where half of the
        surroundings has burned.
        """
