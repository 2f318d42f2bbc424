"""Text of a suggested allocation for the sidebar: made once for each result, not while a panel is drawn."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from datetime import datetime, timedelta
from typing import Any, NamedTuple

from ...run import times

_MOST = 40
"""Maximum number of resources listed in a block, so that a panel stays quick."""


class Block(NamedTuple):
    """A division, or the resources left out: name, title with an icon, and lines."""

    name: str
    title: str
    icon: str
    lines: tuple[str, ...]


class AllocationText(NamedTuple):
    """A result: label of the exercise, run folder and station file, first lines, blocks."""

    label: str
    files: tuple[str, str]
    head: tuple[str, ...]
    blocks: tuple[Block, ...]


@functools.lru_cache(maxsize=4)
def describe(text: str) -> AllocationText:
    """Describe a result stored as JSON (see `allocation.suggestion.describe`)."""
    try:
        return _describe(json.loads(text))
    except (LookupError, TypeError, ValueError, AttributeError, RecursionError, OverflowError):
        return AllocationText("", ("", ""), ("The stored result cannot be read; suggest again",), ())


def _describe(found: dict[str, Any]) -> AllocationText:
    blocks = [_division(each, found) for each in found["divisions"]]
    if left := found["left_out"]:
        blocks.append(Block("left_out", f"Resources left out: {len(left)}", "INFO", tuple(_cut(left))))
    run, file = found["files"]
    return AllocationText(found["label"], (run, file), tuple(_head(found)), tuple(blocks))


def _head(result: dict[str, Any]) -> Iterator[str]:
    yield f"Ordered {_time(result, 0.0)}, for {result['hours'][-1]:g} h"
    for reason in result["reasons"]:
        yield f"No allocation: {reason}"
    if result["sums"]:
        currency = result["units"]["cost"]
        yield f"Cost {result['sums']['cost']:,.0f} {currency}".rstrip()


def _division(division: dict[str, Any], result: dict[str, Any]) -> Block:
    name, front = division["name"], division["perimeter"]
    if not any(front):
        return Block(name, f"Division {name}: no fire", "BLANK1", ())
    if result["sums"] is None:
        last = f"Front {front[-1]:,.0f} m at hour {result['hours'][-1]:g}"
        return Block(name, f"Division {name}: no allocation", "ERROR", (last,))
    hour = division["contained_at_hour"]
    if hour is None:
        lines = [*_resources(division["resources"], result), *_plan(division.get("nearest_plan"), result)]
        return Block(name, f"Division {name}: cannot be held", "ERROR", tuple(lines))
    there = front[result["hours"].index(hour)]
    lines = [
        f"Contained {_time(result, hour)}, after {hour:g} h",
        f"Line {division['line']:,.0f} m, front {there:,.0f} m",
        *_resources(division["resources"], result),
    ]
    return Block(name, f"Division {name}: held", "CHECKMARK", tuple(lines))


def _plan(plan: dict[str, Any] | None, result: dict[str, Any]) -> Iterator[str]:
    """Describe the nearest feasible plan of a division that cannot be held."""
    if plan is None:
        return
    part = 100.0 * plan["line"] / plan["front"] if plan["front"] else 100.0
    yield f"Nearest feasible plan: {plan['line']:,.0f} m of {plan['front']:,.0f} m ({part:.0f} %)"
    yield f"by {_time(result, plan['hour'])}; {plan['missing']:,.0f} m are missing"
    hour = plan["hour_of_all"]
    contain = "would not contain it" if hour is None else f"would contain it by {_time(result, hour)}"
    yield f"All available resources together {contain}"
    yield from _resources(plan["resources"], result)


def _resources(sent: list[dict[str, Any]], found: dict[str, Any]) -> Iterator[str]:
    lines = []
    for each in sent:
        station = f", {each['station']}" if each["station"] and each["station"] != each["name"] else ""
        arrival = _time(found, each["arrival"] / 60.0)
        lines.append(f"{each['name']} ({each['type']}{station}): arrives {arrival}")
    yield from _cut(lines)


def _cut(lines: list[str]) -> Iterator[str]:
    """Limit a list, and add a line with the number of omitted entries."""
    yield from lines[:_MOST]
    if len(lines) > _MOST:
        yield f"and {len(lines) - _MOST} more; firetwin allocate lists all"


def _time(found: dict[str, Any], hours: float) -> str:
    """Return the time some hours after the order, in the zone of the fire."""
    return times.text(datetime.fromisoformat(found["from"]) + timedelta(hours=hours), found["zone"])
