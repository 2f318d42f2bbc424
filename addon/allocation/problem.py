"""An allocation problem as arrays, which a worker process gets and solves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .divisions import Divisions
from .resources import Unit, costs, is_of, minutes

SMALLEST = 0.01  # of the currency: costs and losses count in whole multiples of it

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Request:
    """What is asked for.

    Attributes
    ----------
    budget
        Most that all resources may cost; None: no limit.
    response, limit
        Standard response: least number by type or kind, of which each arrives within `limit` minutes.
    loss
        Loss by burned area, per hectare.
    escape
        Loss of a division that is not contained; None: each has to be contained.
    """

    budget: float | None = None
    response: dict[str, int] = field(default_factory=dict)
    limit: float = 60.0
    loss: float = 0.0
    escape: float | None = None


@dataclass(frozen=True)
class Problem:
    """Arrays over resources (n), divisions (k) and hours (t). All have a front at some hour.

    Attributes
    ----------
    ids, types
        (n,) in the order by which ties are broken.
    minutes
        (n, k) from the order to the arrival.
    rate, cost
        (n,) line rate, m/h, and cost of the whole period.
    hours
        (t,) hours after the order.
    perimeter, loss
        (k, t) front to be held, m, and loss if it is contained then. NaN: it cannot be; the fire comes later.
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
        """Line (n, k, t), m, that each resource has built in each division by each hour."""
        worked = np.maximum(self.hours - self.minutes[..., None] / 60.0, 0.0)
        return self.rate[:, None, None] * worked

    @property
    def in_time(self) -> NDArray[np.bool_]:
        """Which resources (n, k) arrive within the limit of the standard response."""
        return self.minutes <= self.request.limit

    @property
    def escape(self) -> Array:
        """Loss (k,) of each division that is not contained, with what it has burned by the last hour."""
        return self.loss[:, -1] + (self.request.escape or 0.0)

    def of(self, wanted: str) -> NDArray[np.bool_]:
        """Which resources (n,) are of a type or kind."""
        return np.array([is_of(each, wanted) for each in self.types], bool)

    def as_json(self) -> dict[str, Any]:
        """The same as JSON can hold it."""
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in ((part.name, getattr(self, part.name)) for part in fields(self))
        } | {"request": asdict(self.request)}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Problem:
        """The problem of `as_json`."""
        many = len(data["ids"]), len(data["perimeter"])
        arrays = {name: np.array(data[name], np.float64) for name in _ARRAYS}
        arrays["minutes"] = arrays["minutes"].reshape(many)
        ids, types = (tuple(data[name]) for name in ("ids", "types"))
        return cls(ids, types, request=Request(**data["request"]), **arrays)


_ARRAYS = ("minutes", "rate", "cost", "hours", "perimeter", "loss")


def state(resources: Sequence[Unit], divisions: Divisions, request: Request) -> tuple[Problem, list[int]]:
    """Problem of resources in the order of their ids, and which divisions are in it: those that burn.

    A resource is paid for mobilising, and from the order to the end of the period. Before the first hour with
    a front a division cannot be contained: the fire would come to it later.
    """
    burning = [k for k in range(len(divisions.perimeter)) if divisions.perimeter[k].any()]
    perimeter = divisions.perimeter[burning]
    come = np.maximum.accumulate(perimeter > 0.0, axis=1)
    loss = np.round(request.loss * divisions.burned[burning] / 1e4 / SMALLEST) * SMALLEST
    period = float(divisions.hours[-1])
    problem = Problem(
        tuple(each.id for each in resources),
        tuple(each.type for each in resources),
        minutes(resources, divisions.place[burning]),
        np.array([each.line_m_h or 0.0 for each in resources], np.float64),
        np.round(costs(resources, period) / SMALLEST) * SMALLEST,
        divisions.hours,
        np.where(come, perimeter, np.nan),
        np.where(come, loss, np.nan),
        request,
    )
    return problem, burning
