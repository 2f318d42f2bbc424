"""Section of a forecast of many members: when each place may burn, map of outlines, and burned area.

Counts of members replace percentages up to 50 members, and "not within" counts as an answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error
from ..html_text import quote
from ..run import times
from ..run.arrival_grid import ArrivalGrid
from ..run.ensemble import choice, ensemble, statistics
from ..run.ensemble.ensemble import Ensemble
from ..run.ensemble.manifest import KINDS
from . import forecast_chart, units

if TYPE_CHECKING:
    from .briefing import Briefing, Point

PERCENT_FROM = 51  # members from which shares are given in percent
SHARES = 0.1, 0.5, 0.9
_TIMES = 60  # of the chart of burned area


@dataclass(frozen=True)
class Forecast:
    """Statistics of an ensemble for the page.

    Attributes
    ----------
    arrival
        (m, n) s since the issue time of each counted member at each point; inf: not until the end; NaN: not
        simulated.
    names
        (m,) names of the counted members: those that reach the end of the forecast.
    areas
        (m, nt) burned areas, m2, at the times of `moments` (nt,), s.
    typical, outlier
        Indices of the deepest and the least deep member among the counted.
    depth
        (m,) epsilon inclusion depths at the end of the forecast.
    """

    ensemble: Ensemble
    arrival: NDArray[np.float64]
    names: list[str]
    moments: NDArray[np.float64]
    areas: NDArray[np.float64]
    typical: int
    outlier: int
    depth: NDArray[np.float64]

    @property
    def count(self) -> int:
        """Number of counted members."""
        return len(self.names)

    @property
    def total(self) -> int:
        """Number of all members, with those left out."""
        return len(self.ensemble.members) + len(self.ensemble.left_out)


def gather(folder: Path, latitude: Sequence[float], longitude: Sequence[float]) -> Forecast:
    """Read an ensemble, and sample it at points (degrees).

    Raises
    ------
    InputError
        It is damaged, or not a forecast of one fire.
    """
    found = ensemble.open(folder)
    if found.manifest.kind != "forecast":
        kind = KINDS[found.manifest.kind]
        raise input_error(folder, f"holds {kind}; the page needs the kind forecast")
    grid = ArrivalGrid(found.latitude, found.longitude, np.empty(found.shape[1:]))
    counted = np.flatnonzero(found.counted(found.horizon))
    rows, columns = grid.cells_at(np.asarray(latitude, np.float64), np.asarray(longitude, np.float64))
    arrival = found.at(np.maximum(rows, 0), np.maximum(columns, 0))[counted].astype(np.float64)
    arrival[:, (rows < 0) | (columns < 0)] = np.nan
    moments = np.linspace(0.0, found.horizon, _TIMES)
    chosen = choice.choose(found)
    order = counted.tolist()
    return Forecast(
        found, arrival, [found.members[index].name for index in order], moments,
        statistics.burned_areas(found, moments)[counted],
        order.index(chosen.typical), order.index(chosen.outlier), chosen.depth[counted],
    )  # fmt: skip


def section(briefing: Briefing) -> str:
    """Build the section; empty without an ensemble."""
    if briefing.forecast is None:
        return ""
    inner = "\n".join(_section(briefing, briefing.forecast))
    return (
        '<section aria-labelledby="forecast-title"><h2 id="forecast-title">How sure the forecast is</h2>\n'
        f"{inner}\n</section>"
    )


def _section(briefing: Briefing, found: Forecast) -> Iterator[str]:
    told, zone = found.ensemble.manifest, briefing.zone
    issued = times.text(found.ensemble.issued, zone)
    last = times.text(found.ensemble.valid(found.ensemble.horizon), zone)
    counts = f"{found.count} of {found.total} members"
    yield f'<p class="issued">Issued {quote(issued)}, valid until {quote(last)}, {counts}</p>'
    if told.synthetic and not briefing.run.synthetic:
        yield '<p class="warn"><b>These members are synthetic</b>, not the output of a fire model.</p>'
    differ, common = told.perturbed or "not given", told.not_perturbed or "not given"
    yield (
        f"<p>{quote(told.name)}; model: {quote(told.model or 'not given')}. "
        f"Members differ in: {quote(differ)}. Common to all: {quote(common)}. "
        "An error in a common input is in all members.</p>"
    )
    for each in found.ensemble.left_out:
        yield f"<p class='soft'>Left out: member {quote(each.name)}: {quote(each.reason)}.</p>"
    yield from _places(briefing, found)
    yield forecast_chart.outlines(found, reached(briefing, found), "SYNTHETIC" if told.synthetic else "")
    yield (
        "<p class='soft'>Burned area of each member at the end of the forecast. Thick: member "
        f"{quote(found.names[found.typical])}, the most typical of the {found.count} (deepest by epsilon "
        "inclusion depth). Blue: burned by some of the more typical half of the members; dark blue: by all. "
        "Grey: burned before the issue time. Dashed: "
        f"member {quote(found.names[found.outlier])}, the least typical.</p>"
    )
    unit = units.AREA[briefing.units]
    yield forecast_chart.fan(found, zone, unit)
    low, middle, high = (unit.format(float(np.quantile(found.areas[:, -1], q))) for q in (0.0, 0.5, 1.0))
    yield (
        f"<p class='soft'>Burned area by time. At the end: smallest {low}, median {middle}, largest {high} "
        f"{unit.name}. Shaded: all members, and the middle half. Blue: median. Black: member "
        f"{quote(found.names[found.typical])}.</p>"
    )


def reached(briefing: Briefing, found: Forecast) -> list[Point]:
    """List the points that the fire reaches in any member."""
    some = np.isfinite(found.arrival).any(0)
    return [point for point, here in zip(briefing.points, some, strict=True) if here]


def _places(briefing: Briefing, found: Forecast) -> Iterator[str]:
    """Build a table of places that any member burns, and name the others."""
    hours = f"{found.ensemble.horizon / 3600.0:.3g} h"
    rows, never = [], []
    for index, point in enumerate(briefing.points):
        arrival = found.arrival[:, index]
        if np.isfinite(arrival).any():
            rows.append(_row(point, arrival, found, briefing.zone))
        elif not np.isnan(arrival).all():
            never.append(quote(point.name))
    if rows:
        heads = [_share(share, found.count) for share in SHARES]
        titles = "".join(f'<th scope="col">{quote(head)}<br>burn it by</th>' for head in heads)
        span = [_clock(found, time, briefing.zone) for time in (0.0, found.ensemble.horizon)]
        yield (
            '<div class="wide"><table><thead><tr><th scope="col" class="text">place</th>'
            f'{titles}<th scope="col">not within<br>{hours}</th><th scope="col" class="text">each member,'
            f"<br>{quote(span[0])} to {quote(span[1])}</th></tr></thead><tbody>{''.join(rows)}</tbody>"
            "</table></div>"
        )
    if never:
        yield f"<p>Not within {hours} in any of {found.count} members: {', '.join(never)}.</p>"


def _row(point: Point, arrival: NDArray[np.float64], found: Forecast, zone: str) -> str:
    known = arrival[~np.isnan(arrival)]
    cells = "".join(f"<td>{quote(_by(known, share, found, zone))}</td>" for share in SHARES)
    never = int(np.isinf(known).sum())
    missing = f", {len(arrival) - len(known)} not simulated" if len(known) < len(arrival) else ""
    return (
        f'<tr><td class="text">{quote(point.name)}</td>{cells}'
        f"<td>{never} of {len(known)}{missing}</td>"
        f'<td class="text">{forecast_chart.dots(known, found.ensemble.horizon, point.name)}</td></tr>\n'
    )


def _by(known: NDArray[np.float64], share: float, found: Forecast, zone: str) -> str:
    """Format the time by which a share of the members has burned a place (see `statistics.quantiles`)."""
    ordered = np.sort(known)
    time = ordered[statistics.members_of_share(share, len(ordered)) - 1]
    if np.isinf(time):
        return "not within"
    return "burned before" if time <= 0.0 else _clock(found, float(time), zone)


def _share(share: float, count: int) -> str:
    """Name a share of the members: ``2 of 20``, or percent of many."""
    if count >= PERCENT_FROM:
        return f"{share:.0%} of members"
    return f"{statistics.members_of_share(share, count)} of {count}"


def _clock(found: Forecast, time: float, zone: str) -> str:
    """Format a time since the issue time without its year: ``17 Sep 16:20``."""
    moment = datetime.fromisoformat(found.ensemble.issued.isoformat()) + timedelta(seconds=time)
    day, month, _, clock, _ = times.text(moment, zone).split(" ", 4)
    return f"{day} {month} {clock}"
