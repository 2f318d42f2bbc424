"""Rows of importers: stations and resources before merging and numbering, and rejected rows."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from .names import make_readable
from .records import Resource
from .station_file import StationFile

MISSING = "no coordinates"
BEYOND = "coordinates are not in degrees (save them in WGS84, EPSG:4326)"
EMS = "ambulance or medical service, not a fire station"
KIND = "fire station"
"""Kind of a station whose file gives none."""

NAMELESS = "no name and no number"

_TELEPHONE = re.compile(
    r"(?:\+?\d{1,3}[ .-]?)?(?:\(\d{3}\)\s*|\b\d{3}[ .-])\d{3}[ .-]\d{4}\b(?:\s*(?:x|ext\.?)\s*\d+)?", re.I
)
_PRIVATE = re.compile(r"phone|^tel$|fax|mobile|e-?mail|contact|person|chief|emergtitle|radio|frequency", re.I)
_MEDICAL = re.compile(r"\b(ambulance|ems|e\.m\.s\.|emergency medical|paramedics?|medical services?)\b", re.I)
_FIRE = re.compile(r"\b(fire|hose|engine|ladder|volunteer|f\.?d\.?|vfd|fpd|cal ?fire|forest|lookout)\b", re.I)


@dataclass
class Draft:
    """A station as in the source; `place` is its position in the file."""

    name: str
    latitude: float
    longitude: float
    kind: str = KIND
    agency: str = ""
    address: str = ""
    source_id: str = ""
    origin: str = "fact"
    staffing: str = ""
    place: str = ""


@dataclass
class Rejections:
    """Number of rejected rows by reason, and the place of the first row of each reason."""

    counts: dict[str, int] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)

    def add(self, reason: str, place: str) -> None:
        """Count a rejected row."""
        self.counts[reason] = self.counts.get(reason, 0) + 1
        self.first.setdefault(reason, place)

    def lines(self) -> list[str]:
        """Format a line for each reason: ``3 rejected, the first in line 5: no coordinates``."""
        return [
            f"{number:,} rejected, the first in {self.first[reason]}: {reason}"
            for reason, number in self.counts.items()
        ]


@dataclass
class Batch:
    """Content of one file, as an importer reads it.

    Attributes
    ----------
    resources
        Resources with the name or number of their station, from a table of resources.
    licence, name, retrieved, url
        Source, as the format or the file gives it; empty if neither does.
    notes
        Messages on guessed columns and reference systems.
    dropped
        Columns and tags with telephone numbers or persons, which are not stored.
    station_file
        Content of a station file, which is merged unchanged.
    """

    stations: list[Draft] = field(default_factory=list)
    resources: list[ResourceDraft] = field(default_factory=list)
    rejected: Rejections = field(default_factory=Rejections)
    name: str = ""
    licence: str = ""
    retrieved: str = ""
    url: str = ""
    notes: list[str] = field(default_factory=list)
    dropped: list[str] = field(default_factory=list)
    station_file: StationFile | None = None


@dataclass
class ResourceDraft:
    """A resource before numbering, the station that it names, and its window of availability."""

    resource: Resource
    station: str
    place: str
    window: tuple[Any, Any, str, str] | None = None


def add(batch: Batch, latitude: Any, longitude: Any, draft: Draft) -> None:
    """Add a station with normalised texts to a batch, or count it as rejected."""
    draft.name, draft.agency, draft.address, draft.kind, draft.staffing = (
        make_readable(remove_telephones(text))
        for text in (draft.name, draft.agency, draft.address, draft.kind, draft.staffing)
    )
    position = parse_position(latitude, longitude)
    if isinstance(position, str):
        batch.rejected.add(position, draft.place)
    elif is_medical(" ".join((draft.name, draft.agency, draft.kind if draft.kind != KIND else ""))):
        batch.rejected.add(EMS, draft.place)
    elif not (draft.name or draft.source_id):
        batch.rejected.add(NAMELESS, draft.place)
    else:
        draft.latitude, draft.longitude = position
        draft.name = draft.name or f"Fire station {draft.source_id}"
        batch.stations.append(draft)


def parse_position(latitude: Any, longitude: Any) -> tuple[float, float] | str:
    """Return the position in degrees north and east, or the reason for rejection.

    0, 0 counts as missing, as exports write it for unknown positions.
    """
    try:
        position = float(latitude), float(longitude)
    except (TypeError, ValueError, OverflowError):
        return MISSING
    if not all(map(math.isfinite, position)) or position == (0.0, 0.0):
        return MISSING
    if abs(position[0]) > 90.0 or abs(position[1]) > 180.0:
        return BEYOND
    return position


def is_medical(text: str) -> bool:
    """Return True for the name of a medical service without a fire station."""
    return bool(_MEDICAL.search(text)) and not _FIRE.search(text)


def remove_telephones(text: str) -> str:
    """Remove telephone numbers from a text."""
    return " ".join(_TELEPHONE.sub(" ", text).split()).strip(" ,;")


def private_columns(names: Iterable[str]) -> list[str]:
    """Select the names of columns or tags with telephone numbers and persons."""
    return sorted({name for name in names if _PRIVATE.search(name)})
