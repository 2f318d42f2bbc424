"""Facts of the tiles of a scene for the panel and the view: stored as text in the .blend file."""

from __future__ import annotations

import functools
import json
from typing import Any

import bpy

from ..blender import stored_json
from ..shot.shot import Shot
from ..shot.tiles import tile_cut
from ..shot.tiles.tile_cut import TileCut
from . import tile_credits

_LISTED = 5  # names of missing tiles
_FACTS: dict[str, stored_json.Shape] = {
    "sources": [str],
    "lines": [(str, str)],
    "missing": [str],
    "credits": [str],
}


def remember_boxes(panel: bpy.types.PropertyGroup, found: list[dict[str, Any]]) -> None:
    """Store what the root documents of the tilesets tell."""
    sources = [f"{each['name']}: {each['tiles']:,} tiles in its root document" for each in found]
    credits = list(dict.fromkeys(credit for each in found for credit in each["credits"]))
    _store(panel, {"sources": sources, "lines": [], "missing": [], "credits": credits})


def remember(panel: bpy.types.PropertyGroup, shot: Shot) -> None:
    """Store what a build shows; without tiles nothing."""
    cut = tile_cut.of_shot(shot)
    if cut is None:
        forget(panel)
    else:
        remember_cut(panel, cut, "Built")


def remember_cut(panel: bpy.types.PropertyGroup, cut: TileCut, what: str) -> None:
    """Store the numbers of a choice of tiles."""
    lines = [
        (what, f"{len(cut.tiles):,} tiles, {cut.triangles:,} triangles, {cut.bytes / 1e6:,.1f} MB"),
        ("Error", f"{cut.error:.3g} pixels"),
    ]
    kept = read(panel.tile_facts)["sources"]
    missing = [f"{len(cut.missing)} tiles are missing", *cut.missing[:_LISTED]] if cut.missing else []
    _store(panel, {"sources": kept, "lines": lines, "missing": missing, "credits": [*cut.logo, *cut.credits]})


def forget(panel: bpy.types.PropertyGroup) -> None:
    """Store nothing: there are no tiles."""
    panel.tile_facts = panel.tile_credits = ""
    tile_credits.refresh()


@functools.lru_cache(maxsize=8)
def read(text: str) -> dict[str, Any]:
    """Facts from the stored text: `sources`, `lines`, `missing` and `credits`."""
    return stored_json.record(text, _FACTS)


def _store(panel: bpy.types.PropertyGroup, facts: dict[str, Any]) -> None:
    panel.tile_facts = json.dumps(facts)
    panel.tile_credits = "; ".join(facts["credits"])
    tile_credits.refresh()
