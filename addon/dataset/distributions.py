"""Distributions of drawn values: each maps a number from 0 to 1 to a value, by its quantile function."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from statistics import NormalDist
from types import MappingProxyType
from typing import NamedTuple


@dataclass(frozen=True)
class Uniform:
    """Equal density from `low` to `high`."""

    low: float
    high: float

    def quantile(self, share: float) -> float:
        """Return the value below which this share of the draws lies."""
        return self.low + share * (self.high - self.low)


@dataclass(frozen=True)
class LogUniform:
    """Equal density of the logarithm from `low` to `high`, both positive."""

    low: float
    high: float

    def quantile(self, share: float) -> float:
        """Return the value below which this share of the draws lies."""
        value = math.exp(math.log(self.low) + share * math.log(self.high / self.low))
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class LogNormal:
    """Normal density of the logarithm, limited to `low` .. `high`.

    Attributes
    ----------
    median
        Median before the limits.
    factor
        Exponential of the standard deviation of the logarithm.
    """

    median: float
    factor: float
    low: float
    high: float

    def quantile(self, share: float) -> float:
        """Return the value below which this share of the draws lies; none is outside the limits."""
        normal = NormalDist(math.log(self.median), math.log(self.factor))
        least, most = (normal.cdf(math.log(limit)) for limit in (self.low, self.high))
        part = least + share * (most - least)
        value = math.exp(normal.inv_cdf(min(max(part, 1.0e-12), 1.0 - 1.0e-12)))
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class Choice:
    """One of several values, with relative weights (equal without)."""

    values: tuple[float, ...]
    weights: tuple[float, ...] = ()

    def quantile(self, share: float) -> float:
        """Return the value whose part of the total weight contains the share."""
        weights = self.weights or (1.0,) * len(self.values)
        left = share * sum(weights)
        for value, weight in zip(self.values, weights, strict=True):
            if left < weight:
                return value
            left -= weight
        return next(
            value for value, weight in zip(self.values[::-1], weights[::-1], strict=True) if weight > 0.0
        )


@dataclass(frozen=True)
class Constant:
    """Always the same value."""

    value: float

    def quantile(self, share: float) -> float:
        """Return the value."""
        return self.value


Distribution = Uniform | LogUniform | LogNormal | Choice | Constant
KINDS: Mapping[str, type] = MappingProxyType(
    {
        "uniform": Uniform,
        "log_uniform": LogUniform,
        "log_normal": LogNormal,
        "choice": Choice,
        "constant": Constant,
    }
)
"""Distributions by the name in a plan."""


class Value(NamedTuple):
    """A drawn value.

    Attributes
    ----------
    default
        Distribution without an entry in the plan. Sources: `docs/datasets.md`.
    unit
        Unit; "1" for a number without one.
    low, high
        Bounds of any distribution.
    help
        Description of one line.
    """

    default: Distribution
    unit: str
    low: float
    high: float
    help: str


VALUES: Mapping[str, Value] = MappingProxyType(
    {
        "time_since_ignition": Value(LogUniform(60, 864000), "s", 1, 864000, "model time after ignition"),
        "time_before_ignition": Value(LogUniform(60, 7200), "s", 1, 864000, "the same before ignition"),
        "time_after_end": Value(LogUniform(3600, 86400), "s", 1, 8640000, "time after the last fire"),
        "sun_elevation_day": Value(Uniform(-6, 65), "degrees", -6, 90, "height of the sun by day"),
        "sun_elevation_night": Value(Uniform(-60, -12), "degrees", -90, -6, "height of the sun by night"),
        "sun_elevation_low": Value(Uniform(0, 10), "degrees", -2, 20, "height of the sun for low_sun"),
        "sun_bearing": Value(Uniform(-180, 180), "degrees", -180, 180, "bearing of the sun from the view"),
        "sun_bearing_low": Value(Uniform(-30, 30), "degrees", -180, 180, "the same for low_sun"),
        "visibility": Value(LogNormal(30, 2, 3, 150), "km", 0.05, 300, "meteorological visibility"),
        "visibility_fog": Value(LogUniform(0.2, 2), "km", 0.05, 300, "the same in fog"),
        "visibility_dust": Value(LogUniform(0.5, 5), "km", 0.05, 300, "the same in dust"),
        "cloud_cover": Value(Uniform(0, 0.5), "1", 0, 1, "share of the sky with clouds"),
        "cloud_cover_cloud": Value(Uniform(0.5, 1), "1", 0, 1, "the same for cloud"),
        "night_lights": Value(LogUniform(5, 60), "1", 0, 10000, "number of lamps for night_lights"),
        "distance_tower": Value(LogUniform(1000, 30000), "m", 1, 200000, "distance of a tower"),
        "distance_drone": Value(LogUniform(50, 1500), "m", 1, 200000, "distance of a drone"),
        "distance_aircraft": Value(LogUniform(2000, 15000), "m", 1, 200000, "distance of an aircraft"),
        "distance_nadir": Value(LogUniform(100, 1500), "m", 1, 200000, "height of a camera that looks down"),
        "mast": Value(Uniform(15, 45), "m", 1, 500, "height of a tower above ground or trees"),
        "bearing_from_wind": Value(Uniform(-180, 180), "degrees", -180, 180, "bearing from upwind"),
        "pitch_tower": Value(Uniform(-5, 3), "degrees", -90, 90, "angle of the view above the horizon"),
        "pitch_drone": Value(Uniform(-90, -10), "degrees", -90, 90, "the same of a drone"),
        "pitch_aircraft": Value(Uniform(-45, -8), "degrees", -90, 90, "the same of an aircraft"),
        "roll": Value(Uniform(-2, 2), "degrees", -180, 180, "lean of the camera to the right"),
        "field_of_view": Value(Uniform(20, 90), "degrees", 1, 150, "horizontal field of view"),
        "frame_x": Value(Uniform(-0.8, 0.8), "1", -1, 1, "place of the fire from left to right"),
        "frame_y": Value(Uniform(-0.6, 0.6), "1", -1, 1, "place of the fire from bottom to top"),
        "edge": Value(Choice((0, 1), (0.9, 0.1)), "1", 0, 1, "1: the edge of the picture cuts the fire"),
        "ridge": Value(Choice((0, 1), (0.85, 0.15)), "1", 0, 1, "1: terrain may hide all flames"),
        "exposure": Value(Uniform(-0.7, 0.7), "stops", -10, 10, "error of the exposure"),
        "read_noise": Value(LogUniform(0.001, 0.01), "1", 0, 1, "read noise as a share of white"),
        "full_well": Value(LogUniform(3000, 30000), "electrons", 1, 1e7, "electrons at white (shot noise)"),
        "blur": Value(Uniform(0.3, 1.2), "pixels", 0, 50, "standard deviation of the blur"),
        "jpeg_quality": Value(Uniform(60, 95), "1", 1, 100, "quality of the JPEG file"),
        "netd": Value(Uniform(30, 80), "mK", 0, 10000, "temperature noise of the thermal camera"),
        "saturation": Value(Choice((150, 550)), "degrees C", 0, 3000, "highest temperature of its range"),
    }
)
"""All drawn values by name."""

DEFAULTS: Mapping[str, Distribution] = MappingProxyType(
    {name: value.default for name, value in VALUES.items()}
)


def fault(distribution: Distribution, value: Value) -> str | None:
    """Return why a distribution does not suit a value, as words that follow its name, or None."""
    if isinstance(distribution, Choice):
        if not distribution.values:
            return "needs at least one of its values"
        if distribution.weights and (
            len(distribution.weights) != len(distribution.values) or sum(distribution.weights) <= 0.0
        ):
            return "needs as many weights as values, with a positive sum"
        if any(weight < 0.0 for weight in distribution.weights):
            return "has a negative weight"
    if (
        isinstance(distribution, Uniform | LogUniform | LogNormal)
        and not distribution.low <= distribution.high
    ):
        return f"has low above high ({distribution.low:g}, {distribution.high:g}); exchange them"
    if isinstance(distribution, LogUniform | LogNormal) and distribution.low <= 0.0:
        return "needs a low above 0, as it is logarithmic"
    if isinstance(distribution, LogNormal) and (
        distribution.factor <= 1.0 or not distribution.low < distribution.median < distribution.high
    ):
        return "needs a factor above 1, and a median between low and high"
    ends = (
        distribution.values
        if isinstance(distribution, Choice)
        else (distribution.quantile(0.0), distribution.quantile(1.0))
    )
    if min(ends) < value.low or max(ends) > value.high:
        unit = "" if value.unit == "1" else f" {value.unit}"
        return f"must be from {value.low:g} to {value.high:g}{unit}, not {min(ends):g} to {max(ends):g}"
    return None
