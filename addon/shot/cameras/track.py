"""Recorded flight tracks: GPX, KML and CSV files, and their alignment to the times of a shot.

Heights are above mean sea level, as the run's elevations are (no geoid is applied). A file without heights
lies on the ground; a drone keeps its clearance above it.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ... import files
from ...errors import input_error, reading
from ...run import times
from . import track_csv, track_xml
from .flight import Waypoints
from .path import Array
from .track_point import Point

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from firetwin_core import geo
    from firetwin_core.run import Run

    from ..frames import Frames

_READERS = {".gpx": track_xml.gpx, ".kml": track_xml.kml, ".csv": track_csv.points}
MOMENTS = {"own": "UTC", "start": "from frame 1", "shot": "over all frames"}


@dataclass(frozen=True)
class Track:
    """A recorded flight.

    Attributes
    ----------
    latitude, longitude, height, over_ground
        (n,) as in `Waypoints`.
    utc
        (n,) s since 1970, ascending; None if the file has no times.
    part
        (n,) fraction 0..1 of the shot, ascending; None if the file has none.
    """

    latitude: Array
    longitude: Array
    height: Array
    over_ground: NDArray[np.bool_]
    utc: Array | None = None
    part: Array | None = None

    def at(self, moments: str, run: Run, frames: Frames, frame: geo.LocalFrame) -> tuple[Waypoints, Array]:
        """Waypoints of the flight, and the frames' times (frames,) on the same scale.

        "own": recorded UTC is model time. "start": the first point is at the first frame, and the rest
        follows in recorded time. "shot": the first point is at the first frame and the last point at the last
        frame. Fractions of the shot apply as recorded. A track with neither spans the shot at constant speed.
        """
        if self.utc is not None and moments != "shot":
            first = times.utc(run, 0.0).timestamp() if moments == "own" else self.utc[0] - frames.first
            at, shown = self.utc - first, frames.times
        else:
            at, shown = self._parts(frame), np.linspace(0.0, 1.0, frames.count)
        return Waypoints(at, self.latitude, self.longitude, self.height, self.over_ground), shown

    def _parts(self, frame: geo.LocalFrame) -> Array:
        """Fraction (n,) of the shot at each point: as recorded, by time, or by distance."""
        if self.part is not None:
            return self.part
        if self.utc is not None:
            gone = self.utc - self.utc[0]
        else:
            place = frame.forward(self.latitude, self.longitude, self.height)
            gone = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(place, axis=0), axis=1)))
        return gone / max(gone[-1], 1.0e-9)

    def corners(self) -> list[tuple[float, float]]:
        """Latitude and longitude of the extreme points to each side."""
        ends = {int(f(v)) for f in (np.argmin, np.argmax) for v in (self.latitude, self.longitude)}
        return [(float(self.latitude[i]), float(self.longitude[i])) for i in sorted(ends)]

    def missed(self, run: Run, frames: Frames) -> str:
        """Warning text if the recorded times do not overlap the shot; else empty."""
        if self.utc is None:
            return ""
        flown = [datetime.fromtimestamp(self.utc[i], UTC) for i in (0, -1)]
        shown = [times.utc(run, t) for t in (frames.first, frames.last)]
        if flown[0] <= shown[1] and flown[1] >= shown[0]:
            return ""
        words = (" to ".join(f"{t:%Y-%m-%dT%H:%M:%SZ}" for t in pair) for pair in (flown, shown))
        return 'was flown {} and the frames show {}; write track_times = "start" or "shot"'.format(*words)


def read(path: Path) -> Track:
    """Read a flight track; the file's name tells its format.

    Raises
    ------
    InputError
        Names the file, the line and what to do.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise input_error(path, "is no .gpx, .kml or .csv file; save the track as one of them")
    with reading(path):
        try:
            state = path.stat()
        except FileNotFoundError:
            raise input_error(path, "no such track; see track in the scene file") from None
        files.check_text_size(path)
        return _read(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=16)
def _read(path: Path, _changed: int, _size: int) -> Track:
    return _validated(path, list(_READERS[path.suffix.lower()](path)))


def _validated(path: Path, points: Sequence[Point]) -> Track:
    """Validate points and make a track."""
    if not points:
        raise input_error(path, "contains no track: it needs points with latitude and longitude")
    for point in points:
        if not (abs(point.latitude) <= 90.0 and abs(point.longitude) <= 180.0):
            place = f"{point.latitude:g}, {point.longitude:g}"
            reason = f"{place} is not a latitude (-90 to 90) and longitude (-180 to 180)"
            raise input_error(path, reason, line=point.line)
    with_height = _all_or_none(path, points, "height", "a height", "give all points one, or none")
    with_moment = _all_or_none(path, points, "moment", "a time", "give all points one, or none")
    utc = part = None
    if with_moment:
        points = _rising(path, points)
        moments = np.array([_number(point.moment) for point in points])
        utc, part = (moments, None) if isinstance(points[0].moment, datetime) else (None, moments)
    latitude, longitude = (np.array([p[k] for p in points]) for k in (1, 2))
    height = np.array([p.height if with_height else 0.0 for p in points])
    over = np.array([p.over_ground or not with_height for p in points])
    return Track(latitude, longitude, height, over, utc, part)


def _all_or_none(path: Path, points: Iterable[Point], name: str, what: str, remedy: str) -> bool:
    """Return whether all points have an attribute.

    Raises
    ------
    InputError
        Some points have it and some do not.
    """
    lacking = [point for point in points if getattr(point, name) is None]
    if lacking and any(getattr(point, name) is not None for point in points):
        raise input_error(
            path, f"a point without {what} among others with one; {remedy}", line=lacking[0].line
        )
    return not lacking


def _rising(path: Path, points: Sequence[Point]) -> list[Point]:
    """Points with ascending times; duplicate points are merged."""
    dated = isinstance(points[0].moment, datetime)
    ascending = [points[0]]
    for point in points[1:]:
        if isinstance(point.moment, datetime) != dated:
            reason = "some points have a time and others a part of the shot (at); give all the same"
            raise input_error(path, reason, line=point.line)
        last = ascending[-1]
        if _number(point.moment) > _number(last.moment):
            ascending.append(point)
        elif point.moment != last.moment or point[1:4] != last[1:4]:
            reason = (
                f"is at {_text(point.moment)}, not later than the point before it; put the points in order"
            )
            raise input_error(path, reason, line=point.line)
    return ascending


def _number(moment: datetime | float | None) -> float:
    """Seconds since 1970 of a time; a fraction of the shot is returned unchanged."""
    assert moment is not None
    return moment.timestamp() if isinstance(moment, datetime) else moment


def _text(moment: datetime | float | None) -> str:
    if isinstance(moment, datetime):
        return times.iso(moment, "auto")
    return f"{moment:g}"
