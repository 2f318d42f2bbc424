"""Allocation job: a suggested allocation, solved in a worker process. Exercise: not operational advice.

Blender's process does not have SciPy, and a worker process can be stopped.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run

from ..errors import UsageError, input_error
from ..jobs import worker
from ..progress import MessageCallback, Progress, no_message, silent
from ..run import times
from . import containment, divisions, map_layer, nearest, shortfall, suggestion
from .containment import Answer, PartialPlan
from .control_line import USUAL as USUAL_LINE
from .control_line import LineOptions
from .divisions import HOUR
from .model import USUAL, Options
from .nearest import Nearest
from .problem import Problem, Request, make_problem
from .resources import Unit, select_usable

HOURS = 12
"""Hours after the order, if the run is long enough."""


def suggest(
    resources: Iterable[Unit],
    run: Run,
    request: Request,
    start: datetime | None = None,
    hours: int | None = None,
    count: int = 4,
    options: Options = USUAL,
    stop: worker.Stop | None = None,
    line: LineOptions = USUAL_LINE,
) -> dict[str, Any]:
    """Suggest an allocation of resources to `count` divisions of a run's front (see `suggestion.describe`).

    Parameters
    ----------
    start, hours
        Time of the order (by default the ignition), and hours after it.
    line
        Detail of the control line.

    Raises
    ------
    InputError, UsageError
        The run has no fire, or does not cover these hours.
    Error
        SciPy is missing, or the time limit was reached without an answer.
    StoppedError
        `stop` was used.
    """
    order = default_order_time(run) if start is None else times.seconds(run, start)
    hours = _limit_hours(run, order, hours)
    if not 1 <= count <= divisions.MOST:
        raise UsageError(f"--divisions: must be from 1 to {divisions.MOST}, not {count}")
    kept, left = select_usable(resources)
    parts = divisions.divide(run, order, hours, count, line)
    if not parts.perimeter.any():
        raise UsageError("--from: the run has no front in these hours; give a later time or more hours")
    problem, burning = make_problem(kept, parts, request)
    asked = suggestion.AllocationInput(kept, left, parts, burning, problem, line)
    solved = worker.run(
        f"{__name__}:solve_in_worker",
        {"problem": problem.as_json(), "names": asked.names, "options": asdict(options)},
        blender=False,
        stop=stop,
    )
    answer = None if solved["answer"] is None else _from_json(solved["answer"])
    rest = None if solved["rest"] is None else _plan_from_json(solved["rest"])
    pairs = [Nearest(*each) for each in solved["nearest"]]
    found = suggestion.describe(asked, answer, rest, pairs, solved["reasons"])
    found["map"] = map_layer.make(asked, answer, found)
    return {"run": run.name, "from": times.iso(times.utc(run, order)), **found}


def default_order_time(run: Run) -> float:
    """Return the model time (s) of the ignition, or of the first frame if the fire already burns.

    Raises
    ------
    InputError
        The run has no fire.
    """
    moment = divisions.ignition_time(run)
    if not np.isfinite(moment):
        raise input_error(Path(run.path), "has no fire and therefore no front to allocate resources to")
    return max(moment, float(run.times[0]))


def solve_in_worker(
    problem: dict[str, Any],
    names: list[str],
    options: dict[str, Any],
    progress: Progress = silent,
    tell: MessageCallback = no_message,
) -> dict[str, Any]:
    """Solve in the worker process, or find the reasons if it is infeasible."""
    asked, chosen = Problem.from_json(problem), Options(**options)
    answer = containment.solve(asked, chosen)
    reasons: list[str] = []
    rest = None
    if answer is None:
        reasons = shortfall.explain(asked, tuple(names), chosen)
        reasons = reasons or ["budget, line and standard response cannot be met together"]
    else:
        containment.check(asked, answer)
        rest = containment.plan_the_rest(asked, answer, chosen)
    plain = None if answer is None else asdict(answer) | _lists(answer)
    partial = None if rest is None else {name: getattr(rest, name).tolist() for name in _PLAN}
    return {"answer": plain, "rest": partial, "nearest": nearest.pair_nearest(asked), "reasons": reasons}


def _lists(answer: Answer) -> dict[str, Any]:
    return {"division": answer.division.tolist(), "hour": answer.hour.tolist()}


def _from_json(plain: dict[str, Any]) -> Answer:
    return Answer(**plain | {name: np.array(plain[name], np.int64) for name in ("division", "hour")})


_PLAN = ("division", "line")


def _plan_from_json(plain: dict[str, Any]) -> PartialPlan:
    return PartialPlan(np.array(plain["division"], np.int64), np.array(plain["line"], np.float64))


def _limit_hours(run: Run, order: float, hours: int | None) -> int:
    """Return the hours after the order, limited to the run."""
    last = float(run.times[-1])
    there = int((last - order) // HOUR) if order >= float(run.times[0]) else 0
    if there < 1:
        first, end = (times.iso(times.utc(run, float(run.times[i]))) for i in (0, -1))
        raise UsageError(
            f"--from: an hour from {times.iso(times.utc(run, order))} is not in the run, {first} to {end}"
        )
    if hours is not None and hours > there:
        raise UsageError(f"--hours: the run ends {there} h after the order; give at most {there}")
    return min(HOURS, there) if hours is None else hours
