"""Globe camera: flies from space to the fire."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from firetwin_core import geo

from ....ellipsoid import enu_axes
from ...schema import Where, key
from ...schema.bounds import AIM, ANGLE, CLEARANCE, HEIGHT, LENGTH
from .. import clipping, flight, path, zoom
from ..path import Array, Path
from ._lens import LensRig
from .tour import HEAD, Stop, Tour

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from ...frames import Frames
    from ...sections.camera import CameraSettings
    from ...terrain.terrain import Terrain
    from . import Filming, Place
    from ._view import View

_WEST = 15.0  # degrees of longitude from the run to the beginning, by default
_LEAST = 1.0  # m of height over the place at both ends
_NEARLY_OPPOSITE = 19_000_000.0  # m; beyond, the shortest way is not certain
_TURNS = 0.25, 0.75  # parts of the flight over which its heading turns to the last one
_TERRAIN = 300_000.0  # m from the run within which there may be terrain


@dataclass(frozen=True)
class Globe(LensRig):
    """Perspective camera that flies from space to a place, along a great circle."""

    beyond: ClassVar[bool] = True
    begin_latitude: float | None = key(
        None,
        "latitude of the start; default: the centre of the run",
        unit="degrees north",
        at_least=-90,
        at_most=90,
    )
    begin_longitude: float | None = key(
        None,
        "longitude of the start; west is negative; default: 15 degrees west of the run",
        unit="degrees east",
        at_least=-180,
        at_most=180,
    )
    begin_height: float = key(
        2_000_000.0, "height of the start above the sea", unit="m", above=0, at_most=50_000_000
    )
    place: str = key("", 'name of the last place; empty: latitude and longitude, else the "head" of the fire')
    latitude: float | None = key(
        None, "latitude of the place", unit="degrees north", at_least=-90, at_most=90
    )
    longitude: float | None = key(
        None, "longitude of the place; west is negative", unit="degrees east", at_least=-180, at_most=180
    )
    distance: float = key(4000.0, "horizontal distance from the place at the end", **LENGTH)
    height: float = key(
        2000.0, "camera height at the end above the terrain or the place, whichever is higher", **HEIGHT
    )
    bearing: float | None = key(
        None,
        "bearing of the camera from the place at the end; default: the bearing from which it arrives",
        **ANGLE,
    )
    target_height: float = key(0.0, "target height above the terrain", **AIM)
    hold: float = key(
        1.0, "time at the start; all times are scaled to fill the film", unit="s", at_least=0, at_most=1e6
    )
    travel: float = key(8.0, "time of the flight, scaled with the film", unit="s", at_least=0.01, at_most=1e6)
    stay: float = key(2.0, "time at the end, scaled with the film", unit="s", at_least=0, at_most=1e6)
    clearance: float = key(50.0, "minimum height above the terrain, also between frames", **CLEARANCE)
    over_ridges: bool = key(True, "at the end, rise until no ridge hides the place")
    places: File | None = key(  # noqa: RUF009
        None,
        "named places: GeoJSON, or CSV with name, latitude, longitude; default: places of the fire",
        affects=(),
    )

    @classmethod
    def from_view(cls, view: View) -> Globe:
        """Flight that ends at the eye."""
        latitude, longitude = view.aim
        return cls(
            **view.lens,
            latitude=latitude,
            longitude=longitude,
            distance=max(view.away, 1.0),
            height=view.above,
            bearing=(view.heading + 180.0) % 360.0,
        )

    def validate(self) -> tuple[Where, str] | None:
        """Check that it has one place where it ends."""
        placed = self.latitude is not None, self.longitude is not None
        if self.place and any(placed):
            return ("place",), "has a place and a position; leave one out"
        if any(placed) and not all(placed):
            missing = "longitude" if placed[0] else "latitude"
            return ("latitude" if placed[0] else "longitude",), f"has a position without a {missing}; add it"
        return None

    def coordinates(self) -> list[Place]:
        """Position of its end, unless the end has a name."""
        return [(where[2:], north, east) for where, north, east in self._end().coordinates()]

    def coordinates_in(self, run: Run) -> list[Place]:
        """Position of its end, by name."""
        return [(where[2:], north, east) for where, north, east in self._end().coordinates_in(run)]

    def input_files(self) -> list[File]:
        """Its places."""
        return self._end().input_files()

    def validate_against(self, run: Run, frames: Frames) -> tuple[Where, str] | None:
        """Check that the place is known, and that it begins on this side of the Earth."""
        if invalid := self._end().validate_against(run, frames):
            return invalid[0][2:], invalid[1].replace("stops at", "ends at")
        middle = (run.latitude[0] + run.latitude[-1]) / 2, (run.longitude[0] + run.longitude[-1]) / 2
        away = geo.geodesic_inverse(*self._begin(*middle), *middle)[0]
        if not away < _NEARLY_OPPOSITE:
            reason = "begins nearly opposite to the run on the Earth; begin within 19,000 km of it"
            return ("begin_longitude",), reason
        return None

    def follows_fire(self) -> bool:
        """Return whether its path depends on where the fire will be."""
        return self._end().follows_fire()

    def path(self, camera: CameraSettings, filming: Filming, ground: Terrain) -> Path:
        """Flight from above the beginning to the last view, the view of a tour with one stop."""
        frame, part = ground.frame, self.parts(filming.frames.count)
        begin = self._begin(frame.latitude, frame.longitude)
        back = float(geo.geodesic_inverse(frame.latitude, frame.longitude, *begin)[1])
        end = self._end(back).path(camera, filming, ground)
        position, course = self._flown(ground, begin, end, part)
        position = self._lifted(ground, position)
        position = np.where((part == 1.0)[:, None], end.position, position)
        rotation = _views(ground, position, end, part, course)
        return Path(
            camera,
            position,
            rotation,
            end.target,
            end.half,
            hidden=end.hidden,
            sensor=self.sensor_width,
            clips=clipping.planes(position, ground),
            beyond=self.beyond,
        )

    def parts(self, frames: int) -> Array:
        """Part of the flight (frames,), 0 to 1, as it is felt, that is done in each frame."""
        if frames == 1:
            return np.ones(1)
        at = np.arange(frames) / (frames - 1) * (self.hold + self.travel + self.stay)
        return zoom.eased((at - self.hold) / self.travel)

    def _begin(self, latitude: float, longitude: float) -> tuple[float, float]:
        """Latitude and longitude where it begins, of a run with this middle."""
        west = (longitude - _WEST + 180.0) % 360.0 - 180.0
        return (
            latitude if self.begin_latitude is None else self.begin_latitude,
            west if self.begin_longitude is None else self.begin_longitude,
        )

    def _end(self, side: float | None = None) -> Tour:
        """Tour that stays where this camera ends; `side` is the bearing of the camera, if it has none."""
        stop = Stop(
            self.place or (HEAD if self.latitude is None else ""),
            self.latitude,
            self.longitude,
            distance=self.distance,
            height=self.height,
            bearing=side if self.bearing is None else self.bearing,
            target_height=self.target_height,
        )
        return Tour(
            focal_length=self.focal_length,
            sensor_width=self.sensor_width,
            clearance=self.clearance,
            over_ridges=self.over_ridges,
            places=self.places,
            stops=(stop,),
        )

    def _flown(
        self, ground: Terrain, begin: tuple[float, float], end: Path, part: Array
    ) -> tuple[Array, Array]:
        """Places (frames, 3) of the flight over ground without hills, and courses (frames,), degrees."""
        frame = ground.frame
        latitude, longitude, last = frame.reverse(end.position)
        floor = frame.reverse(end.target)[2] - self.target_height
        floor = np.minimum(floor, np.minimum(last, self.begin_height) - _LEAST)
        length, azimuth, _ = geo.geodesic_inverse(*begin, latitude, longitude)
        wide = 2.0 * end.half[0]
        share, width = zoom.flight(length, wide * (self.begin_height - floor), wide * (last - floor), part)
        north, east, course = geo.geodesic_direct(*begin, azimuth, share * length)
        return frame.forward(north, east, floor + width / wide), course

    def _lifted(self, ground: Terrain, position: Array) -> Array:
        """Raise the places smoothly above hills."""
        latitude, longitude, height = ground.frame.reverse(position)
        low = height < float(ground.fields.elevation.max()) + 2.0 * ground.rough + self.clearance
        low &= np.linalg.norm(position, axis=1) < _TERRAIN
        short = np.zeros(len(position))
        for frames in _runs(low):
            some = position[frames]
            short[frames] = flight.short(ground, some, np.full(len(some), self.clearance))
        return position + path.eased(short)[:, None] * _axes(ground, latitude, longitude)[:, 2]


def _runs(chosen: np.ndarray) -> list[slice]:
    """Find the runs of chosen frames, each with the frame before and after it."""
    at = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(int)))
    return [slice(max(int(a) - 1, 0), int(b) + 1) for a, b in at.reshape(-1, 2)]


def _axes(ground: Terrain, latitude: Array, longitude: Array) -> Array:
    """East, north and up (n, 3, 3) as rows, at places in degrees, in the scene."""
    here = enu_axes(np.radians(ground.frame.latitude), np.radians(ground.frame.longitude))
    return enu_axes(np.radians(latitude), np.radians(longitude)) @ here.T


def _views(ground: Terrain, position: Array, end: Path, part: Array, course: Array) -> Array:
    """Rotations (frames, 3, 3): towards the place, with a level horizon all the way.

    From 2,000 km and 15 degrees away the Earth's limb is above the place in the picture. Heading and angle
    below the horizon refer to the vertical of the place at each point. The heading turns the shorter way from
    the great circle to its last value while the place is almost below the camera.
    """
    latitude, longitude, _ = ground.frame.reverse(position)
    axes = _axes(ground, latitude, longitude)
    east, north, above = np.einsum("nij,nj->in", axes, end.target - position)
    tilt = np.arctan2(-above, np.hypot(east, north))
    there = ground.frame.reverse(end.position)
    last = np.einsum("nij,nj->in", _axes(ground, *there[:2]), end.target - end.position)
    turn = np.arctan2(last[0], last[1]) - np.radians(course)
    turn = np.unwrap(np.arctan2(np.sin(turn), np.cos(turn)))
    heading = np.radians(course) + turn * _share(part, *_TURNS)
    return _turned(axes, heading, tilt)


def _share(part: Array, low: float, high: float) -> Array:
    """0 up to `low`, 1 from `high` on, and the ease of the fifth degree between (Perlin 2002)."""
    x = np.clip((part - low) / (high - low), 0.0, 1.0)
    return x**3 * (x * (6.0 * x - 15.0) + 10.0)


def _turned(axes: Array, heading: Array, tilt: Array) -> Array:
    """Rotations (n, 3, 3), columns right, up and back, of views that lie level in local axes (n, 3, 3)."""
    s, c, zero = np.sin(heading), np.cos(heading), np.zeros(len(heading))
    ahead = np.stack([np.cos(tilt) * s, np.cos(tilt) * c, -np.sin(tilt)], axis=-1)
    right = np.stack([c, -s, zero], axis=-1)
    local = np.stack([right, np.cross(-ahead, right), -ahead], axis=-1)
    return np.swapaxes(axes, 1, 2) @ local


RIG = Globe
