"""Coordinates as users write them: decimal degrees, degrees and minutes, degrees, minutes and seconds."""

from __future__ import annotations

import re

_NUMBER = r"\s*(-?\d+(?:\.\d*)?)\s*°?\s*"
_PAIR = re.compile(rf"{_NUMBER}([NS]?)[\s,;]*(?<=[\sNSns,;]){_NUMBER}([EW]?)\s*", re.IGNORECASE)
_ANGLE = re.compile(
    r"(?P<degrees>\d{1,3})(?:\s*[°d:]\s*|\s+)"
    r"(?P<minutes>\d{1,2}(?:\.\d*)?)(?:\s*['\u2032\u2019m:]\s*|\s+|$)"
    r"(?:(?P<seconds>\d{1,2}(?:\.\d*)?)\s*(?:\"|''|\u2033|\u201d|s(?=\W|$))?\s*)?",
    re.IGNORECASE,
)
_HALVES = (
    re.compile(
        r"(?P<latitude>[^NSEW]+)(?P<ns>[NS])[\s,;]*(?P<longitude>[^NSEW]+)(?P<ew>[EW])", re.IGNORECASE
    ),
    re.compile(r"(?P<ns>[NS])(?P<latitude>[^NSEW]+)(?P<ew>[EW])(?P<longitude>[^NSEW]+)", re.IGNORECASE),
)


def parse(text: str) -> tuple[float, float] | None:
    """Parse latitude and longitude, degrees north and east; None if the text has none.

    Minutes and seconds need hemisphere letters before or after the numbers: 38 46 could otherwise be two
    coordinates.
    """
    return _decimal(text) or _sexagesimal(text.strip())


def _decimal(text: str) -> tuple[float, float] | None:
    match = _PAIR.fullmatch(text)
    if match is None:
        return None
    latitude = float(match[1]) * (-1.0 if match[2].upper() == "S" else 1.0)
    longitude = float(match[3]) * (-1.0 if match[4].upper() == "W" else 1.0)
    return _validate(latitude, longitude, 360.0)


def _sexagesimal(text: str) -> tuple[float, float] | None:
    match = next((found for pattern in _HALVES if (found := pattern.fullmatch(text))), None)
    if match is None:
        return None
    latitude, longitude = (_angle(match[name].strip(" ,;")) for name in ("latitude", "longitude"))
    if latitude is None or longitude is None:
        return None
    south, west = match["ns"].upper() == "S", match["ew"].upper() == "W"
    return _validate(-latitude if south else latitude, -longitude if west else longitude, 180.0)


def _angle(text: str) -> float | None:
    """Convert degrees, minutes and seconds to degrees; None if a value is too large or invalid."""
    match = _ANGLE.fullmatch(text)
    if match is None:
        try:
            return float(text.rstrip("° ")) if re.fullmatch(r"\d+(\.\d*)?\s*°?", text) else None
        except ValueError:
            return None
    minutes, seconds = match["minutes"], match["seconds"]
    if float(minutes) >= 60.0 or (seconds and ("." in minutes or float(seconds) >= 60.0)):
        return None
    return float(match["degrees"]) + float(minutes) / 60.0 + float(seconds or 0.0) / 3600.0


def _validate(latitude: float, longitude: float, most: float) -> tuple[float, float] | None:
    return (latitude, longitude) if abs(latitude) <= 90.0 and abs(longitude) <= most else None
