"""Licences of imagery in data sets: an allow-list, as many terms forbid machine learning."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ..shot.settings import Settings
from ..shot.surface import orthophoto
from ..shot.tiles import tile_terms
from .plan import PlanRun

ALLOWED: Mapping[str, str] = MappingProxyType(
    {
        "CC0-1.0": "Creative Commons Zero",
        "CC-BY-4.0": "Creative Commons Attribution",
        "CC-BY-SA-4.0": "Creative Commons Attribution-ShareAlike",
        "PDDL-1.0": "Open Data Commons Public Domain Dedication",
        "ODC-By-1.0": "Open Data Commons Attribution",
        "etalab-2.0": "Licence Ouverte of France",
        "OGL-UK-3.0": "Open Government Licence of the United Kingdom",
        "LicenseRef-US-Government": "public domain, by an agency of the United States (USGS, USDA, NASA)",
        "LicenseRef-Copernicus": "Copernicus Sentinel data, with its notice",
        "LicenseRef-own": "pictures of your own",
    }
)
"""Licences under which pictures may be used for machine learning and given on, by SPDX identifier."""


def has_imagery(settings: Settings) -> bool:
    """Return whether a scene shows photographs of the ground."""
    return orthophoto.photographed(settings) or bool(settings.tiles.sources)


def fault(run: PlanRun, settings: Settings) -> str | None:
    """Return why the imagery of a run is refused, or None.

    Raises
    ------
    InputError
        The terms of a tile service forbid that tiles are analysed.
    """
    if not has_imagery(settings):
        return None
    tile_terms.check(settings, [("analyse", "firetwin dataset")])
    if run.imagery_license in ALLOWED:
        return None
    names = ", ".join(ALLOWED)
    if run.imagery_license:
        return f'imagery_license "{run.imagery_license}" is not known to permit machine learning; use {names}'
    return (
        f"{settings.path.name} has photographs of the ground, and many providers forbid machine learning; "
        f"set imagery_license to one of {names}, or remove [terrain] photo and [tiles] from the scene"
    )
