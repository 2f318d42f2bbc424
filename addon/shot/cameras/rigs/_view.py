"""View of a person in the viewport, from which cameras are made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict


class LensKeys(TypedDict):
    """The keys of a lens, mm."""

    focal_length: float
    sensor_width: float


@dataclass(frozen=True)
class View:
    """Viewpoint and look-at point.

    Attributes
    ----------
    latitude, longitude, height
        Eye position, degrees and m above the sea.
    above
        Eye height above the ground, m, greater than 0.
    heading, tilt, roll
        Bearing clockwise from north, angle below the horizon and lean to the right, degrees.
    aim
        Latitude and longitude of the ground at the centre of the view; of the point in front of the eye if
        the view misses the ground.
    away, rise
        Horizontal distance of the aim, and height of the eye above it, m.
    focal_length, sensor_width
        Lens with the same horizontal angle of view, mm.
    """

    latitude: float
    longitude: float
    height: float
    above: float
    heading: float
    tilt: float
    roll: float
    aim: tuple[float, float]
    away: float
    rise: float
    focal_length: float
    sensor_width: float

    @property
    def lens(self) -> LensKeys:
        """Lens keys."""
        return {"focal_length": self.focal_length, "sensor_width": self.sensor_width}

    @property
    def width(self) -> float:
        """Width of the view at the aim, m."""
        return (self.away**2 + self.rise**2) ** 0.5 * self.sensor_width / self.focal_length
