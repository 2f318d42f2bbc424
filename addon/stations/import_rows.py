"""What importers read: stations and resources before they are merged and numbered, and what was refused."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from .names import readable
from .records import Resource
from .station_file import StationFile

MISSING = "without coordinates"
BEYOND = "with coordinates that are no degrees (save them in WGS84, EPSG:4326)"
EMS = "of ambulances or medical services alone, without a fire station"
NAMELESS = "without a name and without a number"

_TELEPHONE = re.compile(
    r"(?:\+?\d{1,3}[ .-]?)?(?:\(\d{3}\)\s*|\b\d{3}[ .-])\d{3}[ .-]\d{4}\b(?:\s*(?:x|ext\.?)\s*\d+)?", re.I
)
_PRIVATE = re.compile(r"phone|^tel$|fax|mobile|e-?mail|contact|person|chief|emergtitle|radio|frequency", re.I)
_MEDICAL = re.compile(r"\b(ambulance|ems|e\.m\.s\.|emergency medical|paramedics?|medical services?)\b", re.I)
_FIRE = re.compile(r"\b(fire|hose|engine|ladder|volunteer|f\.?d\.?|vfd|fpd|cal ?fire|forest|lookout)\b", re.I)


@dataclass
class Draft:
    """A station as a source has it; `place` says where in the file."""

    name: str
    latitude: float
    longitude: float
    kind: str = "fire station"
    agency: str = ""
    address: str = ""
    source_id: str = ""
    origin: str = "fact"
    place: str = ""


@dataclass
class Refused:
    """Counts of what was refused, and the place of the first of each reason."""

    counts: dict[str, int] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)

    def add(self, reason: str, place: str) -> None:
        """Count one."""
        self.counts[reason] = self.counts.get(reason, 0) + 1
        self.first.setdefault(reason, place)

    def lines(self) -> list[str]:
        """One line for each reason: ``3 refused without coordinates, the first in line 5``."""
        return [
            f"{number:,} refused {reason}, the first in {self.first[reason]}"
            for reason, number in self.counts.items()
        ]


@dataclass
class Batch:
    """What an importer read of one file.

    Attributes
    ----------
    resources
        Resources with the name or number of their station, of a table of resources.
    licence, name, retrieved, url
        What the format or the file itself says of its source; empty where it says nothing.
    dropped
        Columns and tags with telephones or persons, which are not stored.
    whole
        A file of places, which is taken over as it is.
    """

    stations: list[Draft] = field(default_factory=list)
    resources: list[ResourceDraft] = field(default_factory=list)
    refused: Refused = field(default_factory=Refused)
    name: str = ""
    licence: str = ""
    retrieved: str = ""
    url: str = ""
    dropped: list[str] = field(default_factory=list)
    whole: StationFile | None = None


@dataclass
class ResourceDraft:
    """A resource without its numbers, the station that it names, and its windows' status."""

    resource: Resource
    station: str
    place: str
    window: tuple[Any, Any, str, str] | None = None


def add(batch: Batch, latitude: Any, longitude: Any, draft: Draft) -> None:
    """Add a station to a batch, with its texts made readable, or count why it is refused."""
    draft.name, draft.agency, draft.address = (
        readable(without_telephones(text)) for text in (draft.name, draft.agency, draft.address)
    )
    position = degrees(latitude, longitude)
    if isinstance(position, str):
        batch.refused.add(position, draft.place)
    elif medical(f"{draft.name} {draft.agency}"):
        batch.refused.add(EMS, draft.place)
    elif not (draft.name or draft.source_id):
        batch.refused.add(NAMELESS, draft.place)
    else:
        draft.latitude, draft.longitude = position
        draft.name = draft.name or f"Fire station {draft.source_id}"
        batch.stations.append(draft)


def degrees(latitude: Any, longitude: Any) -> tuple[float, float] | str:
    """Position in degrees north and east; else why it is none. Exports write 0, 0 for none."""
    try:
        position = float(latitude), float(longitude)
    except (TypeError, ValueError, OverflowError):
        return MISSING
    if not all(map(math.isfinite, position)) or position == (0.0, 0.0):
        return MISSING
    if abs(position[0]) > 90.0 or abs(position[1]) > 180.0:
        return BEYOND
    return position


def medical(text: str) -> bool:
    """Whether a name says medical services and no fire station."""
    return bool(_MEDICAL.search(text)) and not _FIRE.search(text)


def without_telephones(text: str) -> str:
    """Text without numbers that look like telephones'."""
    return " ".join(_TELEPHONE.sub(" ", text).split()).strip(" ,;")


def private(names: Iterable[str]) -> list[str]:
    """Names of columns or tags of telephones and persons."""
    return sorted({name for name in names if _PRIVATE.search(name)})
