"""Consistency checks: files belong to one run of one model, at one place, with unique times."""

from __future__ import annotations

from pathlib import Path

from ...errors import Error, input_error
from . import netcdf

_CORNERS = (("lats", "lons"), ("XLAT", "XLONG"), ("FXLAT", "FXLONG"))
_APART = 1e-3  # degrees; a larger offset is another place, and 32-bit longitudes are far finer
_ASK = "convert one run at a time"


def of_models(by_format: dict[str, list[Path]]) -> None:
    """Check that files, grouped by format name, are of one model.

    Raises
    ------
    InputError
        They are of several models.
    """
    if len(by_format) > 1:
        (name, (first, *_)), (other, (second, *_)), *_ = by_format.items()
        raise input_error(second, f"is {other} where {first.name} is {name}; {_ASK}")


def of_series(paths: list[Path]) -> None:
    """Check a model's files that have one time each.

    Raises
    ------
    InputError
        Two files have the same name, or lie in different places.
    """
    names: dict[str, Path] = {}
    for path in paths:
        before = names.setdefault(path.name, path)
        if before != path:
            raise input_error(path, f"has the name of {before}, so it is of another run; {_ASK}")
    first = None
    for path in paths if len(paths) > 1 else ():
        corner = _corner(path)
        if corner is None:
            continue
        if first is None:
            first = path, corner
        elif max(abs(a - b) for a, b in zip(corner, first[1], strict=True)) > _APART:
            there = "{:.3f}, {:.3f}".format(*first[1])
            here = "{:.3f}, {:.3f}".format(*corner)
            reason = f"has its first cell at {here} where {first[0].name} has {there}: another place; {_ASK}"
            raise input_error(path, reason)


def of_one(paths: list[Path]) -> Path:
    """Return the single file of a model that writes one.

    Raises
    ------
    InputError
        There are several.
    """
    if len(paths) > 1:
        raise input_error(paths[1], f"is another run than {paths[0].name}; {_ASK}")
    return paths[0]


def _corner(path: Path) -> tuple[float, float] | None:
    """Read latitude and longitude of the first cell, if the file has them per cell; otherwise None."""
    if not netcdf.is_netcdf(path):
        return None
    try:
        file = netcdf.File(path)
    except Error:  # which the reader reports
        return None
    try:
        for names in _CORNERS:
            if all(name in file and len(file.shape(name)) >= 2 for name in names):
                latitude, longitude = (float(file.read(name, *[0] * len(file.shape(name)))) for name in names)
                return latitude, longitude
    except Error:
        pass
    finally:
        file.close()
    return None
