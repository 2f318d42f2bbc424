"""Reasons for an infeasible allocation: missing resources of a type, missing line, or missing budget."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from . import containment
from .model import USUAL, Options
from .problem import SMALLEST, Problem

_LEAST = 0.1  # m of line


def explain(problem: Problem, names: tuple[str, ...], options: Options = USUAL) -> list[str]:
    """Explain the shortfall, in this order: types of the standard response, line, budget.

    Parameters
    ----------
    names
        (k,) names of the divisions.
    """
    if found := _response(problem):
        return found
    if problem.request.escape is None and (found := _line(problem, names, options)):
        return found
    return _budget(problem, options)


def _response(problem: Problem) -> list[str]:
    texts, limit = [], problem.request.limit
    for kind, number in problem.request.response.items():
        of_kind = problem.of(kind)
        there = int((of_kind & problem.in_time.any(axis=1)).sum())
        if there >= number:
            continue
        text = (
            f"the standard response is short of {number - there} of {number} {kind}: {there} can arrive "
            f"within {limit:g} min"
        )
        late = np.sort(problem.minutes[of_kind].min(axis=1, initial=np.inf))[there:number]
        if late.size == number - there:
            text += f"; {number} can arrive within {np.ceil(late[-1]):.0f} min"
        else:
            text += f"; the file has {int(of_kind.sum())}"
        texts.append(text)
    return texts


def _line(problem: Problem, names: tuple[str, ...], options: Options) -> list[str]:
    missing, hour = containment.minimum_shortfall(problem, options)
    short = np.flatnonzero(missing > _LEAST)
    if not short.size:
        return []
    hours = problem.hours[hour]
    each = ", ".join(
        f"{missing[k]:,.0f} m of the {problem.perimeter[k, hour[k]]:,.0f} m of division {names[k]} at hour "
        f"{hours[k]:g}"
        for k in short
    )
    rate = (missing / hours)[short].sum()
    return [
        f"the line rate is too low: with all resources {each} are missing, a rate of {rate:,.0f} m/h from "
        "the order"
    ]


def _budget(problem: Problem, options: Options) -> list[str]:
    limit = problem.request.budget
    if limit is None:
        return []
    free = replace(problem.request, budget=None, loss=0.0)
    cheapest = replace(problem, request=free, loss=np.where(np.isnan(problem.loss), np.nan, 0.0))
    answer = containment.solve(cheapest, options)
    if answer is None:
        return []
    short = max(answer.cost - limit, SMALLEST)
    least = "" if answer.bound > answer.cost - SMALLEST else f"; none costs less than {answer.bound:,.2f}"
    return [
        f"the budget of {limit:,.2f} is too small by {short:,.2f}: the cheapest allocation found costs "
        f"{answer.cost:,.2f}{least}"
    ]
