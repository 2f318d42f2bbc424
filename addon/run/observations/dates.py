"""Dates of observations, from the properties or the name of a file, in various formats."""

from __future__ import annotations

import re
from datetime import UTC, date, datetime, timedelta
from pathlib import Path

from ...errors import UsageError, input_error
from .feature import Feature, finite

NAMES = (
    *(
        "valid_at",
        "poly_polygondatetime",
        "poly_datecurrent",
        "perimeterdatetime",
        "perdattime",
        "datecurrent",
    ),
    *("polygondatetime", "pointdatetime", "polygondat", "pointdatet", "datecurren", "createdate"),
    *("date_time", "datetime", "timestamp", "time", "t", "when", "end", "date", "perimeterdate", "perdate"),
)
"""Properties with the date, in lower case, the most reliable first: ForeFire's, NIFC's, GeoMAC's, NWCG's
(shapefiles truncate names to ten letters), then plain ones."""

_FORMS = (
    *("%m/%d/%Y %I:%M:%S %p", "%m/%d/%Y %I:%M %p", "%m/%d/%Y %H:%M:%S", "%m/%d/%Y %H:%M"),
    *("%Y/%m/%d %H:%M:%S.%f", "%Y/%m/%d %H:%M:%S", "%Y/%m/%d %H:%M", "%Y%m%d %H%M", "%Y%m%d%H%M"),
    "%a, %d %b %Y %H:%M:%S",
)
_ZONE = re.compile(r"\s*(Z|UTC|GMT|[+-]\d\d:?\d\d|(?<=\d)[+-]\d\d)$")
_IN_NAME = re.compile(
    r"(?<!\d)(\d{4})-?(\d\d)-?(\d\d)[T_ -]?(\d\d)[:h-]?(\d\d)(?:[:-]?(\d\d))?(Z|[+-]\d{4})?(?!\d)"
)


def without(name: str | Path) -> tuple[Path, datetime | None]:
    """Split ``FILE@TIME`` into file and time; a file whose own name has an ``@`` is not split.

    Raises
    ------
    UsageError
        The text after the ``@`` is not a time.
    """
    head, mark, tail = str(name).rpartition("@")
    if not mark or Path(name).exists():
        return Path(name), None
    moment = _moment(tail)
    if moment is None:
        raise UsageError(f'"{tail}" after the @ of {head} is not a time such as 2014-09-18T04:00-07:00')
    return Path(head), moment[0]


def parse(path: Path, feature: Feature, assumptions: dict[str, None]) -> datetime:
    """Parse the date of a feature in UTC; assumptions are added to `assumptions`.

    Raises
    ------
    InputError
        The date is missing, or has no hour: a fire can double its area within a day.
    """
    known = {key.lower(): value for key, value in feature.properties.items()}
    days = ""
    for name in NAMES:
        value = known.get(name)
        if value is None or value == "":
            continue
        moment = _moment(value)
        if moment is None:
            days = days or f'{name} = "{value}"'
            continue
        if not moment[1]:
            assumptions[f"{path.name}: {name} has no zone and is taken as UTC"] = None
        return moment[0]
    if moment := _of_name(path.stem):
        zone = "" if moment[1] else " and UTC"
        assumptions[f"{path.name}: the moment is taken from the file's name{zone}"] = None
        return moment[0]
    what = f"{days} is not a date with an hour" if days else f"none of {', '.join(NAMES[:6])} ... is there"
    where = f"{feature.place}: " if feature.place else ""
    raise input_error(path, f"{where}has no date ({what}); write {path.name}@2014-09-18T04:00-07:00")


def _moment(value: object) -> tuple[datetime, bool] | None:
    """Parse a time: UTC, and whether a zone was given; None without a time, or for a day without an hour."""
    try:
        return _read(value)
    except OverflowError:  # before the year 1, or after 9999
        return None


def _read(value: object) -> tuple[datetime, bool] | None:
    if isinstance(value, datetime):
        return (value if value.tzinfo else value.replace(tzinfo=UTC)).astimezone(
            UTC
        ), value.tzinfo is not None
    if isinstance(value, date | bool):
        return None
    if isinstance(value, str):
        return _text(value)
    number = finite(value)
    return _epoch(number) if number is not None else None


def _epoch(number: float) -> tuple[datetime, bool] | None:
    """Parse an epoch time: ArcGIS writes milliseconds since 1970, others seconds; 20140918 is not a time."""
    seconds = number / 1e3 if abs(number) >= 1e11 else number
    if seconds < 3e8:  # before 1979, earlier than any satellite: a day or another number
        return None
    return datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=seconds), True


def _text(value: str) -> tuple[datetime, bool] | None:
    text = " ".join(value.split())
    if re.fullmatch(r"\d{13}|\d{10}", text):
        return _epoch(float(text))
    if len(text) > 10 or re.fullmatch(r"\d{8}T\d{4}", text):  # shorter text is a day without an hour
        try:
            return _read(
                datetime.fromisoformat(text.replace("UTC", "Z").replace("/", "-").replace(" Z", "Z"))
            )
        except ValueError:
            pass
    zone = _ZONE.search(text)
    bare = text[: zone.start()] if zone else text
    for form in _FORMS:
        try:
            moment = datetime.strptime(bare, form).replace(tzinfo=UTC)
        except ValueError:
            continue
        return (moment - _offset(zone[1]), True) if zone else (moment, False)
    return None


def _offset(zone: str) -> timedelta:
    if zone[0] not in "+-":
        return timedelta(0)
    digits = zone[1:].replace(":", "").ljust(4, "0")
    offset = timedelta(hours=int(digits[:2]), minutes=int(digits[2:]))
    return offset if zone[0] == "+" else -offset


def _of_name(stem: str) -> tuple[datetime, bool] | None:
    match = _IN_NAME.search(stem)
    if not match:
        return None
    try:
        year, month, day, hour, minute, second = (int(part or 0) for part in match.groups()[:6])
        moment = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
        return moment - (_offset(match[7]) if match[7] else timedelta(0)), match[7] is not None
    except (ValueError, OverflowError):
        return None
