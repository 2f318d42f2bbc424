"""Text of a suggested allocation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

_LENGTHS = ("perimeter", "detailed_perimeter")


def format_text(found: dict[str, Any], lines: dict[str, list[str]]) -> str:
    """Format divisions, with further lines by name, sums, assumptions and limits between two labels."""
    return "\n".join(_lines(found, lines))


def _lines(result: dict[str, Any], more: dict[str, list[str]]) -> Iterator[str]:
    label, cost = f"*** {result['label']} ***", result["units"]["cost"]
    money = f" {cost}" if cost else ""
    yield label
    yield f"run {result['run']}, ordered {result['from']}, {result['hours'][-1]:g} h"
    for hour in (0, -1):
        line, front = (sum(each[name][hour] for each in result["divisions"]) for name in _LENGTHS)
        yield f"control line {line:,.0f} m at hour {result['hours'][hour]:g}; front in detail {front:,.0f} m"
    for reason in result["reasons"]:
        yield f"no allocation: {reason}"
    for division in result["divisions"]:
        yield ""
        yield from _division(division, result, money, more.get(division["name"], []))
    if result["sums"]:
        sums = result["sums"]
        yield ""
        of = "" if result["budget"] is None else f" of a budget of {result['budget']:,.2f}"
        yield f"cost {sums['cost']:,.2f}{of}{money}, loss {sums['loss']:,.2f}{money}"
        if sums["above_bound"] > 0.0:
            yield f"another allocation may be up to {100.0 * sums['above_bound']:.2g} % cheaper"
        if not sums["same_each_time"]:
            yield "the time limit ended the search: a repetition can find another allocation"
    yield from _listed("nearest of each kind, each resource once", map(_pair, result["nearest"]))
    yield from _listed("left out", result["left_out"])
    yield from _listed("assumptions", result["assumptions"])
    yield from _listed("limits", result["limits"])
    yield ""
    yield label


def _division(
    division: dict[str, Any], result: dict[str, Any], money: str, lines: list[str]
) -> Iterator[str]:
    low, high = division["bearings"]
    front = division["perimeter"]
    head = f"division {division['name']}, {low:g} to {high:g} degrees from north"
    if not any(front):
        yield f"{head}: no front"
        return
    if result["sums"] is None:
        yield f"{head}: front {front[0]:,.0f} m at hour 1, {front[-1]:,.0f} m at hour {result['hours'][-1]:g}"
        return
    hour = division["contained_at_hour"]
    if hour is None:
        yield f"{head}: cannot be held, with a front of {front[-1]:,.0f} m at hour {result['hours'][-1]:g}"
    else:
        there = front[result["hours"].index(hour)]
        yield f"{head}: contained at hour {hour:g}, line {division['line']:,.0f} m of {there:,.0f} m"
    yield from (_resource(each, money) for each in division["resources"])
    yield from (f"  {line}" for line in lines)
    if plan := division.get("nearest_plan"):
        yield from _plan(plan, money)


def _plan(plan: dict[str, Any], money: str) -> Iterator[str]:
    part = 100.0 * plan["line"] / plan["front"] if plan["front"] else 100.0
    yield (
        f"  nearest feasible plan: {plan['line']:,.0f} m ({part:.0f} %) by hour {plan['hour']:g}, for "
        f"another {plan['cost']:,.2f}{money}"
    )
    yield f"  it misses {plan['missing']:,.0f} m, a rate of {plan['missing_rate']:,.0f} m/h from the order"
    every, hour = plan["line_of_all"], plan["hour_of_all"]
    contain = "would not contain it" if hour is None else f"would contain it at hour {hour:g}"
    yield f"  all resources together {contain}: they build {every:,.0f} m by hour {plan['hour']:g}"
    yield from (_resource(each, money) for each in plan["resources"])


def _resource(each: dict[str, Any], money: str) -> str:
    return (
        f"  {each['name']:<36} {each['type']:<14} arrives after {each['arrival']:>4.0f} "
        f"min, line {each['line']:>7,.0f} m, cost {each['cost']:>10,.2f}{money} ({each['origin']})"
    )


def _pair(each: dict[str, Any]) -> str:
    return f"{each['kind']} for {each['division']}: {each['name']}, {each['arrival']:.0f} min"


def _listed(title: str, lines: Any) -> Iterator[str]:
    lines = list(lines)
    if lines:
        yield ""
        yield f"{title}:"
        yield from (f"- {line}" for line in lines)
