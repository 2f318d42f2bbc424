"""Observations of a fire: dated perimeters, infrared flights' heat and satellite detections.

Each format is a module here, selected by its `SUFFIXES`. Readers return `Feature`; `dates` parses dates. Only
`shapefile` needs more than Python and NumPy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ... import files, plugins
from ...errors import input_error, reading
from . import dates, infrared_detections
from .feature import Feature, Polygon

__all__ = [
    "FOLDER",
    "Detections",
    "Feature",
    "Heat",
    "Observations",
    "Perimeter",
    "Polygon",
    "beside",
    "features",
    "read",
]

FOLDER = "observations"
"""Subfolder of a run's folder whose files are read by default."""

_SUFFIXES = plugins.declared(Path(__file__).parent, "SUFFIXES")
_READERS = {suffix: name for name, suffixes in _SUFFIXES.items() for suffix in suffixes}


@dataclass(frozen=True)
class Perimeter:
    """Perimeter of the burned area at one time.

    Attributes
    ----------
    time
        UTC.
    polygons
        Polygons as lists of rings, the outer first, then holes: (n, 2) degrees east and north on WGS84.
    source
        Name of the file.
    """

    time: datetime
    polygons: tuple[Polygon, ...]
    source: str


@dataclass(frozen=True)
class Heat:
    """Heat of one class mapped by an infrared flight.

    Attributes
    ----------
    time
        UTC.
    kind
        One of `infrared_detections.KINDS`.
    polygons
        As in a perimeter.
    points
        (n, 2) degrees east and north of sources too small for a polygon.
    source
        Name of the file.
    """

    time: datetime
    kind: str
    polygons: tuple[Polygon, ...]
    points: NDArray[np.float64]
    source: str


@dataclass(frozen=True)
class Detections:
    """Satellite fire detections (active fire pixels).

    Attributes
    ----------
    time
        (n,) UTC of the overpasses.
    latitude, longitude
        (n,) degrees, pixel centres.
    size
        (n,) m, longer side of a pixel.
    source
        Name of the file.
    left_out
        Number of excluded detections in the file: of low confidence, or no vegetation fire.
    """

    time: tuple[datetime, ...]
    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    size: NDArray[np.float64]
    source: str
    left_out: int = 0


@dataclass(frozen=True)
class Observations:
    """All observations read, perimeters and heat in order of time, with the assumptions made."""

    perimeters: tuple[Perimeter, ...] = ()
    detections: tuple[Detections, ...] = ()
    assumptions: tuple[str, ...] = field(default=())
    heat: tuple[Heat, ...] = ()


def features(path: Path) -> list[Feature] | Detections:
    """Read all features of a file of any known format.

    Raises
    ------
    InputError
        The file is missing, has an unknown format, or is damaged.
    """
    reader = _reader(path)
    if path.exists() and not path.is_file():  # opening a pipe would block
        raise input_error(path, "is not a file; name a file of observations")
    with reading(path):
        if path.suffix.lower() not in (".gpkg", ".shp"):
            files.check_text_size(path)
        return reader.read(path)


def beside(folder: str | Path) -> list[Path]:
    """List the observation files in a run's folder."""
    return inside(Path(folder) / FOLDER)


def inside(folder: Path) -> list[Path]:
    """List the observation files in a folder; empty without such a folder."""
    entries = sorted(folder.iterdir()) if folder.is_dir() else []
    return [path for path in entries if path.suffix.lower() in _READERS and path.name[0] != "."]


def is_one(path: str | Path) -> bool:
    """Check whether a file name has an extension of observations; a time after ``@`` is allowed."""
    return dates.without(path)[0].suffix.lower() in _READERS


def read(paths: Iterable[str | Path]) -> Observations:
    """Read observation files; ``FILE@2014-09-18T04:00-07:00`` dates a file without dates.

    Polygons of one time in one file form one perimeter; heat polygons within it are separate.

    Raises
    ------
    InputError
        A file is missing, has an unknown format, is damaged, or has no dates or nothing to compare.
    """
    perimeters: list[Perimeter] = []
    warm: list[Heat] = []
    detections: list[Detections] = []
    assumptions: dict[str, None] = {}
    for name in paths:
        path, moment = dates.without(name)
        content = features(path)
        if isinstance(content, Detections):
            detections.append(content)
        else:
            burned, hot = _sorted(path, content, moment, assumptions)
            perimeters += burned
            warm += hot
    perimeters.sort(key=lambda each: each.time)
    warm.sort(key=lambda each: each.time)
    return Observations(tuple(perimeters), tuple(detections), tuple(assumptions), tuple(warm))


def _reader(path: Path) -> ModuleType:
    name = _READERS.get(path.suffix.lower())
    if name is None:
        known = ", ".join(sorted(_READERS))
        raise input_error(path, f"cannot be read; files of observations and outlines end in {known}")
    return plugins.module(__name__, name)


def _sorted(
    path: Path, features: Sequence[Feature], moment: datetime | None, assumptions: dict[str, None]
) -> tuple[list[Perimeter], list[Heat]]:
    """Sort features into perimeters (labelled as such or of no class) and heat, by time and class."""
    burned: dict[datetime, list[Polygon]] = {}
    hot: dict[tuple[datetime, str], list[Feature]] = {}
    left = 0
    for feature in features:
        kind = infrared_detections.kind(path, feature)
        if kind in infrared_detections.KINDS and (feature.polygons or len(feature.points)):
            hot.setdefault((moment or dates.parse(path, feature, assumptions), kind), []).append(feature)
        elif kind in ("", infrared_detections.PERIMETER) and feature.polygons:
            when = moment or dates.parse(path, feature, assumptions)
            burned.setdefault(when, []).extend(feature.polygons)
        else:
            left += 1
    if not burned and not hot:
        raise input_error(path, "has no polygons of burned area")
    if burned and hot:
        assumptions[f"{path.name}: heat within its perimeter is drawn and not compared"] = None
    if left:
        assumptions[f"{path.name}: {left} features that are neither perimeter nor heat are left out"] = None
    perimeters = [Perimeter(when, tuple(polygons), path.name) for when, polygons in burned.items()]
    return perimeters, [
        Heat(
            when,
            kind,
            tuple(polygon for item in found for polygon in item.polygons),
            np.concatenate([item.points for item in found]),
            path.name,
        )
        for (when, kind), found in hot.items()
    ]
