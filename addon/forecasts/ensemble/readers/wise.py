"""Reader of W.I.S.E. and Prometheus: a KML file of dated perimeters for each scenario.

A placemark has a polygon, the property SCENARIO, and a TimeSpan whose begin is the time of the perimeter; its
end is the time of the next one (WISE-Developers/wise_demo). Scenarios are named cases, not
members of equal weight.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import Error, InputError, input_error
from ....files import check_size
from ....run.areas import metres_per_degree
from ....run.models import optional_packages
from ....run.models.grid import Grid
from ....run.models.model import Options
from ....run.observations import kml
from ....run.observations.feature import Feature, Polygon
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, attempt, describe
from .files_in import files_in

NAME, ORDER = "W.I.S.E. or Prometheus scenarios in KML", 80

_CELLS = 400  # along the longer side
_MARGIN = 0.1  # of that side
_FINEST = 10.0  # m

Perimeters = list[tuple[datetime, list[Polygon]]]


def sniff(paths: list[Path]) -> bool:
    """Check for KML files with the property SCENARIO."""
    return any(_is_scenario(path) for path in files_in(paths))


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each file."""
    files = [path for path in files_in(paths) if _is_scenario(path)]
    scenarios = [(path, attempt(_scenario, path)) for path in files]
    dated = [each[1] for _, each in scenarios if not isinstance(each, InputError)]
    if not dated:
        raise input_error(files[0], f"none of {len(files)} scenarios can be read; {scenarios[0][1]}")
    issued = min(dates[0][0] for dates in dated)
    last = max(dates[-1][0] for dates in dated)
    latitude, longitude, side = _axes(dated)
    source = f"{len(files)} scenarios in KML"
    horizon = horizon or (last - issued).total_seconds()
    head, _ = describe(replace(options, start=issued), files[0], "W.I.S.E. or Prometheus", horizon, source)
    head = replace(head, kind="scenarios")
    notes = [
        f"cells have {side:.0f} m; each arrives in the middle between two perimeters",
        "issue time is the first perimeter",
    ]
    members = _members(scenarios, issued, latitude, longitude)
    return MemberSet(head, Grid(latitude, longitude), members, notes)


def _members(
    scenarios: list[tuple[Path, tuple[str, Perimeters] | InputError]],
    issued: datetime,
    latitude: NDArray[np.float64],
    longitude: NDArray[np.float64],
) -> Iterator[write.Read]:
    for path, read in scenarios:
        if isinstance(read, InputError):
            yield Member(path.stem), read
            continue
        name, dates = read
        arrival = np.full((len(latitude), len(longitude)), np.inf)
        before = None
        for moment, polygons in dates:
            time = (moment - issued).total_seconds()
            inside = _contains(polygons, latitude, longitude) & np.isinf(arrival)
            arrival[inside] = time if before is None else (before + time) / 2.0
            before = time
        end = (dates[-1][0] - issued).total_seconds()
        yield Member(name, end=end), arrival.astype(np.float32)


def _scenario(path: Path) -> tuple[str, Perimeters]:
    """Read a scenario: its name, and polygons by time."""
    by_time: dict[datetime, list[Polygon]] = {}
    name = path.stem
    for feature in kml.read(path):
        if feature.polygons:
            name = str(feature.properties.get("SCENARIO") or name)
            by_time.setdefault(_moment(path, feature), []).extend(feature.polygons)
    if not by_time:
        raise input_error(path, "has no polygons with a time")
    return name, sorted(by_time.items())


def _moment(path: Path, feature: Feature) -> datetime:
    text = str(feature.properties.get("begin") or "")
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        moment = None
    if moment is None or moment.tzinfo is None:
        reason = f'{feature.place} begins at "{text}", not a time with an offset from UTC; export it again'
        raise input_error(path, reason)
    return moment.astimezone(UTC)


def _axes(dated: list[Perimeters]) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Choose a grid of square cells around all perimeters: cell centres in degrees, and their side, m."""
    rings = [polygon[0] for dates in dated for _, polygons in dates for polygon in polygons]
    points = np.concatenate(rings)
    low, high = points.min(0), points.max(0)
    north, east = metres_per_degree(float((low[1] + high[1]) / 2))
    size = (high - low) * [east, north]
    margin = _MARGIN * float(size.max()) + _FINEST
    side = max((float(size.max()) + 2 * margin) / _CELLS, _FINEST)
    counts = np.ceil((size + 2 * margin) / side).astype(int) + 1
    longitude = low[0] - margin / east + side / east * np.arange(counts[0])
    latitude = low[1] - margin / north + side / north * np.arange(counts[1])
    return latitude, longitude, side


def _contains(
    polygons: list[Polygon], latitude: NDArray[np.float64], longitude: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Mask the cells (ny, nx) whose centre is in a polygon."""
    shapely = optional_packages.package("shapely")
    x, y = np.meshgrid(longitude, latitude)
    inside = np.zeros(x.shape, bool)
    for rings in polygons:
        try:
            shape = shapely.Polygon(rings[0], list(rings[1:])).buffer(0)
        except shapely.errors.GEOSException as error:
            raise Error(f"a perimeter is not a polygon: {error}") from None
        shapely.prepare(shape)
        inside |= shapely.contains_xy(shape, x, y)
    return inside


def _is_scenario(path: Path) -> bool:
    if path.suffix.lower() not in (".kml", ".kmz"):
        return False
    try:
        check_size(path)
        text = kml.unpack_kmz(path) if path.suffix.lower() == ".kmz" else path.read_bytes()
    except (OSError, InputError):
        return False
    return b'"SCENARIO"' in text
