"""Briefing page as one HTML file, from `page.html`, `page.css`, `page.js` and Leaflet in this folder.

Its content security policy blocks all requests, by scripts as well as by content.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from string import Template
from typing import Any

import firetwin_core
import numpy as np

from ..errors import UsageError
from ..html_text import quote, script_json, size
from ..imaging import map_symbols
from ..run import times
from ..stations.records import EXERCISE
from . import (
    context_layer,
    curve,
    division_table,
    front_geojson,
    lists,
    map_panel,
    map_sheet,
    paper,
    sections,
    units,
)
from .briefing import Briefing, Point
from .map_panel import FRONT_EDGE, FRONT_FILL
from .mercator import Box
from .sheet_options import Titles

POLICY = (
    "default-src 'none'; img-src data:; media-src data:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
)
_FOLDER = Path(__file__).parent
_PLAY_MS = 12_000.0  # duration of all steps
_STEP_MS = (120.0, 700.0)
_CREDIT = 48  # characters of a source in the attribution of the map


def html(briefing: Briefing, limit: int) -> str:
    """Build the page.

    Parameters
    ----------
    limit
        Maximum size of the page, bytes.

    Raises
    ------
    UsageError
        The page exceeds the limit.
    """
    titles = Titles.of(briefing.run, briefing.sheet, briefing.zone)
    sheet = map_sheet.draw(briefing, briefing.sheet, titles)
    parts = {
        "policy": POLICY,
        "generator": f"Firetwin {firetwin_core.__version__}",
        "name": quote(briefing.run.name),
        "leaflet_style": _leaflet_style(),
        "style": _read("page.css"),
        "head": sections.head(briefing),
        "page_style": paper.style(sheet.paper, _running(briefing, titles)),
        "stamp": _stamp(briefing.marks, "stamp"),
        "map_sheet": sheet.svg,
        "pictures": map_panel.pictures(briefing),
        "last": str(len(briefing.fronts) - 1),
        "layers": map_panel.switches(briefing),
        "places": lists.section(briefing),
        "divisions": division_table.section(briefing),
        "sections": "\n".join(briefing.sections),
        "growth": sections.growth(briefing),
        "film": sections.film(briefing),
        "scores": sections.scores(briefing),
        "method": sections.method(briefing),
        "sources": sections.sources(briefing),
        "data": script_json(_data(briefing)),
        "leaflet_script": _leaflet_script(),
        "script": _read("page.js"),
        "foot": "",
    }
    template = Template(_read("page.html"))
    count = len(template.substitute(parts).encode())
    if count > limit:
        words = f"the page has {size(count)}, above the limit of {size(limit)}"
        raise UsageError(f"{words}; omit --film, or raise --limit")
    parts["foot"] = f"This page is a single file of {size(count)} and loads no other files."
    return template.substitute(parts)


def check_limit(limit: int) -> None:
    """Check before the work that a page without content fits into the limit.

    Raises
    ------
    UsageError
        It does not.
    """
    names = ("page.html", "page.css", "page.js", "leaflet/LICENSE")
    least = len("".join((*map(_read, names), _leaflet_style(), _leaflet_script())).encode())
    if limit < least:
        words = f"an empty page has {size(least)}, above the limit of {size(limit)}"
        raise UsageError(f"--limit: {words}; give at least 1MB")


def notes(briefing: Briefing) -> list[str]:
    """List notes for the author of the page: invented, omitted and missing content."""
    invented = ["this run is synthetic; the page states it"] if briefing.run.synthetic else []
    if briefing.exercise:
        invented.append(f'the page is marked "{EXERCISE}": stations, resources or lines of it are invented')
    omitted = [f"omitted: {text}" for text in briefing.film.left_out] if briefing.film else []
    unscored = [f"no scores: {briefing.no_scores}"] if briefing.no_scores else []
    others = f"the page shows the first run only, without: {', '.join(briefing.others)}"
    return [*invented, *omitted, *unscored, *([others] if briefing.others else [])]


def _read(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")


def _running(briefing: Briefing, titles: Titles) -> dict[str, str]:
    """Write the running header and footer of the printed page."""
    return {
        "top-left": ": ".join(filter(None, (" / ".join(briefing.marks), titles.incident))),
        "top-right": f"Operational period {titles.period}",
        "bottom-left": f"Prepared {titles.prepared}",
        "bottom-center": f"Model issued {titles.issued}, age {titles.age}",
    }


def _stamp(words: Sequence[str], kind: str) -> str:
    """Build large words that lie across a map or a sheet."""
    if not words:
        return ""
    inside = "".join(f"<span>{quote(word)}</span>" for word in words)
    return f'<div class="{kind}" aria-hidden="true">{inside}</div>'


def _leaflet_style() -> str:
    """Read Leaflet's style sheet without references to pictures, which the page does not use."""
    return re.sub(r"[\w-]+:\s*url\([^)]*\);?", "", _read("leaflet/leaflet.css"))


