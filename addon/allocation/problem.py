"""Allocation problem as arrays, for the worker process that solves it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .divisions import Divisions
from .resources import Unit, is_of, period_costs, travel_times

SMALLEST = 0.01  # unit of costs and losses, in the currency

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Request:
    """Request of the user.

    Attributes
    ----------
    budget
        Maximum cost of all resources; None: no limit.
    response, limit
        Standard response: minimum number by type or kind that arrives within `limit` minutes.
    loss
        Loss per hectare of burned area.
    escape
        Loss of a division that is not contained; None: each must be contained; infinite: more than the cost
        of all resources, so that as many divisions as possible are contained.
    """

    budget: float | None = None
    response: dict[str, int] = field(default_factory=dict)
    limit: float = 60.0
    loss: float = 0.0
    escape: float | None = None


@dataclass(frozen=True)
class Problem:
    """Arrays over resources (n), divisions (k) and hours (t). Each division has a front at some hour.

    Attributes
    ----------
    ids, types
        (n,) in ascending order of ids; ties go to lower ids.
    minutes
        (n, k) time from the order to the arrival, min.
    rate, cost
        (n,) line rate, m/h, and cost of the period.
    hours
        (t,) hours after the order.
    perimeter, loss
        (k, t) length of the front, m, and loss if it is contained at this hour. NaN: not yet burning.
    """

    ids: tuple[str, ...]
    types: tuple[str, ...]
    minutes: Array
    rate: Array
    cost: Array
    hours: Array
    perimeter: Array
    loss: Array
    request: Request

    @property
    def line(self) -> Array:
        """Line (n, k, t), m, that each resource can build in each division by each hour."""
        worked = np.maximum(self.hours - self.minutes[..., None] / 60.0, 0.0)
        return self.rate[:, None, None] * worked

    @property
    def in_time(self) -> NDArray[np.bool_]:
        """Mask (n, k) of resources that arrive within the time limit of the standard response."""
        return self.minutes <= self.request.limit

    @property
    def escape(self) -> Array:
        """Loss (k,) of a division that is not contained, including its burned area by the last hour."""
        return self.loss[:, -1] + (self.request.escape or 0.0)

    def of(self, wanted: str) -> NDArray[np.bool_]:
        """Return a mask (n,) of the resources of a type or kind."""
        return np.array([is_of(each, wanted) for each in self.types], bool)


def set_escape_loss(request: Request, costs: Array) -> Request:
    """Replace an infinite escape loss by one above the sum of costs (n,), in full thousands."""
    if request.escape is None or np.isfinite(request.escape):
        return request
    return replace(request, escape=1000.0 * float(np.floor(costs.sum() / 1000.0) + 1.0))


def make_problem(
    resources: Sequence[Unit], divisions: Divisions, request: Request
) -> tuple[Problem, list[int]]:
    """Make the problem of resources, by ascending id, and of burning divisions; return their indices.

    A resource is paid for mobilisation, and from the order to the end of the period. A division cannot be
    contained before the first hour at which it has a front.
    """
    burning = [k for k in range(len(divisions.perimeter)) if divisions.perimeter[k].any()]
    perimeter = divisions.perimeter[burning]
    come = np.maximum.accumulate(perimeter > 0.0, axis=1)
    loss = np.round(request.loss * divisions.burned[burning] / 1e4 / SMALLEST) * SMALLEST
    period = float(divisions.hours[-1])
    costs = np.round(period_costs(resources, period) / SMALLEST) * SMALLEST
    problem = Problem(
        tuple(each.id for each in resources),
        tuple(each.type for each in resources),
        travel_times(resources, divisions.place[burning]),
        np.array([each.line_m_h or 0.0 for each in resources], np.float64),
        costs,
        divisions.hours,
        np.where(come, perimeter, np.nan),
        np.where(come, loss, np.nan),
        set_escape_loss(request, costs),
    )
    return problem, burning
