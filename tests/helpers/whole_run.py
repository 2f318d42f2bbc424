"""Runs of any size and place, with elliptical fires, for tests of automatic framing."""

from pathlib import Path

import numpy as np
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
):
    """Write a run of square cells (m) about a place (degrees); the fuel grid is the model's.

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
    """
    north, east = areas.metres_per_degree(at[0])
    metres = (np.arange(cells) - (cells - 1) / 2) * cell
    x, y = np.meshgrid(metres, metres)
    came = np.min([when + _travel(x - e, y - n, speed, wind) for e, n, when in fires], axis=0)
    came = np.where(came <= times[-1] + 1.0, came, np.nan)
    flux = np.array([np.where((came <= t) & (came > t - lasts), 30e3, 0.0) for t in times], np.float32)
    fields = {
        "latitude": at[0] + metres / north,
        "longitude": at[1] + metres / east,
        "elevation": np.zeros_like(x) if height is None else height(x, y),
        "fuel_latitude": at[0] + metres / north,
        "fuel_longitude": at[1] + metres / east,
        "surface_fuel": np.full_like(x, surface),
        "canopy_fuel": np.full_like(x, canopy),
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
