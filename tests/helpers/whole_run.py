"""Runs of any size and place, with elliptical or ragged fires, for tests of automatic framing."""

from pathlib import Path

import numpy as np
import ragged_spread
from firetwin.run import areas

TOML = """\
name = "Made up"
start = {start}
times_s = [{times}]
vertical = "orthometric"
[units]
elevation = "m"
"""


def write(
    folder: Path,
    *,
    cell=30.0,
    cells=64,
    at=(38.9, -120.6),
    start="2020-07-01T20:00:00Z",
    times=(0.0, 1800.0, 3600.0),
    fires=((0.0, 0.0, 0.0),),
    speed=0.3,
    wind=(4.0, 0.0),
    height=None,
    surface=0.6,
    canopy=0.0,
    arrival=True,
    lasts=600.0,
    seed=None,
    fine=1,
):
    """Write a run of square cells (m) about a place (degrees).

    Parameters
    ----------
    fires
        Ignitions: m east and north of the centre, and time, s.
    speed
        Rate of spread of the head, m/s; the rear has a fifth of it in wind.
    height
        Terrain elevation: a function of metres east and north; default: sea level.
    arrival
        Whether the run has arrival times; otherwise only heat flux.
    lasts
        Time that a cell gives off heat, s.
    seed
        Seed of a ragged spread (`ragged_spread`); None: ellipses.
    fine
        Fuel cells along a side of a cell.
    """
    north, east = areas.metres_per_degree(at[0])
    metres, small = _middles(cells, cell), _middles(cells * fine, cell / fine)
    x, y = np.meshgrid(metres, metres)
    fuel_x, fuel_y = np.meshgrid(small, small)
    if seed is None:
        came = np.min([when + _travel(fuel_x - e, fuel_y - n, speed, wind) for e, n, when in fires], axis=0)
    else:
        ground = np.zeros_like(fuel_x) if height is None else height(fuel_x, fuel_y)
        along = (0.0, 0.0) if wind is None else wind
        came = ragged_spread.arrival(
            fuel_x, fuel_y, ground, fires, lambda e, n: _travel(e, n, speed, wind), along, seed
        )
    came = np.where(came <= times[-1] + 1.0, came, np.nan)
    blocks = came.reshape(cells, fine, cells, fine)
    burns = [((blocks <= t) & (blocks > t - lasts)).mean((1, 3)) for t in times]
    flux = np.asarray(30e3 * np.array(burns), np.float32)
    fields = {
        "latitude": at[0] + metres / north,
        "longitude": at[1] + metres / east,
        "elevation": np.zeros_like(x) if height is None else height(x, y),
        "fuel_latitude": at[0] + small / north,
        "fuel_longitude": at[1] + small / east,
        "surface_fuel": np.full_like(fuel_x, surface),
        "canopy_fuel": np.full_like(fuel_x, canopy),
        "heat_flux": flux,
        "fuel_arrival_time": came if arrival else None,
        "wind_east": None if wind is None else np.full_like(flux, wind[0]),
        "wind_north": None if wind is None else np.full_like(flux, wind[1]),
    }
    folder.mkdir(parents=True)
    (folder / "run.toml").write_text(TOML.format(start=start, times=", ".join(map(str, times))))
    for name, values in fields.items():
        if values is not None:
            np.save(folder / f"{name}.npy", values)
    return folder


def _middles(count, size):
    """Metres of the middles of cells in a row about zero."""
    return (np.arange(count) - (count - 1) / 2) * size


def _travel(x, y, speed, wind):
    """Seconds from the origin to points: a circle without wind, else an ellipse from near its rear."""
    if wind is None or not np.any(wind):
        return np.hypot(x, y) / speed
    along = np.array(wind) / np.hypot(*wind)
    a, b = x * along[0] + y * along[1], y * along[0] - x * along[1]
    middle, long, wide = 0.4 * speed, 0.6 * speed, 0.3 * speed  # m/s
    # ((a - middle t) / long)^2 + (b / wide)^2 = t^2
    k = long**2 - middle**2
    return (np.sqrt((a * middle) ** 2 + k * (a**2 + (b * long / wide) ** 2)) - a * middle) / k
