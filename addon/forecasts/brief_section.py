"""Section of a forecast of many members: when each place may burn, map of outlines, and burned area.

Counts of members replace percentages up to 50 members, and "not by the end" counts as an answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..html_text import quote
from ..run import times
from ..run.areas import cell_size
from ..run.measure import AREA
from . import brief_chart
from . import forecast as forecasts
from .ensemble import choice, describe, groups, place_arrivals, statistics
from .ensemble.ensemble import Ensemble
from .ensemble.place_arrivals import SHARES, PlaceArrivals

_TIMES = 60  # of the chart of burned area
_ROWS = 6  # of the table of burned area, in addition to the issue time


@dataclass(frozen=True)
class Forecast:
    """Statistics of an ensemble for the page.

    Attributes
    ----------
    arrivals
        Arrivals of the counted members, which reach the end of the forecast, at the points.
    names
        (m,) names of the counted members.
    areas
        (m, nt) burned areas, m2, at the times of `moments` (nt,), s.
    typical, outlier
        Indices of the deepest and the least deep member among the counted.
    depth
        (m,) epsilon inclusion depths at the end of the forecast.
    second
        (m,) True for the second of two groups of members with other burned areas; None: one group.
    """

    ensemble: Ensemble
    arrivals: PlaceArrivals
    names: list[str]
    moments: NDArray[np.float64]
    areas: NDArray[np.float64]
    typical: int
    outlier: int
    depth: NDArray[np.float64]
    second: NDArray[np.bool_] | None

    @property
    def count(self) -> int:
        """Number of counted members."""
        return len(self.names)

    @property
    def cell(self) -> tuple[float, float]:
        """Width and height of a cell, m."""
        return cell_size(self.ensemble.latitude, self.ensemble.longitude)

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
    forecast = place_arrivals.open_forecast(folder, "the page")
    arrivals = place_arrivals.sample(forecast, latitude, longitude)
    moments = np.linspace(0.0, forecast.horizon, _TIMES)
    chosen, counted = choice.choose(forecast), arrivals.members
    order = counted.tolist()
    likeness = choice.jaccard(statistics.overlaps(forecast, forecast.horizon))[np.ix_(counted, counted)]
    return Forecast(
        forecast, arrivals, [forecast.members[index].name for index in order], moments,
        statistics.burned_areas(forecast, moments)[counted],
        order.index(chosen.typical), order.index(chosen.outlier), chosen.depth[counted],
        groups.split(1.0 - likeness),
    )  # fmt: skip


def add(briefing: Any, folder: Path) -> Any:
    """Add the section of an ensemble to a briefing (see `brief.briefing.Briefing`)."""
    points = briefing.points
    forecast = gather(folder, [each.latitude for each in points], [each.longitude for each in points])
    told = describe.sentence(forecast.ensemble.manifest)
    shown = forecasts.shown_by(forecast.ensemble, briefing.run)
    sections = (*briefing.sections, section(briefing, forecast, shown))
    return replace(briefing, sections=sections, sentences=(*briefing.sentences, told))


def section(briefing: Any, forecast: Forecast, shown: str) -> str:
    """Build the section; `shown` names the member that the run of the page shows."""
    inner = "\n".join(_section(briefing, forecast, shown))
    return (
        '<section aria-labelledby="forecast-title"><h2 id="forecast-title">How sure the forecast is</h2>\n'
        f"{inner}\n</section>"
    )


def _section(briefing: Any, forecast: Forecast, shown: str) -> Iterator[str]:
    yield from _head(briefing, forecast)
    yield f"<p>{quote(shown)}</p>"
    yield from _outcomes(briefing, forecast)
    yield from _places(briefing, forecast)
    yield from _map(briefing, forecast)
    yield from _growth(briefing, forecast)
    yield (
        "<p class='soft' id='typical-note'>* The typical member is the deepest by epsilon inclusion depth "
        "(Chaves-de-Plaza et al., 2024): many others contain its final burned area, and it contains many "
        "others. The outlier is the least deep one.</p>"
    )


def _head(briefing: Any, forecast: Forecast) -> Iterator[str]:
    """Name issue time, age, members and inputs."""
    told, zone = forecast.ensemble.manifest, briefing.zone
    issued = times.text(forecast.ensemble.issued, zone)
    last = times.text(forecast.ensemble.valid(forecast.ensemble.horizon), zone)
    prepared = briefing.sheet.prepared or datetime.now(UTC)
    age = times.age((prepared - forecast.ensemble.issued).total_seconds())
    yield (
        f'<p class="issued">Issued {quote(issued)}, valid until {quote(last)}<br>'
        f"{age} old when this page was made; {forecast.count} of {forecast.total} members</p>"
    )
    if told.synthetic and not briefing.run.synthetic:
        yield '<p class="warn"><b>These members are synthetic</b>, not the output of a fire model.</p>'
    differ, common = told.perturbed or "not given", told.not_perturbed or "not given"
    yield (
        f"<p>{quote(told.name)}; model: {quote(told.model or 'not given')}. "
        f"Members differ in: {quote(differ)}. Common to all: {quote(common)}. "
        "An error in a common input is in all members.</p>"
    )
    if note := forecast.arrivals.weights_note():
        yield f"<p>{note}</p>"
    for each in forecast.ensemble.left_out:
        yield f"<p class='soft'>Left out: member {quote(each.name)}: {quote(each.reason)}.</p>"


def _outcomes(briefing: Any, forecast: Forecast) -> Iterator[str]:
    """Give the range of burned area, and two outcomes if members are in two groups."""
    unit, end = AREA[briefing.units], forecast.arrivals.end(briefing.zone)
    area = forecast.areas[:, -1]
    low, middle, high = (unit.format(float(np.quantile(area, q))) for q in (0.0, 0.5, 1.0))
    yield (
        f"<p><b>Burned by {quote(end)}:</b> {low} to {high} {unit.name}; half of the members burn less than "
        f"{middle}. Areas are of cells of {max(forecast.cell):.0f} m.</p>"
    )
    if forecast.second is None:
        return
    parts = [area[forecast.second == group] for group in (False, True)]
    parts.sort(key=lambda part: float(np.median(part)))
    words = [
        f"{len(part)} of {forecast.count} members burn {unit.format(part.min())} to "
        f"{unit.format(part.max())} {unit.name}"
        for part in parts
    ]
    yield (
        f'<p class="warn"><b>Two outcomes:</b> {words[0]}, and {words[1]}. Members of a group burn similar '
        "ground. The typical member shows one of the two, and the median may be in neither.</p>"
    )


def _map(briefing: Any, forecast: Forecast) -> Iterator[str]:
    """Draw the outlines of the members, with a table of them."""
    mark = "SYNTHETIC" if forecast.ensemble.manifest.synthetic else ""
    typical, outlier = (quote(forecast.names[index]) for index in (forecast.typical, forecast.outlier))
    yield f"<h3>Burned area of each member on {quote(forecast.arrivals.end(briefing.zone))}</h3>"
    yield (
        '<div class="key"><span><i class="line thick"></i>member '
        f'{typical}, the typical one<a href="#typical-note">*</a></span><span><i class="line dashed"></i>'
        f'member {outlier}, the outlier</span><span><i class="line"></i>other members</span>'
        '<span><i class="band both"></i>burned by all of the more typical half of the members</span>'
        '<span><i class="band"></i>by some of them</span>'
        '<span><i class="before"></i>burned before the issue time</span></div>'
    )
    yield brief_chart.outlines(forecast, reached(briefing, forecast), mark, briefing.units)
    yield (
        "<p class='soft'>North is at the top. Ground outside of all outlines may burn later, or in a fire "
        "that differs from all members.</p>"
    )
    unit = AREA[briefing.units]
    rows = [
        (name, unit.format(float(forecast.areas[index, -1])), ", ".join(_roles(forecast, index)))
        for index, name in enumerate(forecast.names)
    ]
    yield _table("Members as a table", ("member", f"burned area at the end, {unit.name}", "role"), rows)


def _roles(forecast: Forecast, index: int) -> list[str]:
    area = forecast.areas[:, -1]
    each = forecast.typical, forecast.outlier, int(area.argmin()), int(area.argmax())
    names = "typical", "outlier", "smallest", "largest"
    return [role for role, member in zip(names, each, strict=True) if member == index]


def _growth(briefing: Any, forecast: Forecast) -> Iterator[str]:
    """Draw the burned area by time, with a table."""
    unit = AREA[briefing.units]
    yield "<h3>Burned area by time</h3>"
    yield (
        '<div class="key"><span><i class="line blue"></i>median</span><span><i class="line thick"></i>member '
        f'{quote(forecast.names[forecast.typical])}, the typical one</span><span><i class="band both"></i>'
        'middle half of the members</span><span><i class="band"></i>all members</span></div>'
    )
    yield brief_chart.fan(forecast, briefing.zone, unit)
    picks = np.linspace(0, len(forecast.moments) - 1, _ROWS + 1).round().astype(int)
    rows = [
        (
            forecast.arrivals.clock(float(forecast.moments[at]), briefing.zone),
            *(
                unit.format(float(value))
                for value in np.quantile(forecast.areas[:, at], brief_chart.QUARTERS)
            ),
        )
        for at in picks
    ]
    heads = "time", "smallest", "quarter", "median", "three quarters", "largest"
    yield _table(f"Burned area as a table, {unit.name}", heads, rows)


def _table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Build a folded table: the text alternative of a drawing."""
    top = "".join(f'<th scope="col">{quote(head)}</th>' for head in heads)
    body = "".join(f"<tr>{''.join(f'<td>{quote(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return (
        f'<details class="as-table"><summary>{quote(title)}</summary><div class="wide"><table>'
        f"<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div></details>"
    )


