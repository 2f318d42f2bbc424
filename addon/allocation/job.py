"""Allocation job: a suggested allocation, solved in a worker process. Exercise: not operational advice.

Blender's process does not have SciPy, and a worker process can be stopped.
"""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from functools import partial
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
    work = partial(solve_in_worker, problem, asked.names, options)
    answer, rest, pairs, reasons = worker.run(work, blender=False, stop=stop)
    found = suggestion.describe(asked, answer, rest, pairs, reasons)
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
    problem: Problem,
    names: tuple[str, ...],
    options: Options,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
) -> tuple[Answer | None, PartialPlan | None, list[Nearest], list[str]]:
    """Solve in the worker process, or find the reasons if it is infeasible."""
    answer, rest, reasons = containment.solve(problem, options), None, []
    if answer is None:
        reasons = shortfall.explain(problem, names, options)
        reasons = reasons or ["budget, line and standard response cannot be met together"]
    else:
        containment.check(problem, answer)
        rest = containment.plan_the_rest(problem, answer, options)
    return answer, rest, nearest.pair_nearest(problem), reasons


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
