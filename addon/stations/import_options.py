"""Options of an import: columns and reference system that files do not name. No heavy module is imported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

MEANINGS = (
    *("name", "latitude", "longitude", "x", "y", "kind", "agency", "staffing", "address", "city", "state"),
    *("zip", "source_id", "origin", "date"),
)
"""Meanings of columns of stations."""


@dataclass(frozen=True)
class ImportOptions:
    """Options of an import.

    Attributes
    ----------
    columns
        Column names by meaning (see `MEANINGS`), in place of guessed ones.
    crs
        Reference system of coordinates that are not in degrees, in files that name none.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    crs: str = ""


USUAL = ImportOptions()