def reached(briefing: Any, forecast: Forecast) -> list[Any]:
    """List the points that the fire reaches in any member."""
    return [point for point, here in zip(briefing.points, forecast.arrivals.reached, strict=True) if here]


def _places(briefing: Any, forecast: Forecast) -> Iterator[str]:
    """Build a table of places that any member burns, and name the others."""
    arrivals, zone = forecast.arrivals, briefing.zone
    end = quote(arrivals.end(zone))
    rows, near, never = [], [], []
    for index, point in enumerate(briefing.points):
        if arrivals.reached[index]:
            rows.append(_row(point, index, arrivals, zone))
        elif count := int(arrivals.near[index]):
            near.append(f"{quote(point.name)} (in {count} of {arrivals.count})")
        elif arrivals.simulated[index]:
            never.append(quote(point.name))
    if rows:
        heads = [arrivals.share_text(share) for share in SHARES]
        titles = "".join(f'<th scope="col">{quote(head)}<br>burn it by</th>' for head in heads)
        span = f"{quote(arrivals.clock(0.0, zone))} to {end}"
        yield (
            '<div class="wide"><table class="arrivals"><thead><tr><th scope="col" class="text">place</th>'
            f'{titles}<th scope="col">do not reach it by<br>{end}, when the<br>forecast ends</th>'
            f'<th scope="col" class="text">each '
            f"member,<br>{span}</th></tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
        )
    if near:
        distance, listed = f"{place_arrivals.NEAR / 1000.0:g} km", ", ".join(near)
        yield f"<p>No member burns these places, but fire comes within {distance} by {end}: {listed}.</p>"
    if never:
        yield (
            f"<p>No member reaches these places by {end}, when the forecast ends: {', '.join(never)}. They "
            "may burn later.</p>"
        )


