"""Facts of a tileset, for `firetwin tiles info`."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from firetwin_core import geo

from . import notices
from .loader import Loader
from .place import ecef_to_frame
from .tree import MODEL

_SAMPLED = 1000  # contents of a folder or archive whose type is read from magic bytes
_EARTH = 6_000_000.0  # m; coordinates nearer to the origin are not Earth-centred


def gather(loader: Loader, most: int | None) -> dict[str, Any]:
    """Gather the facts of a tileset, as JSON data.

    Parameters
    ----------
    most
        JSON files and subtrees to read; None: all.

    Raises
    ------
    InputError
        A file is invalid or refused.
    """
    whole = loader.expand_all(most)
    tree, source = loader.tree, loader.source
    if source.local:
        models = np.flatnonzero(tree.content_kind == MODEL)
        loader.check(models[:: max(len(models) // _SAMPLED, 1)])
        whole = loader.expand_all(most) and whole
    models = np.flatnonzero(tree.content_kind == MODEL)
    kinds = Counter(loader.kind(int(each)) for each in models)
    volumes, level = tree.volumes, tree.level
    filled = np.unique(tree.content[models, 0])
    corners = volumes.corners()
    low = (corners.min(axis=1) - volumes.padding[:, None]).min(axis=0)
    high = (corners.max(axis=1) + volumes.padding[:, None]).max(axis=0)
    credits = Counter(part for each in tree.documents for part in notices.split(each.copyright))
    return {
        "source": source.name(source.root),
        "policy": source.policy.name,
        "whole": whole,
        "files": loader.files,
        "tiles": tree.size,
        "contents": len(models),
        "kinds": dict(sorted(kinds.items())),
        "by_first_bytes": source.local and len(models) <= _SAMPLED,
        "levels": [
            {
                "tiles": int((level == each).sum()),
                "with_content": int((level[filled] == each).sum()),
                "error_m": [float(f(tree.error[level == each])) for f in (np.min, np.max)],
            }
            for each in range(int(level.max()) + 1)
        ],
        "refine": {"REPLACE": int(tree.replaces.sum()), "ADD": int((~tree.replaces).sum())},
        "extent_m": {"low": low.tolist(), "high": high.tolist()},
        "centre": _centre(0.5 * (low + high)),
        "credits": [text for text, _ in sorted(credits.items(), key=lambda item: (-item[1], item[0]))],
        "missing": list(tree.broken.values()),
    }


def format_text(facts: dict[str, Any]) -> str:
    """Format the facts as text."""
    kinds = ", ".join(f"{number:,} {name}" for name, number in facts["kinds"].items()) or "none"
    how = "" if facts["by_first_bytes"] else " (by their names)"
    refine = ", ".join(f"{number:,} {word}" for word, number in facts["refine"].items() if number)
    size = np.subtract(facts["extent_m"]["high"], facts["extent_m"]["low"])
    lines = [
        facts["source"],
        f"files      {facts['files']:,}" + ("" if facts["whole"] else ", not all: --files reads more"),
        f"tiles      {facts['tiles']:,} ({refine})",
        f"contents   {facts['contents']:,}: {kinds}{how}",
        f"extent     {size[0]:,.0f} x {size[1]:,.0f} x {size[2]:,.0f} m along the axes of the root",
        f"centre     {_format_place(facts['centre'])}",
        f"credits    {'; '.join(facts['credits']) or 'none in tileset.json; contents may have their own'}",
        "level      tiles   with content   geometric error, m",
    ]
    for number, each in enumerate(facts["levels"]):
        low, high = each["error_m"]
        error = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
        lines.append(f"{number:5} {each['tiles']:10,} {each['with_content']:14,}   {error}")
    return "\n".join([*lines, *(f"missing    {each}" for each in facts["missing"])])


def _centre(place: np.ndarray) -> dict[str, float] | None:
    """Return latitude and longitude of a place; None if it is not Earth-centred."""
    if np.linalg.norm(place) < _EARTH:
        return None
    frame = geo.LocalFrame(0.0, 0.0, 0.0)
    enu = ecef_to_frame(frame) @ np.append(place, 1.0)
    latitude, longitude, height = frame.reverse(enu[None, :3])
    return {"latitude": float(latitude[0]), "longitude": float(longitude[0]), "height_m": float(height[0])}


def _format_place(centre: dict[str, float] | None) -> str:
    if centre is None:
        return "not placed on the Earth"
    latitude, longitude = centre["latitude"], centre["longitude"]
    north, east = "N" if latitude >= 0 else "S", "E" if longitude >= 0 else "W"
    return f"{abs(latitude):.5f} {north} {abs(longitude):.5f} {east}, {centre['height_m']:,.0f} m"
