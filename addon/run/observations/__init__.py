"""What was seen of a fire: dated perimeters and satellites' detections, from the files that people have.

Each format is a module here, found by the end of a file's name. Their features come as `Feature`; dates are
found by `dates`. Nothing but `shapefile` needs more than Python and NumPy.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import Error, input_error
from . import dates
from .feature import Feature, Polygon

__all__ = ["FOLDER", "Detections", "Feature", "Observations", "Perimeter", "Polygon", "beside", "read"]

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
    """All that was read, perimeters by their time, and what had to be assumed."""

    perimeters: tuple[Perimeter, ...] = ()
    detections: tuple[Detections, ...] = ()
    assumptions: tuple[str, ...] = field(default=())


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

    Polygons of one moment in one file are one perimeter.

    Raises
    ------
    InputError
        A file is missing, of no known format, damaged, without dates or without anything to compare with.
    """
    perimeters: list[Perimeter] = []
    detections: list[Detections] = []
    assumptions: dict[str, None] = {}
    for name in paths:
        path, moment = dates.without(name)
        reader = _reader(path)
        try:
            found = reader.read(path)
        except Error:
            raise
        except OSError as error:
            raise input_error(path, 0, 0, (error.strerror or str(error)).lower()) from None
        except Exception as error:  # Python's, or a library's: what is in the file is not what it should be
            reason = " ".join(str(error).split()) or type(error).__name__
            raise input_error(path, 0, 0, f"is damaged: {reason}") from error
        if isinstance(found, Detections):
            detections.append(found)
        else:
            perimeters += _perimeters(path, found, moment, assumptions)
    perimeters.sort(key=lambda each: each.time)
    return Observations(tuple(perimeters), tuple(detections), tuple(assumptions))


def _reader(path: Path) -> object:
    name = _READERS.get(path.suffix.lower())
    if name is None:
        known = ", ".join(sorted(_READERS))
        raise input_error(path, 0, 0, f"no observations: their names end in {known}")
    return importlib.import_module(f".{name}", __name__)


def _perimeters(
    path: Path, features: Sequence[Feature], moment: datetime | None, assumptions: dict[str, None]
) -> list[Perimeter]:
    found: dict[datetime, list[Polygon]] = {}
    burned = [feature for feature in features if feature.polygons]
    if not burned:
        raise input_error(path, 0, 0, "holds no polygons, so nothing says where it had burned")
    for feature in burned:
        when = moment or dates.of(path, feature, assumptions)
        found.setdefault(when, []).extend(feature.polygons)
    if len(burned) < len(features):
        assumptions[f"{path.name}: {len(features) - len(burned)} features without polygons are left out"] = (
            None
        )
    return [Perimeter(when, tuple(polygons), path.name) for when, polygons in found.items()]
