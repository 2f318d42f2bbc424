"""The sample's compact store, `sample.npz`: all data that expanding the run needs, in a few megabytes.

Heights are whole decimetres, fuel loads whole grams per square metre, arrival times whole seconds after the
start (NEVER: never burned), intensities whole tens of kW/m. All of it is synthetic; `note` in the file
says so.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .grid import FUEL_CELL_SIZE
from .history import SQUARE_METRES_PER_ACRE
from .weather import Channel

if TYPE_CHECKING:
    from .fuels import Fuels
    from .terrain import Terrain

PATH = Path(__file__).parent / "sample.npz"
START = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)  # 16 September 21:45 PDT
MINUTES = 1857  # to 18 September 04:42 PDT: 1,858 output times
NEVER = np.iinfo(np.int32).max
ACRES_PER_CELL = FUEL_CELL_SIZE**2 / SQUARE_METRES_PER_ACRE
NOTE = (
    "Synthetic. Terrain fitted to public spot heights and river lines of the King Fire country, invented "
    "fuels and weather, fire spread by pyretechnics 2026.10.20 tuned to the reported acreages. Made by "
    "`python -m firetwin.data.simulate`; not CAWFE output and not a record of the fire."
)


class FireSpread(NamedTuple):
    """A fire that spread over the fuel grid.

    Attributes
    ----------
    arrival : (fy, fx) float64, seconds after the start, negative in the initial perimeter, NaN never burned.
    intensity : (fy, fx) float32, kW/m, Byram's fireline intensity where the front passed.
    crown : (fy, fx) uint8, 0 surface fire or none, 1 passive, 2 active crown fire.
    """

    arrival: NDArray[np.float64]
    intensity: NDArray[np.float32]
    crown: NDArray[np.uint8]


class Sample(NamedTuple):
    """The store's content on the fuel grid (fy, fx), in SI units.

    `arrival` is in seconds after the start (NaN never burned, negative before the start), `intensity` in W/m,
    `crown` 0, 1 (passive) or 2 (active), `misfit` in metres per place, `rivers` name -> (row, column).
    """

    elevation: NDArray[np.float32]
    water: NDArray[np.bool_]
    surface: NDArray[np.float32]
    canopy: NDArray[np.float32]
    arrival: NDArray[np.float64]
    intensity: NDArray[np.float32]
    crown: NDArray[np.uint8]
    channel: Channel
    misfit: dict[str, float]
    rivers: dict[str, tuple[NDArray, NDArray]]


def save(path: Path, land: Terrain, fuel: Fuels, channel: Channel, fire: FireSpread) -> None:
    """Write the store; the same input gives the same bytes."""
    names = list(land.misfit)
    rivers = {f"river/{name}": np.array(cells, dtype=np.int16) for name, cells in land.rivers.items()}
    temporary = path.with_suffix(".tmp.npz")
    np.savez_compressed(
        temporary,
        note=np.array(NOTE),
        elevation=np.rint(land.elevation * 10).astype(np.int16),
        water=land.water,
        surface=np.rint(fuel.surface * 1000).astype(np.uint16),
        canopy=np.rint(fuel.canopy * 1000).astype(np.uint16),
        arrival=np.where(np.isfinite(fire.arrival), np.rint(np.nan_to_num(fire.arrival)), NEVER).astype(
            np.int32
        ),
        intensity=np.rint(np.minimum(fire.intensity, 655000) / 10).astype(np.uint16),
        crown=fire.crown,
        channel=np.array(channel, dtype=np.float16),
        places=np.array(names),
        misfit=np.array([land.misfit[name] for name in names], dtype=np.float32),
        **rivers,
    )
    temporary.replace(path)


def load(path: Path = PATH) -> Sample:
    """Read the store."""
    with np.load(path) as data:
        arrival = data["arrival"]
        return Sample(
            elevation=data["elevation"].astype(np.float32) / 10,
            water=data["water"],
            surface=data["surface"].astype(np.float32) / 1000,
            canopy=data["canopy"].astype(np.float32) / 1000,
            arrival=np.where(arrival == NEVER, np.nan, arrival),
            intensity=data["intensity"].astype(np.float32) * 1e4,
            crown=data["crown"],
            channel=Channel(*data["channel"].astype(np.float64)),
            misfit=dict(zip(data["places"].tolist(), data["misfit"].tolist(), strict=True)),
            rivers={name[6:]: tuple(data[name]) for name in data.files if name.startswith("river/")},
        )
