"""Integer program of `containment`: variables, constraints and bounds, and the call of SciPy's HiGHS."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import extras
from ..errors import Error
from . import symmetry
from .problem import Problem

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Array = NDArray[np.float64]

TIME_LIMIT = 60.0
"""Time limit, s; the best answer so far is returned, and a repetition can give another one."""
NODES = 3000
"""Limit of nodes of the search tree; the best answer so far is returned, equal on every machine."""
GAP = 1e-3
"""Relative gap to the best bound at which the search ends."""
KM = 1000.0
"""Unit of length in constraints, m: values near 1 suit the tolerances of the solver."""


@dataclass(frozen=True)
class Options:
    """Options of the solver."""

    time_limit: float = TIME_LIMIT
    gap: float = GAP
    nodes: int = NODES


USUAL = Options()


def import_scipy() -> ModuleType:
    """Import SciPy's optimisation.

    Raises
    ------
    Error
        SciPy is missing; the message has the install command.
    """
    try:
        import scipy.optimize
    except ImportError:
        pip = extras.install("resources")
        raise Error(
            f"allocation needs the Python package scipy, not in Blender; install it with: {pip}"
        ) from None
    return scipy.optimize


class Model:
    """Constraints and bounds over x (c, k), y (k, t + 1) with "escapes" last, and missing line (k,), km.

    x counts the resources of a class (`symmetry`) that are sent to a division.
    """

    def __init__(self, problem: Problem, slack: bool = False) -> None:
        self.problem, self.classes = problem, symmetry.find_classes(problem)
        self.first = np.array([members[0] for members in self.classes], np.int64)
        self.k, self.t = problem.perimeter.shape
        end = len(self.classes) * self.k
        self.x = np.arange(end).reshape(-1, self.k)
        self.y = end + np.arange(self.k * (self.t + 1)).reshape(self.k, self.t + 1)
        end += self.y.size
        self.slack = end + np.arange(self.k if slack else 0)
        self.count = end + self.slack.size
        self._rows: list[tuple[NDArray, NDArray, Array]] = []
        self._low: list[float] = []
        self._high: list[float] = []
        self._build()

    def objective(self) -> Array:
        """Return the weights of costs and losses."""
        weight = np.zeros(self.count)
        weight[self.x] = self.problem.cost[self.first][:, None]
        weight[self.y[:, :-1]] = np.nan_to_num(self.problem.loss)
        weight[self.y[:, -1]] = self.problem.escape
        return weight

    def shortfall(self) -> Array:
        """Return the weights of the missing line, km."""
        weight = np.zeros(self.count)
        weight[self.slack] = 1.0
        return weight

    def run(self, weight: Array, options: Options) -> tuple[Array | None, float, bool]:
        """Solve; return values, bound, and True if the time limit was not reached; None if infeasible."""
        optimize = import_scipy()
        rows = optimize.LinearConstraint(self._matrix(), self._low, self._high)
        result = optimize.milp(
            weight,
            integrality=np.append(np.ones(self.count - self.slack.size), np.zeros(self.slack.size)),
            bounds=optimize.Bounds(np.zeros(self.count), self._most()),
            constraints=rows,
            options={
                "time_limit": options.time_limit,
                "mip_rel_gap": options.gap,
                "node_limit": options.nodes,
            },
        )
        if result.status == 2:
            return None, np.inf, True
        if result.x is None:
            raise Error(
                f"the solver reached its limit of {options.time_limit:g} s; request fewer divisions or "
                "hours, or use fewer resources"
            )
        over = result.status == 1 and result.mip_node_count < options.nodes
        return result.x, float(result.mip_dual_bound), not over

    def read(self, values: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return counts by class and division (c, k), and the hour of containment (k,), -1: escapes."""
        hour = np.argmax(values[self.y], axis=1)
        return np.round(values[self.x]).astype(np.int64), np.where(hour == self.t, -1, hour)

    def _most(self) -> Array:
        """Return the upper bounds: 0 for variables that are impossible or cannot contribute."""
        most = np.ones(self.count)
        wanted = np.zeros(self.problem.minutes.shape, bool)
        for kind in self.problem.request.response:
            wanted |= self.problem.of(kind)[:, None] & self.problem.in_time
        helps = wanted | (self.problem.line[..., -1] > 0.0)
        most[self.x] = helps[self.first] * self._sizes[:, None]
        most[self.y[:, :-1]] = np.isfinite(self.problem.perimeter)
        most[self.y[:, -1]] = self.problem.request.escape is not None
        most[self.slack] = np.inf
        return most

    @property
    def _sizes(self) -> Array:
        return np.array([len(members) for members in self.classes], np.float64)

    def _build(self) -> None:
        problem = self.problem
        for k in range(self.k):
            self._add(self.y[k], np.ones(self.t + 1), 1.0, 1.0)
        for own, size in zip(self.x, self._sizes, strict=True):
            self._add(own, np.ones(self.k), -np.inf, float(size))
        front = np.nan_to_num(problem.perimeter) / KM
        line = np.minimum(problem.line[self.first] / KM, np.maximum.accumulate(front, axis=1))
        for k in range(self.k):
            for t in range(self.t):
                which = np.concatenate([self.x[:, k], self.y[k, : t + 1], self.slack[k : k + 1]])
                missing = np.ones(self.slack[k : k + 1].size)
                self._add(which, np.concatenate([line[:, k, t], -front[k, : t + 1], missing]), 0.0, np.inf)
        if problem.request.budget is not None:
            cost = np.repeat(problem.cost[self.first], self.k)
            self._add(self.x.ravel(), cost, -np.inf, problem.request.budget)
        for kind, number in problem.request.response.items():
            which = self.x[(problem.of(kind)[:, None] & problem.in_time)[self.first]]
            self._add(which, np.ones(which.size), float(number), np.inf)

    def _add(self, which: NDArray, weight: Array, low: float, high: float) -> None:
        self._rows.append((np.full(which.size, len(self._rows)), which, weight))
        self._low.append(low)
        self._high.append(high)

    def _matrix(self) -> csr_array:
        from scipy.sparse import csr_array

        row, column, weight = (np.concatenate(part) for part in zip(*self._rows, strict=True))
        return csr_array((weight, (row, column)), shape=(len(self._rows), self.count))
