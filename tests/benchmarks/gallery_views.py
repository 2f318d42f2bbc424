"""A plain scene file for any run: the busiest moment, and a camera of each of the gallery's kinds.

Stands in for `firetwin new` where that is not there, as in the pictures from before it.
"""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from firetwin.run import times
from firetwin.run.areas import metres_per_degree
from firetwin.shot import overview, sun
from firetwin_core.run import Run
from firetwin_core.run import open as open_run
from numpy.typing import NDArray

_BURNED = 0.25  # of the area at the end: no moment before this is filmed
_LOW = 12.0  # degrees over the horizon that the sun of a day's pictures has at least
DAY, NIGHT = 15.5, 22.5  # hours of local solar time that clocks are moved to

SCENE = """# A scene that tests/benchmarks/gallery.py made.
run = "{run}"
cache = "{cache}"
[time]
start = {moment}
frames = 1
zone = "UTC"
[render]
resolution = [{width}, {height}]
samples = {samples}
passes = ["rgb"]
"""
VIEW = """[[cameras]]
name = "{name}"
{passes}kind = "drone"
over_ridges = true
focal_length = {lens}
[[cameras.keys]]
latitude = {latitude:.6f}
longitude = {longitude:.6f}
height = {height:.0f}
target = "point"
target_latitude = {target_latitude:.6f}
target_longitude = {target_longitude:.6f}
target_height = {target_height:.0f}
"""
ABOVE = """[[cameras]]
name = "satellite"
kind = "satellite"
swath = {swath:.0f}
[[cameras.keys]]
latitude = {latitude:.6f}
longitude = {longitude:.6f}
"""


@dataclass(frozen=True)
class Spot:
    """What the cameras are placed by.

    Attributes
    ----------
    second
        The moment, s since the run's start.
    middle, head, flank
        Latitude and longitude of what burned, of where it burns most and of where its side burns, degrees.
    length
        Of the burned area's diagonal, m.
    """

    second: float
    middle: NDArray
    head: NDArray
    flank: NDArray
    length: float

    @classmethod
    def of(cls, run: Run) -> Spot:
        """At the run's `busiest` moment."""
        arrival, index = np.asarray(run.fuel_arrival_time()), busiest(run)
        second = float(run.times[index])
        heat = np.nan_to_num(np.asarray(run.heat_flux(index), np.float64))
        latitude, longitude = np.asarray(run.latitude), np.asarray(run.longitude)
        north, east = metres_per_degree(float(latitude.mean()))
        rows, columns = np.nonzero(heat > 0.2 * heat.max())
        place = np.stack([latitude[rows] * north, longitude[columns] * east], 1)
        inside = np.isfinite(arrival) & (arrival <= second)
        fine = (
            np.asarray(run.fuel_latitude) * north,
            np.asarray(run.fuel_longitude) * east,
        )
        old = np.stack([axis[each] for axis, each in zip(fine, np.nonzero(inside), strict=True)], 1)
        low, high = old.min(axis=0), old.max(axis=0)
        begun = old[np.argmin(arrival[inside])]
        head = place[np.argmax(np.hypot(*(place - begun).T))]
        way = (head - begun) / max(float(np.hypot(*(head - begun))), 1.0)
        middle = 0.5 * (low + high)
        side = place[np.argmax(np.abs((place - middle) @ np.array([-way[1], way[0]])))]
        degrees = np.array([north, east])
        length = float(np.hypot(*(high - low)))
        return cls(second, middle / degrees, head / degrees, side / degrees, length)


def busiest(run: Run) -> int:
    """Index of the time of most heat, once enough has burned, by day where the fire burns by day at all."""
    seconds, arrival = np.asarray(run.times), np.asarray(run.fuel_arrival_time())
    burned = [float((arrival <= time).sum()) for time in seconds]
    late = [k for k, area in enumerate(burned) if area >= _BURNED * burned[-1]]
    late = [k for k in late if sun.at(run, float(seconds[k]))[1] > _LOW] or late
    late = late[:: max(len(late) // 40, 1)]
    return late[int(np.argmax([float(np.nansum(run.heat_flux(k))) for k in late]))]


def scene(path: Path, run: Path, width: int, samples: int) -> Path:
    """Write a scene file with overview, drone, flank and satellite."""
    opened = open_run(run)
    spot = Spot.of(opened)
    north, east = metres_per_degree(float(spot.middle[0]))
    degrees = np.array([north, east])
    blows = overview.blowing(opened)[::-1]  # north, east
    across = np.array([blows[1], -blows[0]])
    out = spot.flank - spot.middle
    out = out * degrees / max(float(np.hypot(*(out * degrees))), 1.0)
    moment = times.moment(opened, spot.second).astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    text = SCENE.format(
        run=run.resolve(),
        cache=path.with_suffix(".cache").resolve(),
        moment=moment,
        width=width,
        height=width * 9 // 16,
        samples=samples,
    )
    near = float(np.clip(0.35 * spot.length, 150.0, 2500.0))
    close = float(np.clip(0.12 * spot.length, 60.0, 300.0))
    views = {
        "overview": (
            spot.middle,
            -1.1 * spot.length * blows,
            0.3 * spot.length,
            0.05 * spot.length,
            28,
        ),
        "drone": (
            spot.head,
            near * (across - 0.7 * blows) / 1.22,
            0.4 * near,
            0.05 * near,
            28,
        ),
        "flank": (spot.flank, close * out, 0.35 * close, 3.0, 28),
    }
    for name, (aim, away, height, above, lens) in views.items():
        place = aim + away / degrees
        text += VIEW.format(
            name=name,
            passes='passes = ["rgb", "thermal"]\n' if name == "overview" else "",
            lens=lens,
            latitude=place[0],
            longitude=place[1],
            height=height,
            target_latitude=aim[0],
            target_longitude=aim[1],
            target_height=above,
        )
    text += ABOVE.format(swath=2.4 * spot.length, latitude=spot.middle[0], longitude=spot.middle[1])
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def is_day(run: Path, moment: datetime) -> bool:
    """Whether a run's moment is by day."""
    opened = open_run(run)
    place = (float(np.mean(axis)) for axis in (opened.latitude, opened.longitude))
    return sun.angles(*place, moment)[1] > _LOW


def moved(run: Path, folder: Path, moment: datetime, hour: float) -> timedelta:
    """Make the same fire with its clock moved, so that a moment of it comes at an hour; what it is moved by.

    The fields of the run in `folder` are further names of the run's files.
    """
    opened = open_run(run)
    solar = moment.astimezone(UTC) + timedelta(hours=float(np.mean(opened.longitude)) / 15.0)
    by = timedelta(hours=(hour - solar.hour - solar.minute / 60.0) % 24.0)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for file in run.resolve().iterdir():
        if file.suffix == ".npy":
            _linked(file, folder / file.name)
    start = times.moment(opened, 0.0).astimezone(UTC) + by
    said = (run / "run.toml").read_text(encoding="utf-8")
    said = re.sub(r"^event = .*$", "", said, flags=re.MULTILINE)  # its dated reports are of the true clock
    stamp = f"start = {start:%Y-%m-%dT%H:%M:%S.%f}Z"
    said = re.sub(r"^start = .*$", stamp, said, count=1, flags=re.MULTILINE)
    (folder / "run.toml").write_text(said, encoding="utf-8")
    return by


def _linked(file: Path, name: Path) -> None:
    """A second name of a file, or a copy where its disk has no such thing."""
    try:
        os.link(file, name)
    except OSError:
        shutil.copyfile(file, name)
