"""What was seen of a fire: dated perimeters, infrared flights' heat and satellites' detections.

Each format is a module here, found by the end of a file's name. Their features come as `Feature`; dates are
found by `dates`. Nothing but `shapefile` needs more than Python and NumPy.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ...errors import Error, input_error
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
"""Folder in that of a run, whose files are read without being named."""

_READERS = {
    ".geojson": "geojson",
    ".json": "geojson",
    ".kml": "kml",
    ".kmz": "kml",
    ".gpkg": "geopackage",
    ".shp": "shapefile",
    ".csv": "firms",
}


@dataclass(frozen=True)
class Perimeter:
    """Where it had burned by a moment.

    Attributes
    ----------
    time
        UTC.
    polygons
        Each its rings, the outer first and then its holes: (n, 2) degrees east and north on WGS84.
    source
        Name of the file.
    """

    time: datetime
    polygons: tuple[Polygon, ...]
    source: str


@dataclass(frozen=True)
class Heat:
    """What an infrared flight saw of one class.

    Attributes
    ----------
    time
        UTC.
    kind
        One of `infrared_detections.KINDS`.
    polygons
        As those of a perimeter.
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
    """Pixels in which satellites saw fire.

    Attributes
    ----------
    time
        (n,) UTC of their overpasses.
    latitude, longitude
        (n,) degrees, of the pixels' middles.
    size
        (n,) m, of a pixel's longer side.
    source
        Name of the file.
    left_out
        How many more are in the file that are of low confidence or no vegetation fire.
    """

    time: tuple[datetime, ...]
    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    size: NDArray[np.float64]
    source: str
    left_out: int = 0


@dataclass(frozen=True)
class Observations:
    """All that was read, perimeters and heat by their time, and what had to be assumed."""

    perimeters: tuple[Perimeter, ...] = ()
    detections: tuple[Detections, ...] = ()
    assumptions: tuple[str, ...] = field(default=())
    heat: tuple[Heat, ...] = ()


def features(path: Path) -> list[Feature] | Detections:
    """All that a file holds, whatever it is.

    Raises
    ------
    InputError
        It is missing, of no known format, or damaged.
    """
    reader = _reader(path)
    if path.exists() and not path.is_file():  # a pipe would be waited for
        raise input_error(path, 0, 0, "is no file; name one that holds observations")
    try:
        return reader.read(path)
    except Error:
        raise
    except OSError as error:
        raise input_error(path, 0, 0, (error.strerror or str(error)).lower()) from None
    except Exception as error:  # Python's, or a library's: what is in the file is not what it should be
        reason = " ".join(str(error).split()) or type(error).__name__
        raise input_error(path, 0, 0, f"is damaged or incomplete: {reason}") from error


def beside(folder: str | Path) -> list[Path]:
    """Files of observations in a run's folder."""
    return inside(Path(folder) / FOLDER)


def inside(folder: Path) -> list[Path]:
    """Files of observations in a folder; none where there is no such folder."""
    found = sorted(folder.iterdir()) if folder.is_dir() else []
    return [path for path in found if path.suffix.lower() in _READERS and path.name[0] != "."]


def is_one(path: str | Path) -> bool:
    """Whether a file's name ends as those of observations do; one with a moment after ``@`` counts."""
    return dates.without(path)[0].suffix.lower() in _READERS


def read(paths: Iterable[str | Path]) -> Observations:
    """Read files; ``FILE@2014-09-18T04:00-07:00`` says when a file without dates was true.

    Polygons of one moment in one file are one perimeter; those of heat within it are none.

    Raises
    ------
    InputError
        A file is missing, of no known format, damaged, without dates or without anything to compare with.
    """
    perimeters: list[Perimeter] = []
    warm: list[Heat] = []
    detections: list[Detections] = []
    assumptions: dict[str, None] = {}
    for name in paths:
        path, moment = dates.without(name)
        found = features(path)
        if isinstance(found, Detections):
            detections.append(found)
        else:
            burned, hot = _sorted(path, found, moment, assumptions)
            perimeters += burned
            warm += hot
    perimeters.sort(key=lambda each: each.time)
    warm.sort(key=lambda each: each.time)
    return Observations(tuple(perimeters), tuple(detections), tuple(assumptions), tuple(warm))


def _reader(path: Path) -> ModuleType:
    name = _READERS.get(path.suffix.lower())
    if name is None:
        known = ", ".join(sorted(_READERS))
        raise input_error(path, 0, 0, f"no observations: their names end in {known}")
    return importlib.import_module(f".{name}", __name__)


def _sorted(
    path: Path, features: Sequence[Feature], moment: datetime | None, assumptions: dict[str, None]
) -> tuple[list[Perimeter], list[Heat]]:
    """Perimeters, of polygons that are said to be such or of no class, and heat, by moment and class."""
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
        raise input_error(path, 0, 0, "holds no polygons, so nothing says where it had burned")
    if burned and hot:
        assumptions[f"{path.name}: heat within its perimeter is drawn and not compared"] = None
    if left:
        assumptions[f"{path.name}: {left} features that are neither perimeter nor heat are left out"] = None
    perimeters = [Perimeter(when, tuple(polygons), path.name) for when, polygons in burned.items()]
    return perimeters, [
        Heat(
            when,
            kind,
            tuple(polygon for each in found for polygon in each.polygons),
            np.concatenate([each.points for each in found]),
            path.name,
        )
        for (when, kind), found in hot.items()
    ]
