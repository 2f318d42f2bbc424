"""Importers of stations and resources: each module reads one format, recognised by file content.

A module has ``NAME``, the name of the format, ``sniff(path, head) -> bool``, which recognises the format by
the first bytes of a file, and ``read(path, options) -> Batch``. The modules are tried in the
order of `ORDER`.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from ... import files, limits, plugins
from ...errors import InputError, input_error, reading
from ...run.observations.feature import SAVE_IN_DEGREES
from ..import_options import USUAL, ImportOptions
from ..import_rows import Batch

_HEAD = 65536  # bytes passed to `sniff`


def find_importer(path: Path) -> ModuleType:
    """Select the importer that recognises a file.

    Raises
    ------
    InputError
        The file is missing, is not a regular file, or has an unknown format.
    """
    if not path.exists():
        raise input_error(path, "there is no such file; check the path")
    if not path.is_file():  # opening a pipe would block
        raise input_error(path, "is not a file; name a CSV, GeoJSON, Overpass JSON or GeoPackage file")
    with path.open("rb") as file:
        head = file.read(_HEAD)
    for module in plugins.modules(__name__, "read").values():
        if module.sniff(path, head):
            return module
    raise input_error(path, _unknown_format())


def read(path: Path, options: ImportOptions = USUAL) -> Batch:
    """Read a file of any known format.

    Parameters
    ----------
    options
        Columns and reference system that the file does not name.

    Raises
    ------
    InputError
        The file is missing, has an unknown format, or is damaged.
    """
    with reading(path):
        importer = find_importer(path)
        if path.suffix.lower() != ".gpkg":
            files.check_text_size(path)
        try:
            return _checked(path, importer.read(path, options))
        except InputError as error:
            if SAVE_IN_DEGREES in str(error) and not options.crs:
                reason = f"{error.reason}, or name the system, such as --crs EPSG:26910 (UTM zone 10 north)"
                raise input_error(path, reason) from None
            raise


def _checked(path: Path, batch: Batch) -> Batch:
    """Check the lengths of the texts of stations."""
    for number, draft in enumerate(batch.stations, 1):
        for name, value in vars(draft).items():
            if isinstance(value, str) and len(value) > limits.STATION_TEXT:
                reason = f"the {name} of station {number} has {len(value):,} characters"
                raise input_error(path, f"{reason}; at most {limits.STATION_TEXT:,} are read: shorten it")
    return batch


def _unknown_format() -> str:
    known = (
        "HIFLD fire stations (CSV, GeoJSON), USGS structures (GeoPackage, GeoJSON), OpenStreetMap (Overpass "
        "JSON, GeoJSON), CSV of stations (name, latitude, longitude) and of resources (station, type), point "
        "layers (GeoPackage, GeoJSON)"
    )
    return f"has an unknown format; known formats: {known}"
