"""Columns, data and notes on the arrival of a forecast's members at stations, in the words of the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import numpy as np
from firetwin_core.run import Run

from ..run import times, zone
from ..stations.records import Station
from . import forecast
from .ensemble import place_arrivals
from .ensemble.ensemble import Ensemble
from .ensemble.place_arrivals import SHARES, PlaceArrivals

_SHOWN = SHARES[:2]


@dataclass(frozen=True)
class MemberArrivals:
    """Arrivals of the members of a forecast at stations (n,), with times of a zone.

    `shown` names the member that the run of the list shows; "" without a run.
    """

    arrivals: PlaceArrivals
    zone: str
    shown: str = ""
    name: str = "forecast"
    late: str = "forecast: a tenth of the members do not reach it after that time"

    @classmethod
    def at(cls, ensemble: Ensemble, stations: Sequence[Station], run: Run | None) -> MemberArrivals:
        """Sample the members at stations, with the time zone of the run, if there is one.

        Raises
        ------
        InputError
            The run is not a member.
        """
        shown = "" if run is None else forecast.shown_by(ensemble, run)
        where = zone.of_longitude(float(ensemble.longitude.mean())) if run is None else zone.time_zone(run)
        latitude, longitude = (
            [getattr(each, axis) for each in stations] for axis in ("latitude", "longitude")
        )
        return cls(place_arrivals.sample(ensemble, latitude, longitude), where, shown)

    def heads(self) -> list[str]:
        """Return the titles of the columns."""
        titles = [f"{self.arrivals.share_text(share)} burn it by" for share in _SHOWN]
        return [*titles, f"do not reach it by {self.arrivals.end(self.zone)}"]

    def cells(self, station: int) -> list[str]:
        """Return the cells of a station."""
        arrivals, arrival_times = self.arrivals, self.arrivals.known(station)
        if not len(arrival_times):
            return ["not simulated"] * 3
        never = int(np.isinf(arrival_times).sum())
        near = int(arrivals.near[station])
        close = f", within {place_arrivals.NEAR / 1000.0:g} km in {near}" if near else ""
        times = (arrivals.by_text(station, share, self.zone) for share in _SHOWN)
        return [*times, f"{never} of {len(arrival_times)}{close}"]

    def as_json(self, station: int) -> dict[str, Any]:
        """Return the quantiles of a station as JSON data; times in UTC, null: later or never."""
        arrivals, arrival = self.arrivals, self.arrivals.known(station)
        quantiles = [(share, arrivals.by(station, share)) for share in SHARES]
        return {
            "text": arrivals.sentence(station, self.zone),
            "members": len(arrival),
            "not_reached": int(np.isinf(arrival).sum()),
            "near": int(arrivals.near[station]),
            "burned_by": [
                {
                    "share": share,
                    "time": times.iso(arrivals.ensemble.valid(time)) if np.isfinite(time) else None,
                }
                for share, time in quantiles
            ],
        }

    def select(self, order: list[int]) -> MemberArrivals:
        """Return the arrivals at these stations."""
        found = self.arrivals
        chosen = replace(found, arrival=found.arrival[:, order], near=found.near[order])
        return replace(self, arrivals=chosen)

    def ahead(self, after: datetime | None) -> list[int]:
        """List stations that a tenth of the members reach after a time (the issue time), earliest first."""
        issued = self.arrivals.ensemble.issued
        then = 0.0 if after is None else max((after - issued).total_seconds(), 0.0)
        first = np.array([self.arrivals.by(k, SHARES[0]) for k in range(self.arrivals.arrival.shape[1])])
        keep = np.flatnonzero(np.isfinite(first) & (first > then))
        order: list[int] = keep[np.argsort(first[keep], kind="stable")].tolist()
        return order

    def notes(self) -> list[str]:
        """Describe the forecast, and say that "later or never" is not safe."""
        ensemble = self.arrivals.ensemble
        total = len(ensemble.members) + len(ensemble.left_out)
        issued, end = (times.text(ensemble.valid(time), self.zone) for time in (0.0, ensemble.horizon))
        note = self.arrivals.weights_note()
        return [
            f"forecast: {ensemble.manifest.name}, {self.arrivals.count} of {total} members, issued {issued}"
            + (" (synthetic)" if ensemble.manifest.synthetic else ""),
            f'forecast: it ends {end}; "later or never" is not "safe"',
            *(f"forecast: {text}" for text in (self.shown, note) if text),
        ]
