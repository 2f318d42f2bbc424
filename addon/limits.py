"""Limits on files and servers of others: one list, from which the page of limits is made.

A reader imports its number from here. `docs/generate.py` writes `LIMITS` into docs/limits.md.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limit:
    """A limit.

    Attributes
    ----------
    group
        Kind of files or servers.
    quantity
        Quantity that the limit bounds.
    value
        The number with its unit, as the page shows it.
    beyond
        Result of exceeding it.
    """

    group: str
    quantity: str
    value: str
    beyond: str


LIMITS: list[Limit] = []
_MB = 1_000_000


def _number(group: str, quantity: str, value: int, beyond: str, unit: str = "") -> int:
    """List a limit and return its number; bytes are shown as MB or GB."""
    shown = f"{value:,} {unit}".strip()
    if unit == "bytes":
        shown = f"{value / _MB:,.3g} MB" if value < 1000 * _MB else f"{value / 1000 / _MB:.3g} GB"
    LIMITS.append(Limit(group, quantity, shown, beyond))
    return value


_G = "GeoPackages"
SQLITE_GROWTH = _number(
    _G, "text and bytes read from a table, as a multiple of the file size (plus 1 MB)", 2, "refused"
)
SQLITE_FREE = 1 << 20
"""Bytes in addition to `SQLITE_GROWTH` times the file size."""
SQLITE_LENGTH = _number(_G, "length of a value", 256 * _MB, "refused", "bytes")
SQLITE_SQL = _number(
    _G, "length of a command in the file, such as a view or a trigger", _MB, "refused", "bytes"
)
SQLITE_COLUMNS = _number(_G, "columns of a table", 500, "refused")
SQLITE_DEPTH = _number(_G, "depth of an expression in the file", 100, "refused")
SQLITE_SECONDS = _number(_G, "processor time of a file (plus 1 s per 10 MB)", 20, "refused", "s")
GEOMETRY_DEPTH = _number(_G, "geometries in one another", 32, "refused as damaged")

_X = "Other files"
RUN_YEARS = 1000, 9998
"""First and last year of the times of a run."""
LIMITS.append(Limit(_X, "years of the times of a run", f"{RUN_YEARS[0]} to {RUN_YEARS[1]}", "refused"))
RUN_HEIGHTS = -12_000, 10_000
"""m; the Earth's surface has -10,935 m (Challenger Deep) to 8,849 m (Everest)."""
LIMITS.append(Limit(_X, "elevation of a run, m", f"{RUN_HEIGHTS[0]:,} to {RUN_HEIGHTS[1]:,}", "refused"))
HEAT_FLUX = 1e9
"""W/m2; beyond it, heat of a fire is not a number in single precision. The Sun's surface has 6e7 W/m2."""
LIMITS.append(Limit(_X, "heat flux of a run, W/m2", f"{HEAT_FLUX:,.0f}", "refused"))
TEXT_BYTES = _number(_X, "size of GeoJSON, KML, GPX and CSV, also within a KMZ", 1 << 28, "refused", "bytes")

TEXT_VALUES = _number(_X, "numbers, lists and tags in such a file", 20_000_000, "refused")
SETTINGS_BYTES = _number(_X, "size of scene files, plans and other settings", 16 << 20, "refused", "bytes")
UNPACKED_BYTES = _number(
    _X, "size of arrays in a NumPy file or raster, decompressed", 2 << 30, "refused", "bytes"
)
SAMPLE_PIXELS = _number(_X, "pixels of a picture of a data set", 100_000_000, "refused")
CAMERA_FRAMES = _number(_X, "frames of a camera of a USD stage or Alembic file", 100_000, "refused")
CAMERA_SECONDS = _number(_X, "time of a USD stage or Alembic file without progress", 120, "refused", "s")
CAMERA_MEMORY = _number(
    _X, "memory of the process that reads a USD stage or Alembic file", 2 << 30, "refused", "bytes"
)

_T = "3D tiles"
TILE_BYTES = _number(_T, "size of a file, decompressed", 256 << 20, "refused", "bytes")
TILE_GROWTH = _number(_T, "growth of a file by decompression (above 1 MB)", 64, "refused", "times")
TILE_JSON_BYTES = _number(_T, "size of a tileset.json", 64 << 20, "refused", "bytes")
TILE_JSON_DEPTH = _number(_T, "arrays and objects in one another", 256, "refused")
TILE_MEMBERS = _number(_T, "files of a .3tz archive", 2_000_000, "refused")
TILE_COUNT = _number(_T, "tiles of a tileset", 1_000_000, "refused")
TILE_CONTENTS = _number(_T, "contents of a tile", 64, "refused")
TILE_NESTED = _number(_T, "tilesets in one another", 64, "refused")
TILE_MEMORY = _number(_T, "memory of the process that decodes tiles", 3 << 30, "the tile is missing", "bytes")
TILE_SECONDS = _number(_T, "time to decode a tile", 60, "the tile is missing", "s")

_D = "Downloads"
DOWNLOAD_SILENCE = _number(_D, "time without data", 30, "retried", "s")
DOWNLOAD_PIECE = _number(
    _D, "time for the head of a response, and for each 64 kB", 60, "the file is missing", "s"
)
DOWNLOAD_FILE = _number(_D, "time for a file", 600, "the file is missing", "s")
DOWNLOAD_HOST = _number(
    _D, "time for all requests to the server of a tileset, concurrent ones added", 4 * 3600, "refused", "s"
)
DOWNLOAD_JOB = _number(_D, "time for all requests of a job, concurrent ones added", 8 * 3600, "refused", "s")
DOWNLOAD_ADDRESSES = _number(_D, "tried addresses of a host", 8, "not tried")

FARM_FILES = _number("Farm jobs", "files of a tileset in a folder", 200_000, "refused")

_E = "Scene files"
KEY_PREFIX = "FIRETWIN_KEY_"
"""Environment variables that a scene file may send to a host of its choice begin with this."""
LIMITS.append(
    Limit(_E, "environment variables that a URL may name", f"`{KEY_PREFIX}*`; a service's own key", "refused")
)

_S = "Stations and labels"
SMALLEST_NUMBER, LARGEST_NUMBER = 1e-6, 1e9
"""Bounds of a load, speed, time, distance or cost of a resource that is not 0."""
_BOUNDS = f"0, and {SMALLEST_NUMBER:.6f} to {LARGEST_NUMBER:,.0f}"
LIMITS.append(Limit(_S, "numbers of a resource, such as its cost", _BOUNDS, "refused"))
STATION_TEXT = _number(_S, "characters of a text of an imported station, such as its name", 10_000, "refused")
LABELS = _number(_S, "labels in a scene", 500, "refused")
SIGNS = _number(_S, "station signs in a scene", 1000, "refused")
ROUTES = _number(_S, "lines of routes in a scene", 1000, "refused")
ROUTE_CORNERS = _number(_S, "corners of all routes", 500_000, "refused")
ROUTE_KM = _number(_S, "length of all routes", 20_000, "refused", "km")
CORNERS = _number("Footprints", "corners of a footprint", 5000, "left out and counted; refused for stations")
FOOTPRINT_CORNERS = _number("Footprints", "corners of all footprints of a scene", 5_000_000, "refused")
YEARS = 1900, 2200
"""First and last year of a window of availability."""
LIMITS.append(Limit(_S, "years of a window of availability", f"{YEARS[0]} to {YEARS[1]}", "refused"))


def is_quantity(value: float) -> bool:
    """Check whether a number can be a quantity of a resource; NaN cannot."""
    return value == 0.0 or SMALLEST_NUMBER <= value <= LARGEST_NUMBER
