"""Containment as an integer program after Donovan and Rideout (2003), solved by SciPy's HiGHS.

Over resources i, divisions k and hours t, with binaries x_ik (i is sent to k) and y_kt (k is contained at
t; -1: it escapes); interchangeable resources share an integer (`symmetry`)::

    minimise    sum cost_i x_ik + sum loss_kt y_kt
    subject to  sum_t y_kt = 1                                          one hour per division
                sum_k x_ik <= 1                                         at most one division per resource
                sum_i line_ikt x_ik >= sum_{s<=t} perimeter_ks y_ks     line at least as long as the front
                sum cost_i x_ik <= budget
                sum of x_ik that arrive in time >= number               for each type of the response

The third constraint is `line >= perimeter - M (1 - y)` with the smallest M, the perimeter itself, for all
hours up to t together, as built line only grows. The line of one resource counts up to the longest front of
these hours.

Ties are decided after the solver, whose gap is larger than any weight that could break them: the first hour
at which the line is as long as the front counts, and resources that the answer does not need are removed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from . import symmetry
from .model import KM, USUAL, Model, Options
from .problem import SMALLEST, Problem, Request

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

_SHORT = 0.01  # m of line, tolerance of the solver


@dataclass(frozen=True)
class Answer:
    """Solution of the integer program.

    Attributes
    ----------
    division
        (n,) division of each resource; -1: not sent.
    hour
        (k,) index of the hour of containment; -1: escapes.
    cost, loss
        Sums, in the currency.
    bound
        Lower bound of cost and loss together.
    in_time
        True if the time limit did not end the search, so that a repetition gives the same answer.
    """

    division: NDArray[np.int64]
    hour: NDArray[np.int64]
    cost: float
    loss: float
    bound: float
    in_time: bool


def solve(problem: Problem, options: Options = USUAL) -> Answer | None:
    """Find the cheapest allocation; None if there is none.

    Raises
    ------
    Error
        SciPy is missing, or the time limit was reached without an answer.
    """
    model = Model(problem)
    values, bound, in_time = model.run(model.objective(), options)
    if values is None:
        return None
    counts, _ = model.read(values)
    division = symmetry.assign(model.classes, _remove_spare(problem, model.classes, counts))
    answer = make_answer(problem, division, _first_hour(problem, built_line(problem, division)))
    return replace(answer, bound=min(bound, answer.cost + answer.loss), in_time=in_time)


@dataclass(frozen=True)
class PartialPlan:
    """Nearest feasible plan for divisions that cannot be contained: the longest line by the last hour.

    Attributes
    ----------
    division
        (n,) division of each resource that is not sent otherwise; -1: not sent.
    line
        (k,) line that is built by the last hour, m; NaN for contained divisions.
    """

    division: NDArray[np.int64]
    line: Array


def plan_the_rest(problem: Problem, answer: Answer, options: Options = USUAL) -> PartialPlan:
    """Send the remaining resources to the divisions that escape, within the remaining budget."""
    open_ = np.flatnonzero(answer.hour < 0)
    rest = np.flatnonzero(answer.division < 0)
    division = np.full(len(problem.ids), -1)
    built = built_line(problem, answer.division)[:, -1]
    if open_.size and rest.size:
        budget = problem.request.budget
        request = Request(None if budget is None else max(budget - answer.cost, 0.0))
        left = np.maximum(problem.perimeter[open_, -1:] - built[open_, None], 0.0)
        part = Problem(
            tuple(problem.ids[i] for i in rest),
            tuple(problem.types[i] for i in rest),
            problem.minutes[np.ix_(rest, open_)],
            problem.rate[rest],
            problem.cost[rest],
            problem.hours[-1:],
            left,
            np.zeros_like(left),
            request,
        )
        model = Model(part, slack=True)
        values, _, _ = model.run(model.shortfall(), options)
        assert values is not None
        found = symmetry.assign(model.classes, _useful(part, model.classes, model.read(values)[0]))
        division[rest[found >= 0]] = open_[found[found >= 0]]
    sent = np.where(division >= 0, division, answer.division)
    line = np.where(answer.hour < 0, built_line(problem, sent)[:, -1], np.nan)
    return PartialPlan(division, line)


def _useful(part: Problem, classes: list[Whole], counts: Whole) -> Whole:
    """Remove resources beyond the length of the front, the most expensive class first."""
    first = np.array([members[0] for members in classes], np.int64)
    line, front = part.line[first][..., 0], part.perimeter[:, 0]
    for c in np.argsort(-part.cost[first], kind="stable"):
        for k in range(counts.shape[1]):
            spare = float((counts * line)[:, k].sum() - front[k])
            each = float(line[c, k])
            more = counts[c, k] if each <= 0.0 else min(counts[c, k], int(max(spare, 0.0) / each))
            counts[c, k] -= more
    return counts


def minimum_shortfall(problem: Problem, options: Options = USUAL) -> tuple[Array, NDArray[np.int64]]:
    """Return the minimum line (k,), m, that is missing with all resources, and its hour (k,)."""
    model = Model(replace(problem, request=replace(problem.request, budget=None)), slack=True)
    values, _, _ = model.run(model.shortfall(), options)
    assert values is not None
    return KM * values[model.slack], model.read(values)[1]


def _remove_spare(problem: Problem, classes: list[Whole], counts: Whole) -> Whole:
    """Remove resources that the answer does not need, the most expensive class and the last division first.

    Their cost is within the solver's gap, or 0.
    """
    first = np.array([members[0] for members in classes], np.int64)
    line, in_time = problem.line[first], problem.in_time[first]
    wanted = [(problem.of(kind)[first], number) for kind, number in problem.request.response.items()]

    def needed(counts: Whole) -> bool:
        sent = [(counts * in_time)[of_kind].sum() for of_kind, _ in wanted]
        short = any(there < number for there, (_, number) in zip(sent, wanted, strict=True))
        return short or bool((_first_hour(problem, np.einsum("ck,ckt->kt", counts, line)) != hour).any())

    hour = _first_hour(problem, np.einsum("ck,ckt->kt", counts, line))
    for c in sorted(
        np.flatnonzero(counts.any(axis=1)), key=lambda c: (problem.cost[first[c]], c), reverse=True
    ):
        for k in reversed(range(counts.shape[1])):
            while counts[c, k]:
                fewer = counts.copy()
                fewer[c, k] -= 1
                if needed(fewer):
                    break
                counts = fewer
    return counts


def _first_hour(problem: Problem, line: Array) -> Whole:
    """Return the first hour (k,) at which the line (k, t), m, is as long as the front; -1: escapes.

    No later hour is better: the loss of a division rises from hour to hour.
    """
    held = line >= problem.perimeter - _SHORT  # False for NaN
    return np.where(held.any(axis=1), held.argmax(axis=1), -1)


def make_answer(problem: Problem, division: NDArray[np.int64], hour: NDArray[np.int64]) -> Answer:
    """Make an answer with sums computed from the arrays of the problem."""
    sent, held = division >= 0, np.flatnonzero(hour >= 0)
    losses = float(problem.loss[held, hour[held]].sum())
    if (lost := np.flatnonzero(hour < 0)).size:
        losses += float(problem.escape[lost].sum())
    cost = float(problem.cost[sent].sum())
    return Answer(division, hour, cost, losses, cost + losses, True)


def built_line(problem: Problem, division: NDArray[np.int64]) -> Array:
    """Compute the line (k, t), m, that the resources have built."""
    at = division[:, None] == np.arange(len(problem.perimeter))
    return np.einsum("nk,nkt->kt", at, problem.line)


def check(problem: Problem, answer: Answer) -> None:
    """Check an answer against the problem itself, beyond the solver's tolerances.

    Raises
    ------
    Error
        The answer breaks a constraint.
    """
    if problem.request.escape is None and (answer.hour < 0).any():
        raise Error("the solver's answer leaves a division uncontained; please report this")
    budget = problem.request.budget
    if budget is not None and answer.cost > budget + SMALLEST:
        raise Error(f"the solver's answer costs {answer.cost:.2f}, over the budget; please report this")
