"""Suggested allocation as JSON data: divisions with their resources, sums, assumptions and limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..stations.records import AIR, DETOUR, EXERCISE
from . import LIMITS, containment
from .containment import Answer, PartialPlan
from .control_line import USUAL, LineOptions
from .divisions import Divisions
from .nearest import Nearest
from .problem import Problem
from .resources import Unit

UNITS = {"perimeter": "m", "line": "m", "arrival": "min", "hour": "h", "position": "degrees"}


@dataclass(frozen=True)
class AllocationInput:
    """Resources (n), divisions, indices (k) of the burning ones, and their problem."""

    resources: Sequence[Unit]
    left_out: list[str]
    divisions: Divisions
    burning: list[int]
    problem: Problem
    line: LineOptions = USUAL

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the divisions in the problem."""
        return tuple(self.divisions.names[k] for k in self.burning)


def describe(
    asked: AllocationInput,
    answer: Answer | None,
    rest: PartialPlan | None,
    pairs: list[Nearest],
    reasons: list[str],
) -> dict[str, Any]:
    """Return the suggestion, or the reasons if it is infeasible."""
    request, divisions = asked.problem.request, asked.divisions
    return {
        "label": EXERCISE,
        "status": "suggested" if answer is not None else "infeasible",
        "reasons": reasons,
        "centre": {"latitude": divisions.centre[0], "longitude": divisions.centre[1]},
        "hours": divisions.hours.tolist(),
        "budget": request.budget,
        "standard_response": request.response,
        "response_minutes": request.limit,
        "divisions": [_division(asked, answer, rest, k) for k in range(len(divisions.names))],
        "sums": None if answer is None else _sums(answer),
        "nearest": [_pair(asked, each) for each in pairs],
        "left_out": asked.left_out,
        "units": UNITS | {"cost": _currency(asked)},
        "assumptions": _assumptions(asked),
        "limits": list(LIMITS),
    }


def _division(
    asked: AllocationInput, answer: Answer | None, rest: PartialPlan | None, which: int
) -> dict[str, Any]:
    divisions = asked.divisions
    facts: dict[str, Any] = {
        "name": divisions.names[which],
        "bearings": list(divisions.bearings(which)),
        "perimeter": divisions.perimeter[which].round(1).tolist(),
        "detailed_perimeter": divisions.detailed[which].round(1).tolist(),
        "contained_at_hour": None,
        "resources": [],
    }
    if answer is None or which not in asked.burning:
        return facts
    k, problem = asked.burning.index(which), asked.problem
    hour = int(answer.hour[k])
    line = containment.built_line(problem, answer.division)[k, hour]
    held = hour >= 0
    facts |= {
        "contained_at_hour": float(problem.hours[hour]) if held else None,
        "line": round(float(line), 1),
    }
    facts["resources"] = _resources(asked, np.flatnonzero(answer.division == k), k, hour)
    if not held and rest is not None:
        facts["nearest_plan"] = _partial(asked, rest, k)
    return facts


def _resources(asked: AllocationInput, sent: NDArray[np.int64], k: int, hour: int) -> list[dict[str, Any]]:
    problem = asked.problem
    return [
        {
            "id": problem.ids[i],
            "type": problem.types[i],
            "name": asked.resources[i].title,
            "station": asked.resources[i].station,
            "origin": asked.resources[i].origin,
            "arrival": round(float(problem.minutes[i, k]), 1),
            "line": round(float(problem.line[i, k, hour]), 1),
            "cost": round(float(problem.cost[i]), 2),
        }
        for i in sent
    ]


def _partial(asked: AllocationInput, rest: PartialPlan, k: int) -> dict[str, Any]:
    """Describe the nearest feasible plan of a division that cannot be held, by the last hour."""
    problem, sent = asked.problem, np.flatnonzero(rest.division == k)
    last, front = float(problem.hours[-1]), float(problem.perimeter[k, -1])
    line = min(float(rest.line[k]), front)
    every = problem.line[:, k].sum(axis=0)
    holds = every >= problem.perimeter[k]  # False for NaN
    return {
        "hour": last,
        "front": round(front, 1),
        "line": round(line, 1),
        "missing": round(front - line, 1),
        "missing_rate": round((front - line) / last, 1),
        "line_of_all": round(float(every[-1]), 1),
        "hour_of_all": float(problem.hours[holds.argmax()]) if holds.any() else None,
        "cost": round(float(problem.cost[sent].sum()), 2),
        "resources": _resources(asked, sent, k, -1),
    }


def _sums(answer: Answer) -> dict[str, Any]:
    total = answer.cost + answer.loss
    return {
        "cost": round(answer.cost, 2),
        "loss": round(answer.loss, 2),
        "above_bound": 0.0 if total <= 0.0 else max(0.0, round(1.0 - answer.bound / total, 6)),
        "same_each_time": answer.in_time,
    }


def _pair(asked: AllocationInput, each: Nearest) -> dict[str, Any]:
    return {
        "kind": each.kind,
        "division": asked.names[each.division],
        "id": asked.problem.ids[each.resource],
        "name": asked.resources[each.resource].title,
        "station": asked.resources[each.resource].station,
        "arrival": round(each.minutes, 1),
    }


def _currency(asked: AllocationInput) -> str:
    return next((each.currency for each in asked.resources if each.currency), "")


def _assumptions(asked: AllocationInput) -> list[str]:
    request, period = asked.problem.request, asked.divisions.hours[-1]
    escape = (
        "must be contained" if request.escape is None else f"may escape at a loss of {request.escape:,.2f}"
    )
    return [
        f"divisions are sectors around the centre of the area burned by the time of the order; each {escape}",
        asked.line.describe(),
        "a division is contained at the first hour at which its line is as long as its front in the run, "
        "measured on the map without slopes",
        f"a resource works in one division and is paid for mobilisation and {period:g} h",
        f"travel is to the middle of the first front of a division: roads are {DETOUR:g} times the straight "
        f"distance, {' and '.join(AIR)} fly straight",
        f"burned ground is a loss of {request.loss:,.2f} per hectare",
    ]