def _leaflet_script() -> str:
    """Read Leaflet's script without the reference to its source map."""
    return re.sub(r"\n//# sourceMappingURL=.*\s*$", "\n", _read("leaflet/leaflet.js"))


def _data(briefing: Briefing) -> dict[str, Any]:
    """Collect the data for the script of the page."""
    whole = map_panel.bounds(briefing.layers)
    count = max(len(briefing.fronts) - 1, 1)
    sources = briefing.station_file.sources if briefing.station_file else ()
    return {
        "view": _corners(map_panel.view(briefing.fronts, whole)),
        "bounds": _corners(whole),
        "credit": ", ".join(_short(name) for name in (briefing.run.name, *(each.name for each in sources))),
        "overlays": {
            layer.name: {"bounds": _corners(layer.box), "opacity": layer.opacity, "order": order}
            for order, layer in enumerate(briefing.layers, 1)
        },
        "fronts": front_geojson.feature_collection(briefing.fronts, briefing.tolerance),
        "observed": front_geojson.perimeter_collection(briefing.run, briefing.observed)
        if briefing.observed
        else None,
        "times": _times(briefing),
        "step_ms": round(float(np.clip(_PLAY_MS / count, *_STEP_MS))),
        "marks": briefing.marks,
        "front": {
            "edge": FRONT_EDGE,
            "fill": FRONT_FILL,
            "observed": map_symbols.LINES["Observed Perimeter"].colour,
        },
        "context": context_layer.layers(briefing.context, whole),
        "symbols": context_layer.drawings(briefing.context),
        "points": [_point(briefing, point) for point in briefing.points],
    }


def _short(name: str) -> str:
    """Shorten a name for the attribution of the map; the list of sources has the full name."""
    return name if len(name) <= _CREDIT else f"{name[: _CREDIT - 1]}…"


def _corners(box: Box) -> list[list[float]]:
    return [[box.south, box.west], [box.north, box.east]]


def _times(briefing: Briefing) -> list[dict[str, Any]]:
    place = curve.axes(briefing.fronts, briefing.facts["reported"])
    return [
        {
            "utc": times.iso(front.utc),
            "utc_text": f"{front.utc:%d %b %H:%M} UTC",
            "local": local,
            "area": units.area(front.area, briefing.units),
            "x": place.x(front.utc),
        }
        for front, local in zip(briefing.fronts, briefing.moments, strict=True)
    ]


def _point(briefing: Briefing, point: Point) -> dict[str, Any]:
    reached = point.reached
    return {
        "id": point.id,
        "name": point.name,
        "kind": point.kind,
        "latitude": round(point.latitude, 6),
        "longitude": round(point.longitude, 6),
        "state": reached.state,
        "time": None if reached.time is None else times.iso(times.utc(briefing.run, reached.time)),
        "text": str(reached.text),
        "exercise": point.station is not None and "exercise" in briefing.origins(point.station),
    }
