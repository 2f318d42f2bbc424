"""Description of a run: the content of run.toml, with line and column of each fault."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from os import fsencode
from pathlib import Path
from typing import Any

from firetwin_core import InputError

from ..did_you_mean import suggestion
from ..errors import input_error
from ..escaped import escaped
from ..toml_text import loads, place
from . import times

_KEYS = (
    *("name", "start", "interval_s", "times_s", "mean_s", "vertical"),
    *("units", "no_data", "synthetic", "event", "source", "zone"),
)
_FAR = 1.0e6  # s, 12 days: beyond it the resolution of 32-bit floats is coarser than 1/16 s
_LONGEST = 60  # characters of a name in a message
_DENSITY = ("kg/m3", "kg/m^3", "kg/m³", "kg m-3", "kg m^-3")
_LOAD = ("kg/m2", "kg/m^2", "kg/m²", "kg m-2", "kg m^-2")
_FLUX = ("W/m2", "W/m^2", "W/m²", "W m-2", "W m^-2")
_KELVIN = ("K", "kelvin", "Kelvin", "degK", "deg K")
_SPEED = ("m/s", "m s-1", "m s^-1", "ms-1", "metres per second")
_METRES = ("m", "metre", "metres", "meter", "meters")
_NORTH = ("degrees_north", "degrees", "degree", "deg", "deg N")
_EAST = ("degrees_east", "degrees", "degree", "deg", "deg E")
UNITS = {
    **dict.fromkeys(("latitude", "fuel_latitude", "air_latitude"), _NORTH),
    **dict.fromkeys(("longitude", "fuel_longitude", "air_longitude"), _EAST),
    **dict.fromkeys(("elevation", "fuel_elevation", "height_3d"), _METRES),
    **dict.fromkeys(("surface_fuel", "canopy_fuel"), _LOAD),
    **dict.fromkeys(("temperature", "temperature_3d"), _KELVIN),
    **dict.fromkeys(("wind_east", "wind_north", "wind_east_3d", "wind_north_3d", "wind_up_3d"), _SPEED),
    "heat_flux": _FLUX,
    "smoke_3d": _DENSITY,
    "fuel_arrival_time": ("s", "second", "seconds", "sec", "secs"),
    "fuel_category": ("1", "number", "category", "class", "dimensionless"),
    "burned_fraction": ("1", "fraction", "share", "0..1", "dimensionless"),
}
"""Accepted spellings of the unit of each field; messages show the first one."""


@dataclass
class Description:
    """Content of run.toml, as arguments of `firetwin_core.run.open`.

    Attributes
    ----------
    start
        ISO 8601 UTC.
    offset
        Offset of `start` in run.toml, minutes east of UTC.
    vertical
        "orthometric" or "ellipsoidal".
    interval_s, times_s
        One of them is given: seconds between model times, or ascending seconds since `start`.
    zero_s
        Time at `start` in the run's files, s.
    mean_s
        Each heat flux is the mean over the seconds before its time; None: of the interval.
    no_data
        Value that marks missing data.
    zone
        Such as "Europe/Paris"; empty if not given.
    warnings
        One sentence each.
    """

    name: str
    start: str
    offset: int
    vertical: str
    interval_s: float | None = None
    times_s: list[float] = field(default_factory=list)
    zero_s: float = 0.0
    mean_s: float | None = None
    no_data: float | None = None
    synthetic: bool = False
    event: str = ""
    zone: str = ""
    warnings: list[str] = field(default_factory=list)


def parse(path: Path, content: bytes) -> Description:
    """Parse the content of the run.toml at `path`.

    Times far from their start, such as seconds since 1970, are counted from a later start, so that 32-bit
    floats keep fractions of a second.

    Raises
    ------
    InputError
        It is not TOML, a key is unknown or missing, a value has a wrong type or unit, or times do not ascend.
    """
    return _Reader(path, content).description()


class _Reader:
    def __init__(self, path: Path, content: bytes) -> None:
        self.path = fsencode(path).decode("utf-8", "backslashreplace")
        self.folder = fsencode(path.parent.name).decode("utf-8", "backslashreplace")
        try:
            self.text = content.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise self.error(
                f"not valid TOML: byte {error.start + 1:,} is not UTF-8; save it as UTF-8"
            ) from None
        self.values = loads(self.path, self.text)

    def description(self) -> Description:
        for key in self.values:
            if key not in _KEYS:
                raise self.error(self.unknown("key", key, _KEYS), key)
        start = self.start()
        offset = start.utcoffset() or timedelta()
        result = Description(
            name=self.of_type("name", str, "name must be a text in quotes", self.folder),
            start=times.iso(start, "auto"),
            offset=int(offset.total_seconds()) // 60,
            vertical=self.of_type("vertical", str, _VERTICAL, "orthometric"),
            interval_s=self.number("interval_s", _INTERVAL),
            mean_s=self.number("mean_s", _MEAN),
            no_data=self.number("no_data", "no_data must be a number"),
            synthetic=self.of_type("synthetic", bool, "synthetic must be true or false", False),
            event=self.of_type("event", str, "event must be a text in quotes", ""),
            zone=self.of_type("zone", str, "zone must be a text in quotes", ""),
        )
        if result.vertical not in ("orthometric", "ellipsoidal"):
            raise self.error(_VERTICAL, "vertical")
        if "vertical" not in self.values:
            assumed = 'vertical = "orthometric" (above sea level) is assumed'
            result.warnings.append(f"run.toml gives no vertical reference; {assumed}")
        if (result.mean_s or 0.0) < 0.0:
            raise self.error(_MEAN, "mean_s")
        self.of_type("source", dict, "source must be a table that describes the origin of the run", {})
        self.read_times(result, start)
        self.check_units()
        return result

    def start(self) -> datetime:
        value = self.values.get("start")
        if value is None:
            raise self.error(f"{_START}; add it")
        try:
            moment = datetime.fromisoformat(value.upper()) if isinstance(value, str) else value
            if isinstance(moment, datetime) and moment.tzinfo:
                moment.astimezone(UTC)
                return moment
        except (ValueError, OverflowError):
            pass
        raise self.error(_START, "start")

    def read_times(self, result: Description, start: datetime) -> None:
        if ("interval_s" in self.values) == ("times_s" in self.values):
            where = ("interval_s",) if "interval_s" in self.values else ()
            raise self.error(_ONE, *where)
        if result.interval_s is not None:
            if result.interval_s <= 0.0:
                raise self.error(_INTERVAL, "interval_s")
            return
        values = self.of_type("times_s", list, _TIMES, [])
        if not values:
            raise self.error(_TIMES, "times_s")
        for index, value in enumerate(values):
            time = _finite(value)
            if time is None:
                raise self.error(_TIMES, "times_s", index)
            if result.times_s and time <= result.times_s[-1]:
                reason = f"{_TIMES}; sort the times and the frames, and remove duplicates"
                raise self.error(reason, "times_s", index)
            result.times_s.append(time)
        _count_from_near(result, start)

    def check_units(self) -> None:
        for name, unit in self.of_type("units", dict, 'units must be a table of field = "unit"', {}).items():
            if name not in UNITS:
                raise self.error(self.unknown("field", name, UNITS), "units", name)
            if not isinstance(unit, str):
                raise self.error("a unit must be a text in quotes", "units", name)
            if unit not in UNITS[name]:
                reason = f"{name} is in '{_short(unit)}' but must be in '{UNITS[name][0]}'"
                raise self.error(f"{reason}; convert the field and change the unit here", "units", name)

    def unknown(self, kind: str, name: str, names: Any) -> str:
        return f"unknown {kind} '{_short(name)}'" + (suggestion(name, names) or "; remove it")

    def of_type(self, key: str, kind: type, reason: str, otherwise: Any) -> Any:
        value = self.values.get(key, otherwise)
        if type(value) is not kind:
            raise self.error(reason, key)
        return value

    def number(self, key: str, reason: str) -> float | None:
        if key not in self.values:
            return None
        number = _finite(self.values[key])
        if number is None:
            raise self.error(reason, key)
        return number

    def error(self, reason: str, *where: str | int) -> InputError:
        line, column = place(self.text, where) if where else (0, 0)
        return input_error(self.path, reason, line=line, column=column)


_START = "start must be a date and time with its offset from UTC, like 2014-09-17T04:45:00Z"
_VERTICAL = 'vertical must be "orthometric" or "ellipsoidal"'
_ONE = (
    "exactly one of interval_s (seconds between model times) and times_s (a list of seconds since start) "
    "is needed"
)
_INTERVAL = "interval_s must be a number of seconds above 0"
_MEAN = "mean_s must be a number of seconds, 0 for fluxes at their time"
_TIMES = "times_s must be a list of strictly ascending seconds since start"


def _short(text: str) -> str:
    text = escaped(text)
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "..."


def _finite(value: object) -> float | None:
    if not isinstance(value, int | float) or isinstance(value, bool):
        return None
    try:
        return float(value) if math.isfinite(value) else None
    except OverflowError:
        return None


def _count_from_near(result: Description, start: datetime) -> None:
    """Move the start to a full second near the first time if that is far from the start."""
    zero = math.floor(result.times_s[0])
    if abs(zero) < _FAR:
        return
    try:
        later = start.astimezone(UTC) + timedelta(seconds=zero)
    except OverflowError:
        return
    near = [time - zero for time in result.times_s]
    if all(one < other for one, other in pairwise(near)):  # rounding may make them equal
        result.start, result.zero_s, result.times_s = times.iso(later, "auto"), float(zero), near
