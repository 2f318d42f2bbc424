"""Tour camera: flies from place to place, stays at each and looks at it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING

import numpy as np

from ....did_you_mean import suggestion
from ....run import labels
from ...schema import Where, key
from ...schema.bounds import AIM, ANGLE, CLEARANCE, HEIGHT, LENGTH
from .. import flight, path, targets
from ..path import Array, Path
from ._lens import LensRig

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ...frames import Frames
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

HEAD, IGNITION = "head", "ignition"
_FIRE = (HEAD, IGNITION)


@dataclass(frozen=True)
class Stop:
    """A place that a tour visits, and the way to the next one."""

    place: str = key(
        "", 'name of the place, "head" of the fire or its "ignition"; empty: latitude and longitude'
    )
    latitude: float | None = key(
        None, "latitude of the place", unit="degrees north", at_least=-90, at_most=90
    )
    longitude: float | None = key(
        None, "longitude of the place; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    stay: float = key(
        2.0, "time at the place; all times are scaled to fill the film", unit="s", at_least=0, at_most=1e6
    )
    travel: float = key(
        4.0, "time of flight to the next place, scaled with the film", unit="s", at_least=0.01, at_most=1e6
    )
    distance: float = key(1500.0, "horizontal distance from the place", **LENGTH)
    height: float = key(
        500.0, "camera height above the terrain or above the place, whichever is higher", **HEIGHT
    )
    bearing: float | None = key(
        None, "bearing of the camera from the place; default: the bearing from which it arrives", **ANGLE
    )
    target_height: float = key(0.0, "target height above the terrain", **AIM)


@dataclass(frozen=True)
class Tour(LensRig):
    """Perspective camera that visits places in order."""

    clearance: float = key(50.0, "minimum height above the terrain, also between frames", **CLEARANCE)
    over_ridges: bool = key(True, "rise until no ridge hides the place")
    places: File | None = key(  # noqa: RUF009
        None,
        "named places: GeoJSON, or CSV with name, latitude, longitude; default: places of the fire",
        affects=(),
    )
    stops: tuple[Stop, ...] = key((), "place that is visited")

    @classmethod
    def from_view(cls, view: View) -> Tour:
        """Stop at the centre of the view, with the camera at the eye."""
        latitude, longitude = view.aim
        stop = Stop(
            latitude=latitude,
            longitude=longitude,
            distance=max(view.away, 1.0),
            height=view.above,
            bearing=(view.heading + 180.0) % 360.0,
        )
        return cls(**view.lens, stops=(stop,))

    def validate(self) -> tuple[Where, str] | None:
        """Check that there are stops, each with a name or with a position."""
        if not self.stops:
            return ("stops",), "has no [[cameras.stops]]; a tour needs at least one"
        for i, stop in enumerate(self.stops):
            placed = stop.latitude is not None, stop.longitude is not None
            if stop.place and any(placed):
                return ("stops", i, "place"), "has a stop with a place and a position; leave one out"
            if not stop.place and not all(placed):
                return ("stops", i), "has a stop without a place; give it a place, or latitude and longitude"
        return None

    def coordinates(self) -> list[Place]:
        """Positions of stops without a name."""
        return [
            (("stops", i, "latitude"), stop.latitude, stop.longitude)
            for i, stop in enumerate(self.stops)
            if stop.latitude is not None and stop.longitude is not None
        ]

    def input_files(self) -> list[File]:
        """Its places."""
        return [] if self.places is None else [self.places]

    def coordinates_in(self, run: Run) -> list[Place]:
        """Positions of stops with a name."""
        known = self._known(run)
        named = ((i, known.get(stop.place.casefold())) for i, stop in enumerate(self.stops))
        return [(("stops", i, "place"), label.latitude, label.longitude) for i, label in named if label]

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check that names are known, and that each stop has a separate frame."""
        known = self._known(run)
        for i, stop in enumerate(self.stops):
            if stop.place and stop.place.casefold() not in (*known, *_FIRE):
                names = [*_FIRE, *(label.name for label in known.values())]
                hint = suggestion(stop.place, names) or f"; it knows {', '.join(names)}"
                return ("stops", i, "place"), f'stops at "{stop.place}", an unknown place{hint}'
        if len(self.stops) > frames.count:
            reason = f"has {len(self.stops)} stops in {frames.count} frames; use at least one frame per stop"
            return ("stops",), reason
        return None

    def follows_fire(self) -> bool:
        """Return whether its path depends on where the fire will be."""
        return any(stop.place == HEAD for stop in self.stops)

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Eased flight from stop to stop, raised smoothly above hills and ridges, looking at the places."""
        share = shares(self.stops, filming.frames.count)
        place = self._tracks(filming, ground)
        offset = _offsets(self.stops, place, share)
        level = np.array([_level(ground, *each) for each in zip(place, self.stops, offset, strict=True)])
        height = level + [[stop.height] for stop in self.stops]
        turn, away = share @ offset, share @ [stop.distance for stop in self.stops]
        aim = np.einsum("fs,sfx->fx", share, place)
        position = aim + away[:, None] * _direction(turn)
        position[:, 2] = np.einsum("fs,sf->f", share, height)
        target = aim.copy()
        target[:, 2] += share @ [stop.target_height for stop in self.stops]
        short = flight.short(ground, position, np.full(len(position), self.clearance))
        hidden = np.where(share.max(axis=1) == 1.0, path.hidden(ground, position, target), 0.0)
        position[:, 2] += path.eased(np.maximum(short, hidden) if self.over_ridges else short)
        half, rotation = self.half(camera, filming), path.look(position, target)
        return Path(camera, position, rotation, target, half, hidden=hidden, sensor=self.sensor_width)

    def _known(self, run: Run) -> dict[str, labels.Label]:
        """Named places by their names in small letters; none if no stop asks for one."""
        if all(stop.place.casefold() in ("", *_FIRE) for stop in self.stops):
            return {}
        places = labels.find(run, self.places)
        return {label.name.casefold(): label for label in places}

    def _tracks(self, filming: Filming, ground: Terrain) -> Array:
        """Points on the ground (stops, frames, 3) of the places in every frame; only the head moves."""
        stop_times, times = self._known(filming.run), filming.frames.times
        tracks = []
        for stop in self.stops:
            name = stop.place.casefold()
            if name == HEAD:
                tracks.append(targets.follow("head", ground, times, 0.0))
                continue
            if name == IGNITION:
                point = ground.point(*ground.geodetic(*targets.ignition(ground)))
            else:
                at = stop_times.get(name, stop)
                point = ground.point(at.latitude or 0.0, at.longitude or 0.0)
            tracks.append(np.repeat(point, len(times), axis=0))
        return np.array(tracks)


def shares(stops: Sequence[Stop], frames: int) -> Array:
    """Share (frames, stops) of each stop in each frame: 1 while the camera is there, eased between two.

    Stays begin and end at whole frames, so that each stop has a frame; with fewer frames than stops the last
    ones have none. The ease is of the fifth degree (Perlin 2002): speed and acceleration are 0 at its ends.
    """
    begin, end = _stays(stops[:frames], frames)
    result, frame = np.zeros((frames, len(stops))), np.arange(frames)
    for j, (first, last) in enumerate(zip(begin, end, strict=True)):
        result[first : last + 1, j] = 1.0
    for j, (left, come) in enumerate(zip(end[:-1], begin[1:], strict=True)):
        part = (frame[left : come + 1] - left) / (come - left)
        eased = part**3 * (part * (6.0 * part - 15.0) + 10.0)
        result[left : come + 1, j], result[left : come + 1, j + 1] = 1.0 - eased, eased
    return result


def _stays(stops: Sequence[Stop], frames: int) -> tuple[list[int], list[int]]:
    """First and last frame, from 0, of the stay at each stop."""
    way = np.array([[stop.stay, stop.travel] for stop in stops], np.float64).ravel()[:-1]
    at = np.append(0.0, np.cumsum(way))
    at = np.round(at / max(at[-1], 1e-9) * (frames - 1)).astype(int)
    begin, end = at[0::2].tolist(), at[1::2].tolist()
    for j in range(1, len(stops)):  # a flight takes a frame at least
        begin[j] = max(begin[j], end[j - 1] + 1)
        end[j] = max(end[j], begin[j])
    end[-1] = frames - 1
    begin[-1] = min(begin[-1], end[-1])
    for j in reversed(range(len(stops) - 1)):
        end[j] = min(end[j], begin[j + 1] - 1)
        begin[j] = min(begin[j], end[j])
    return begin, end


def _offsets(stops: Sequence[Stop], place: Array, share: Array) -> Array:
    """Bearing (stops,), radians, of the camera from each place; each turn is the shorter one."""
    at = np.argmax(share, axis=0)
    bearing = np.full(len(stops), np.pi)
    for j, stop in enumerate(stops):
        other = j - 1 if j else min(1, len(stops) - 1)
        east, north = (place[other, at[j]] - place[j, at[j]])[:2] * (1.0 if j else -1.0)
        if stop.bearing is not None:
            bearing[j] = np.radians(stop.bearing)
        elif np.hypot(east, north) > 1.0:
            bearing[j] = np.arctan2(east, north)
        elif j:
            bearing[j] = bearing[j - 1]
    return np.unwrap(bearing)


def _direction(bearing: Array) -> Array:
    """Horizontal unit vectors (n, 3) of bearings (n,), radians."""
    return np.stack([np.sin(bearing), np.cos(bearing), np.zeros(len(bearing))], axis=-1)


def _level(ground: Terrain, place: Array, stop: Stop, bearing: float) -> Array:
    """Height (frames,) of the ground under the camera at a stop or of the place (frames, 3), if higher."""
    spot = place + stop.distance * _direction(np.array([bearing]))
    return targets.smoothed(np.maximum(ground.up(spot[:, 0], spot[:, 1]), place[:, 2]))


RIG = Tour
