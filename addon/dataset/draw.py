"""Draw of one sample: the values from which it is rendered."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from .hashing import integer


@dataclass(frozen=True)
class DrawnCamera:
    """Camera of a sample; poses are in the run's local frame (`run.frame.local_frame`).

    Attributes
    ----------
    kind
        One of `plan.CAMERAS`.
    site
        Group of a camera for splits: a tower, or the flight of all cameras of one kind at one moment.
    position
        (3,) east, north and up, m.
    latitude, longitude, height
        The same position, degrees and m above sea level.
    heading, tilt, roll
        Bearing clockwise from north, angle below the horizon, and lean to the right, degrees: arguments of
        `shot.cameras.rotation.turned`.
    field_of_view
        Horizontal, degrees.
    """

    kind: str
    site: str
    position: tuple[float, float, float]
    latitude: float
    longitude: float
    height: float
    heading: float
    tilt: float
    roll: float
    field_of_view: float


@dataclass(frozen=True)
class Draw:
    """Draw of one sample.

    Attributes
    ----------
    seed, index, attempt
        Seed of the data set, number of the sample from 1, and number of the accepted try from 0.
    rejects
        Reason of each earlier try.
    place, run, path
        Place, name of the run, and its folder or scene file.
    kind
        "fire", or one of `plan.NEGATIVES`. All negatives except "burned_out" precede the ignition.
    night
        The sun is drawn from `sun_elevation_night`.
    split
        "train", "val" or "test".
    moment
        Number of the run's model time, from 0, of a sample with fire. Samples of a run with equal moments
        have equal `time`. -1 is before the first fire, -2 after the last one.
    time
        Model time, s. It can lie outside of the run's times if the sample has no fire.
    since_ignition
        Time since the first ignition, s; negative before it.
    utc
        The model time as a date.
    camera
        The camera.
    target
        (3,) point on the front at which the camera was aimed, m in the run's local frame.
    distance
        Distance from the camera to the target, m.
    sun_elevation, sun_azimuth
        Direction to the sun, degrees; azimuth clockwise from north. They do not follow from `utc`.
    visibility
        Meteorological visibility of the air without smoke, km; through fog or dust for these kinds.
    cloud_cover
        Share of the sky with clouds, 0..1.
    lamps
        Number of lamps on the ground; 0 except for the kind "night_lights".
    values
        All drawn values that the sample uses, by name, in the units of `distributions.VALUES`. Each sample
        has exposure, read_noise, full_well, blur, jpeg_quality, netd and saturation of the sensor.
    """

    seed: int
    index: int
    attempt: int
    rejects: tuple[str, ...]
    place: str
    run: str
    path: Path
    kind: str
    night: bool
    split: str
    moment: int
    time: float
    since_ignition: float
    utc: datetime
    camera: DrawnCamera
    target: tuple[float, float, float]
    distance: float
    sun_elevation: float
    sun_azimuth: float
    visibility: float
    cloud_cover: float
    lamps: int
    values: Mapping[str, float]

    @property
    def name(self) -> str:
        """Name of the sample's files: six digits."""
        return f"{self.index:06d}"

    @property
    def has_fire(self) -> bool:
        """Return whether the sample shows fire and smoke."""
        return self.kind == "fire"

    def random_seed(self, name: str) -> int:
        """Return a seed of 63 bits for a random process of the sample, such as the noise of the sensor."""
        return integer(self.seed, self.index, self.attempt, name) >> 1

    def plain(self) -> dict[str, Any]:
        """Return the draw as values of JSON; the path of the run is omitted, as it depends on the machine."""
        found = asdict(self) | {"values": dict(self.values), "utc": self.utc.isoformat()}
        del found["path"]
        return found
