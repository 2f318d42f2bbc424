"""Model runs on disk."""

from collections.abc import Iterator
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

def read_grid(path: str | PathLike[str]) -> NDArray[np.float32]:
    """Read a text or .npy grid -> (ny, nx); every value is the float32 nearest to the one in the file.

    Text: numbers between blanks, tabs or single commas, of which one may end a row; `#` comments; LF or CRLF;
    exponents with E or D; nan and inf. .npy: float32, float64 and integers of 1 to 8 bytes, little- or
    big-endian, in C or Fortran order. One dimension is one row.

    Raises
    ------
    InputError
        Anything else, with line and column; and numbers too large for a float32.
    """

def open(folder: str | PathLike[str]) -> Run:
    """Open a run folder: checks run.toml, the axes and the shape of every field; frames stay on disk.

    Files are read as by `read_grid`. `start` may be a date and time of TOML or ISO 8601 in quotes, with its
    offset from UTC. Longitudes may count from -180, from 0, or over the antimeridian.
    """

class Frames(Iterator[NDArray[np.float32]]):
    """Frames (ny, nx) of a series, which worker threads read ahead; `Run.frames` makes them."""

    def __iter__(self) -> Frames: ...
    def __next__(self) -> NDArray[np.float32]: ...

class Run:
    """A model run on disk: what is small is read and checked when it is opened, frames when they are asked for."""

    @property
    def path(self) -> str:
        """Its folder."""
    @property
    def name(self) -> str:
        """What run.toml calls it."""
    @property
    def synthetic(self) -> bool:
        """True when run.toml says that the run is made up, not model output."""
    @property
    def zone(self) -> str:
        """Time zone that run.toml names ("Europe/Paris"), empty where it names none."""
    @property
    def offset(self) -> int:
        """Minutes east of UTC that run.toml's start is written with."""
    @property
    def event(self) -> str:
        """Name of the known fire that the run depicts ("king_fire"), empty when run.toml names none."""
    @property
    def start(self) -> str:
        """What times count from, ISO 8601 UTC: that of run.toml, or a second by the first time if farther from it
        than a million seconds, as of times since 1970; 32-bit floats would lose their fractions."""
    @property
    def vertical(self) -> str:
        """Either "orthometric" or "ellipsoidal"."""
    @property
    def times(self) -> NDArray[np.float64]:
        """Model times (nt,), seconds since start, ascending."""
    @property
    def latitude(self) -> NDArray[np.float64]:
        """(ny,) degrees north."""
    @property
    def longitude(self) -> NDArray[np.float64]:
        """(nx,) degrees east without a jump (179, 180, 181); the middle of the axis lies in -180..180."""
    @property
    def elevation(self) -> NDArray[np.float32]:
        """(ny, nx) metres."""
    @property
    def fuel_latitude(self) -> NDArray[np.float64]:
        """(fy,) degrees north."""
    @property
    def fuel_longitude(self) -> NDArray[np.float64]:
        """(fx,) degrees east, counted as `longitude` is."""
    @property
    def air_latitude(self) -> NDArray[np.float64]:
        """(ay,) degrees north of fields on levels: the run's own axis of that name, else `latitude`."""
    @property
    def air_longitude(self) -> NDArray[np.float64]:
        """(ax,) degrees east of fields on levels, counted as `longitude` is."""
    @property
    def surface_fuel(self) -> NDArray[np.float32]:
        """(fy, fx) kg/m2."""
    @property
    def canopy_fuel(self) -> NDArray[np.float32]:
        """(fy, fx) kg/m2."""
    @property
    def fuel_elevation(self) -> NDArray[np.float32]:
        """(fy, fx) metres: the run's own fuel_elevation field, else elevation resampled bilinearly."""
    @property
    def fields(self) -> list[str]:
        """Names of the fields that the run folder holds."""
    @property
    def warnings(self) -> list[str]:
        """What is odd but usable, one sentence each."""
    def heat_flux(self, index: int) -> NDArray[np.float32]:
        """(ny, nx) W/m2 at times[index]."""
    def burned_fraction(self, index: int) -> NDArray[np.float32]:
        """(fy, fx) 0..1, burned share of each fuel cell at times[index]; Error when the run has none."""
    def temperature(self, index: int) -> NDArray[np.float32]:
        """(ny, nx) K, bilinear between the places of the run's air; Error when the run has none."""
    def wind(self, index: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Eastward and northward (ny, nx) m/s, as `temperature`; Error when the run has none."""
    def has(self, field: str) -> bool:
        """Whether the run folder holds a field."""
    def smoke_3d(self, index: int) -> NDArray[np.float32]:
        """(nz, ay, ax) kg/m3 on terrain-following levels at times[index]; Error when the run has none."""
    def height_3d(self, index: int) -> NDArray[np.float32]:
        """(nz, ay, ax) m, heights of the levels, in the run's vertical; Error when the run has none."""
    def temperature_3d(self, index: int) -> NDArray[np.float32]:
        """(nz, ay, ax) K; Error when the run has none."""
    def smoke_3d_at(self, time: float) -> NDArray[np.float32]:
        """smoke_3d at a time (s) within the run, linear between the two model times around it."""
    def height_3d_at(self, time: float) -> NDArray[np.float32]:
        """height_3d at a time (s) within the run."""
    def temperature_3d_at(self, time: float) -> NDArray[np.float32]:
        """temperature_3d at a time (s) within the run."""
    def frames(self, field: str = "heat_flux", indices: ArrayLike | None = None, ahead: int = 8) -> Frames:
        """Frames (ny, nx) of a series, all or those at indices (n,), while worker threads read the next ones.

        At most `ahead` frames wait in memory, however long the run. `field` is "heat_flux", "burned_fraction",
        whose frames are (fy, fx), "temperature", "wind_east" or "wind_north". A frame that cannot be read raises InputError when its turn comes.
        Threads may share the iterator: each frame goes to one of them. Raises ValueError for indices that are
        not integers, IndexError for those outside of the run.
        """
    def fuel_rows(self, field: str, first: int, last: int) -> NDArray[np.float32]:
        """Rows `first` to `last`, which is left out, of a field of the fuel grid: (last - first, fx).

        Of a .npy in C order only these are read. `field` is surface_fuel, canopy_fuel (kg/m2),
        fuel_elevation (m), or what only some runs have: fuel_arrival_time (s, NaN where never) and
        fuel_category (numbers of fuel models, NaN where not said).

        Raises
        ------
        ValueError
            No such field. IndexError: no such rows. Error: the run has none, or it cannot be read.
        """
    def flux_range(self) -> tuple[float, float]:
        """Smallest and largest finite heat flux of the whole run, W/m2; 0 and 0 where none is finite."""
    def heat_released(self) -> NDArray[np.float64]:
        """(ny, nx) J/m2 over the whole run, fluxes above 0 integrated by the trapezoidal rule."""
    def arrival_time(self) -> NDArray[np.float64]:
        """(ny, nx) seconds since start when the front passes the centre of a cell, NaN where not in the run.

        From the run's own fuel_arrival_time where it has one. Else from the fluxes, between model times: when
        a cell first has the flux of a fire, 1 W/m2, how that grows and how the heat is released tell when the
        front is in its middle, 64 m off in the mean on the sample's cells of 370 m (cpp/flux/arrival.hpp).
        """
    def fuel_arrival_time(self) -> NDArray[np.float64]:
        """(fy, fx) seconds since start, NaN where never, negative where burned before the start.

        The run's own fuel_arrival_time field where it has one, else arrival_time() between the centres of
        cells, inside the line where half of the ground around has burned.
        """
