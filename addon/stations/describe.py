"""Texts about stations for lists, signs and pages."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from .records import Resource


def count_types(resources: Iterable[Resource], most: int) -> str:
    """Format counts by type: ``2 x engine/3, 1 x dozer/2 and 2 more types``; at most `most` are named."""
    counted: Counter[str] = Counter()
    for each in resources:
        counted[each.type] += each.count
    words = [f"{number} x {code}" for code, number in counted.most_common(most)]
    more = len(counted) - most
    return ", ".join(words) + (f" and {more} more type{'s' * (more > 1)}" if more > 0 else "")


def degrees(latitude: float, longitude: float) -> tuple[str, str]:
    """Format latitude and longitude with a resolution of 1 m, the longitude from -180 to 180."""
    return f"{latitude:.5f}", f"{(longitude + 180.0) % 360.0 - 180.0:.5f}"


def web_map_address(latitude: float, longitude: float) -> str:
    """Return the address of a position on openstreetmap.org; nothing is loaded before a reader follows it."""
    north, east = degrees(latitude, longitude)
    return f"https://www.openstreetmap.org/?mlat={north}&mlon={east}#map=14/{north}/{east}"
