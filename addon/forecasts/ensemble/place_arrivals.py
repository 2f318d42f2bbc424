"""Arrival of a forecast's members at places: times as counts of members, in the same words everywhere.

A quantile is the earliest time by which a share of the members has burned a place; "never" counts (see
`statistics.quantiles`). Members count equally.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import input_error
from ...run import times
from ...run.areas import cell_size
from ...run.arrival_grid import ArrivalGrid
from . import ensemble
from .ensemble import Ensemble
from .manifest import KINDS
from .statistics import members_of_share

PERCENT_FROM = 51
"""Number of members from which on shares are given in percent."""
SHARES = 0.1, 0.5, 0.9
"""Shares of the members in tables."""
NEAR = 1000.0
"""Distance (m) up to which a fire counts as near a place that does not burn itself, as in lists of a run.

Cells of buildings or water have no fuel in many models, and never burn."""


@dataclass(frozen=True, eq=False)
class PlaceArrivals:
    """Arrivals of the members that reach the end of a forecast at places (n,).

    Attributes
    ----------
    members
        (m,) indices of these members.
    arrival
        (m, n) s since the issue time; inf: not until the end of the forecast; NaN: not simulated.
    near
        (n,) number of members that burn a cell within `NEAR` of a place that no member burns; else 0.
    """

    ensemble: Ensemble
    members: NDArray[np.int64]
    arrival: NDArray[np.float64]
    near: NDArray[np.int64]

    @property
    def count(self) -> int:
        """Number of these members."""
        return len(self.members)

    @property
    def reached(self) -> NDArray[np.bool_]:
        """Places (n,) that the fire reaches in any member."""
        return np.isfinite(self.arrival).any(axis=0)

    @property
    def simulated(self) -> NDArray[np.bool_]:
        """Places (n,) that any member has simulated."""
        return ~np.isnan(self.arrival).all(axis=0)

    def known(self, place: int) -> NDArray[np.float64]:
        """Return the sorted arrivals of the members that simulated a place."""
        arrival = self.arrival[:, place]
        return np.sort(arrival[~np.isnan(arrival)])

    def by(self, place: int, share: float) -> float:
        """Return the time (s) by which a share of the members has burned a place; inf, NaN as `arrival`."""
        arrival = self.known(place)
        return float(arrival[members_of_share(share, len(arrival)) - 1]) if len(arrival) else float("nan")

    def clock(self, time: float, zone: str) -> str:
        """Format a time since the issue time without its year: ``17 Sep 16:20``."""
        day, month, _, clock, _ = times.text(self.ensemble.issued + timedelta(seconds=time), zone).split(
            " ", 4
        )
        return f"{day} {month} {clock}"

    def end(self, zone: str) -> str:
        """Format the end of the forecast: ``18 Sep 04:42``."""
        return self.clock(self.ensemble.horizon, zone)

    def by_text(self, place: int, share: float, zone: str) -> str:
        """Format the time by which a share of the members has burned a place."""
        time = self.by(place, share)
        if np.isnan(time):
            return "not simulated"
        if np.isinf(time):
            return "later or never"
        return "burned before" if time <= 0.0 else self.clock(time, zone)

    def share_text(self, share: float, count: int = 0) -> str:
        """Name a share of the members, or of `count` of them: ``2 of 20``, or percent of many."""
        count = count or self.count
        if count >= PERCENT_FROM:
            return f"{share:.0%} of members"
        return f"{members_of_share(share, count)} of {count}"

    def sentence(self, place: int, zone: str) -> str:
        """Describe the arrival at a place in one line.

        ``2 of 20 by 17 Sep 14:35, 10 of 20 by 18 Sep 04:05; not in 10 of 20 by 18 Sep 04:42, when the
        forecast ends``
        """
        arrival = self.known(place)
        if not len(arrival):
            return "not simulated"
        never = int(np.isinf(arrival).sum())
        parts = []
        for share in SHARES[:2]:
            time = self.by(place, share)
            if np.isfinite(time):
                when = "burned before" if time <= 0.0 else f"by {self.clock(time, zone)}"
                parts.append(f"{self.share_text(share, len(arrival))} {when}")
        if not parts and never < len(arrival):
            last = self.clock(float(arrival[len(arrival) - never - 1]), zone)
            parts = [f"{len(arrival) - never} of {len(arrival)} by {last}"]
        clauses = [", ".join(parts)] if parts else []
        if never:
            near = f" (within {NEAR / 1000.0:g} km in {self.near[place]})" if self.near[place] else ""
            clauses.append(
                f"not in {never} of {len(arrival)}{near} by {self.end(zone)}, when the forecast ends"
            )
        return "; ".join(clauses)

    def weights_note(self) -> str:
        """Say that members count equally if they have other weights; else empty."""
        weights = self.ensemble.weights[self.members]
        if len(set(weights.tolist())) < 2:
            return ""
        return f"Members count equally; their weights ({weights.min():g} to {weights.max():g}) are not used."


def open_forecast(folder: Path, what: str) -> Ensemble:
    """Open an ensemble for a use that needs the kind forecast, such as ``the page``.

    Raises
    ------
    InputError
        It is damaged, or not a forecast of one fire.
    """
    forecast = ensemble.open(folder)
    if forecast.manifest.kind != "forecast":
        kind = KINDS[forecast.manifest.kind]
        raise input_error(folder, f"holds {kind}; {what} needs the kind forecast")
    return forecast


def earliest(forecast: Ensemble, lines: Sequence[NDArray[np.float64]]) -> PlaceArrivals:
    """Sample the earliest arrival of each member on lines, each of points (k, 2), degrees east and north."""
    counted = np.flatnonzero(forecast.counted(forecast.horizon))
    arrival = np.full((len(counted), len(lines)), np.nan)
    for column, line in enumerate(lines):
        if len(line):
            points = sample(forecast, line[:, 1], line[:, 0]).arrival
            arrival[:, column] = np.fmin.reduce(points, axis=1)
    return PlaceArrivals(forecast, counted, arrival, np.zeros(len(lines), np.int64))


def sample(forecast: Ensemble, latitude: ArrayLike, longitude: ArrayLike) -> PlaceArrivals:
    """Sample the members that reach the end of a forecast in the cells of places (n,), degrees."""
    grid = ArrivalGrid(forecast.latitude, forecast.longitude, np.empty(forecast.shape[1:]))
    counted = np.flatnonzero(forecast.counted(forecast.horizon))
    rows, columns = grid.cells_at(np.asarray(latitude, np.float64), np.asarray(longitude, np.float64))
    arrival = forecast.at(np.maximum(rows, 0), np.maximum(columns, 0))[counted].astype(np.float64)
    arrival[:, (rows < 0) | (columns < 0)] = np.nan
    near = np.zeros(len(rows), np.int64)
    for place in np.flatnonzero(np.isinf(arrival).any(axis=0) & ~np.isfinite(arrival).any(axis=0)):
        near[place] = _members_near(forecast, counted, int(rows[place]), int(columns[place]))
    return PlaceArrivals(forecast, counted, arrival, near)


def _members_near(forecast: Ensemble, counted: NDArray[np.int64], row: int, column: int) -> int:
    """Count the members that burn a cell whose centre is within `NEAR` of the centre of a cell."""
    width, height = cell_size(forecast.latitude, forecast.longitude)
    _, ny, nx = forecast.shape
    up, right = int(NEAR / height), int(NEAR / width)
    rows, columns = np.meshgrid(
        np.arange(max(row - up, 0), min(row + up + 1, ny)),
        np.arange(max(column - right, 0), min(column + right + 1, nx)),
        indexing="ij",
    )
    inside = np.hypot((rows - row) * height, (columns - column) * width) <= NEAR
    burned = forecast.at(rows[inside], columns[inside])[counted] <= forecast.horizon
    return int(burned.any(axis=1).sum())
