"""Station file with invented stations around the small run, and one beyond it."""

from datetime import UTC, datetime

from firetwin.stations import writing
from firetwin.stations.records import Availability, Resource, Source, Station
from firetwin.stations.station_file import StationFile
from firetwin.stations.types import standard_types

NEAR = "1 Near Station"
BASE = "2 Base Two"
BEYOND = "3 Beyond"
FIRST = datetime(2014, 9, 17, 21, 0, tzinfo=UTC)
HALF = datetime(2014, 9, 17, 21, 20, tzinfo=UTC)
LAST = datetime(2014, 9, 17, 23, 0, tzinfo=UTC)

_STATIONS = (
    Station(1, "Near Station", 38.840, -120.555, "fact", 1, "fire station", "Made Up District", "1 Lane"),
    Station(2, "Base Two", 38.872, -120.515, "exercise", 2, "exercise base"),
    Station(3, "Beyond", 39.200, -120.620, "fact", 1, "fire station"),
)
_SOURCES = (
    Source(1, "Made up list", "public domain", "2026-11-01"),
    Source(2, "Made up exercise", "none", "2026-11-02"),
)


def _resource(number, station, code, minutes, **more):
    return Resource(number, station, code, f"R{number}", "exercise", 2, 1, None, 60.0, minutes, **more)


STATION_FILE = StationFile(
    _STATIONS,
    (
        _resource(11, 2, "engine/3", 5.0),
        _resource(12, 2, "dozer/2", 20.0, mode="line"),
        _resource(13, 3, "engine/6", 40.0),
    ),
    (Availability(11, FIRST, HALF), Availability(13, HALF, LAST)),
    _SOURCES,
    standard_types(),
)


def write(path):
    """Write the file; returns its path."""
    writing.write(STATION_FILE, path)
    return path