def _row(point: Any, index: int, arrivals: PlaceArrivals, zone: str) -> str:
    arrival = arrivals.known(index)
    cells = "".join(f"<td>{quote(arrivals.by_text(index, share, zone))}</td>" for share in SHARES)
    never = int(np.isinf(arrival).sum())
    missing = f", {arrivals.count - len(arrival)} not simulated" if len(arrival) < arrivals.count else ""
    dots = brief_chart.dots(arrival, arrivals, point.name, zone)
    return (
        f'<tr><td class="text">{quote(point.name)}</td>{cells}'
        f"<td>{never} of {len(arrival)}{missing}</td>"
        f'<td class="text">{dots}{_two(arrival, arrivals, zone)}</td></tr>\n'
    )


def _two(arrival: NDArray[np.float64], arrivals: PlaceArrivals, zone: str) -> str:
    """Name two groups of arrival times, as their median may be in neither."""
    times = arrival[np.isfinite(arrival)]
    second = groups.split_values(times)
    if second is None:
        return ""
    parts = [times[~second], times[second]]
    words = [
        f"{len(part)} from {arrivals.clock(float(part[0]), zone)} to {arrivals.clock(float(part[-1]), zone)}"
        for part in parts
    ]
    return f"<small>two outcomes: {quote(words[0])}; {quote(words[1])}</small>"
