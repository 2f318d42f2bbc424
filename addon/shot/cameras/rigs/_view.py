"""What somebody sees who wants a camera there: what kinds of camera are made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict


class LensKeys(TypedDict):
    """The keys of a lens, mm."""

    focal_length: float
    sensor_width: float


@dataclass(frozen=True)
class View:
    """A place to look from, and what is looked at.

    Attributes
    ----------
    latitude, longitude, height
        Of the eye, degrees and m above the sea.
    above
        Of the eye above the ground under it, m, above 0.
    heading, tilt, roll
        Bearing clockwise from north, angle under the horizon and lean to the right, degrees.
    aim
        Latitude and longitude of the ground in the middle of the view; what is before the eye where that
        looks past the ground.
    away, rise
        How far the aim is over the ground, and how much higher than it the eye is, m.
    focal_length, sensor_width
        Of a lens that shows as much from left to right, mm.
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
        """The keys of a lens."""
        return {"focal_length": self.focal_length, "sensor_width": self.sensor_width}

    @property
    def width(self) -> float:
        """Width of what is seen at the aim, m."""
        return (self.away**2 + self.rise**2) ** 0.5 * self.sensor_width / self.focal_length
