"""Tables by division, a resource in each row as in form ICS 204, from the layer of `firetwin allocate`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..html_text import quote
from ..run.measure import Units
from ..stations.records import EXERCISE
from . import context, units
from .briefing import Briefing

_HEAD = ("Number", "Resource", "Type", "Station", "Arrives after", "Line", "Leader, contact")


def section(briefing: Briefing) -> str:
    """Build a table for each division; empty without an allocation among the context files."""
    rows = [feature.properties for each in briefing.context for feature in each.features]
    rows = [row for row in rows if row.get("division") and row.get("kind") in ("control_line", "resource")]
    names = sorted({str(row["division"]) for row in rows})
    if not names:
        return ""
    tables = "".join(_table(name, rows, briefing.units) for name in names)
    warning = f'<p class="warn"><b>{EXERCISE}.</b> The allocation is a suggestion.</p>'
    return (
        '<section aria-labelledby="divisions-title"><h2 id="divisions-title">Divisions</h2>'
        f'{warning}<div class="wide">{tables}</div></section>'
    )


def _table(name: str, rows: list[Any], order: Units) -> str:
    own = [row for row in rows if str(row["division"]) == name]
    lines = [row for row in own if row["kind"] == "control_line"]
    caption = quote(
        ", ".join((f"Division {name}", *(text for row in lines[:1] for text in _state(row, order))))
    )
    head = "".join(f'<th scope="col" class="text">{title}</th>' for title in _HEAD)
    sent = [row for row in own if row["kind"] == "resource"]
    inside = "".join(_row(row, order) for row in sent)
    empty = f'<tr><td class="text" colspan="{len(_HEAD)}">no resources</td></tr>'
    return (
        f'<table class="resources division"><caption>{caption}</caption><thead><tr>{head}</tr></thead>'
        f"<tbody>{inside or empty}</tbody></table>"
    )


def _state(row: Any, order: Units) -> Iterator[str]:
    hour = f"{_number(row, 'hour'):g}"
    yield f"contained at hour {hour}" if row.get("held") else f"cannot be held by hour {hour}"
    built = row.get("line_m")
    front = units.length(_number(row, "front_m"), order)
    yield (
        f"front {front}"
        if built is None
        else f"line {units.length(_number(row, 'line_m'), order)} of {front}"
    )


def _row(row: Any, order: Units) -> str:
    cells = (
        row.get(context.NUMBER, ""), row.get("name", ""), row.get("type", ""), row.get("station", ""),
        f"{_number(row, 'arrival_min'):.0f} min", units.length(_number(row, "line_m"), order), "",
    )  # fmt: skip
    return "<tr>" + "".join(f'<td class="text">{quote(cell)}</td>' for cell in cells) + "</tr>\n"


def _number(row: Any, name: str) -> float:
    """Return a number of a feature; 0.0 if a foreign file has another value."""
    value = row.get(name)
    return float(value) if isinstance(value, int | float) else 0.0
