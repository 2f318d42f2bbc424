"""Drawings of a forecast as SVG in the colours of the page: dots of members, outlines, and burned area."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from datetime import timedelta
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..html_text import quote
from ..run import area_chart, areas, fronts, measure
from ..run.measure import Measure, Units, area
from .ensemble import places
from .ensemble.ensemble import Ensemble
from .ensemble.place_arrivals import PlaceArrivals

if TYPE_CHECKING:
    from .brief_section import Forecast

_DOTS = 276, 26  # width and height
_NEVER = 76  # width for the number of members that do not arrive
_MAP = 900.0  # width
QUARTERS = 0.0, 0.25, 0.5, 0.75, 1.0
"""Shares of the members below the lines of the chart of burned area."""


def dots(arrival: NDArray[np.float64], arrivals: PlaceArrivals, name: str, zone: str) -> str:
    """Draw a dot for each member (m,) at its arrival time (s), and the number of those that do not arrive."""
    width, height = _DOTS
    span, horizon = width - _NEVER, arrivals.ensemble.horizon
    shapes = [f'<line class="tick" x1="0" x2="{span}" y1="{height - 3}" y2="{height - 3}"/>']
    shapes += [
        f'<line class="tick" x1="{x}" x2="{x}" y1="{height - 7}" y2="{height - 3}"/>'
        for x in (0.5, span - 0.5)
    ]
    levels: dict[int, int] = {}
    when = np.sort(arrival[np.isfinite(arrival)])
    for time in when:
        x = 4 + (span - 8) * min(max(float(time) / horizon, 0.0), 1.0)
        level = levels[int(x // 7)] = levels.get(int(x // 7), -1) + 1
        y = max(height - 8 - 5 * level, 4)
        shapes.append(f'<circle class="member" cx="{x:.1f}" cy="{y}" r="3"/>')
    if never := len(arrival) - len(when):
        shapes.append(
            f'<text x="{width}" y="{height - 6}" text-anchor="end" class="end">{never} not yet</text>'
        )
    listed = ", ".join(arrivals.clock(float(time), zone) for time in when)
    label = f"{name}: {len(when)} of {len(arrival)} members arrive, on {listed}"
    return _svg(width, height, label, shapes, "dots")


def outlines(forecast: Forecast, points: Sequence[Any], mark: str, usual: Units) -> str:
    """Draw the members' burned areas at the end of the forecast, points with their names, and a mark."""
    whole = forecast.ensemble
    counted = np.flatnonzero(whole.counted(whole.horizon))
    burned = np.stack([whole.arrival(int(index)) <= whole.horizon for index in counted])
    order = np.argsort(-forecast.depth, kind="stable")
    half = burned[order[: (len(order) + 1) // 2]]
    place = _Place(whole, burned.any(0))
    shapes = [
        f'<path class="band" fill-rule="evenodd" d="{place.path(part)}"/>'
        for part in (half.any(0), half.all(0))
    ]
    shapes += [
        f'<path class="other" d="{place.path(each)}"/>'
        for index, each in enumerate(burned)
        if index not in (forecast.typical, forecast.outlier)
    ]
    shapes.append(f'<path class="outlier" d="{place.path(burned[forecast.outlier])}"/>')
    shapes.append(f'<path class="typical" d="{place.path(burned[forecast.typical])}"/>')
    before = whole.arrival(int(counted[forecast.typical])) <= 0.0
    if before.any():
        shapes.append(f'<path class="before" fill-rule="evenodd" d="{place.path(before)}"/>')
    shapes += place.scale()
    shapes += [text for point in points for text in place.spot(point)]
    if mark:
        middle = f'x="{_MAP / 2:g}" y="{place.height - 20:.0f}" text-anchor="middle"'
        shapes.append(f'<text class="mark" {middle}>{quote(mark)}</text>')
    areas = [float(whole.areas[part].sum()) for part in (burned.all(0), burned.any(0))]
    both, some = (area(each, usual) for each in areas)
    label = (
        f"Outlines of {forecast.count} members at the end of the forecast, north at the top. All of them "
        f"burn {both}, and at least one of them {some}. The table below lists the members."
    )
    return f"<figure>{_svg(round(_MAP), round(place.height), label, shapes, 'curve outlines')}</figure>"


class _Place:
    """Map of the grid around the burned cells: equirectangular, north at the top."""

    def __init__(self, ensemble: Ensemble, burned: NDArray[np.bool_]) -> None:
        self.ensemble = ensemble
        latitude, longitude = ensemble.latitude, ensemble.longitude
        rows, columns = (np.flatnonzero(burned.any(axis)) for axis in (1, 0))
        north, east = areas.metres_per_degree(float(latitude.mean()))
        y = latitude[[rows[0], rows[-1]]]
        x = longitude[[columns[0], columns[-1]]]
        margin = 0.05 * max(float(np.ptp(y)) * north, float(np.ptp(x)) * east, 1000.0)
        self.top, self.left = float(y.max()) + margin / north, float(x.min()) - margin / east
        wide = float(np.ptp(x)) * east + 2 * margin
        tall = float(np.ptp(y)) * north + 2 * margin
        self.scale_to = min(_MAP / wide, 620.0 / tall)
        self.left -= 0.5 * (_MAP / self.scale_to - wide) / east
        self.height = tall * self.scale_to
        self.north, self.east = north * self.scale_to, east * self.scale_to

    def path(self, burned: NDArray[np.bool_]) -> str:
        """Return the outline of burned cells (ny, nx) as path data of closed rings."""
        fire = places.reach(self.ensemble, np.where(burned, 0.0, np.nan))
        data = ""
        for line in fronts.trace(fire, 0.5):
            x, y = (line[:-1, 0] - self.left) * self.east, (self.top - line[:-1, 1]) * self.north
            points = _thinned(zip(np.round(x, 1).tolist(), np.round(y, 1).tolist(), strict=True))
            if len(points) > 2:
                data += "M" + "L".join(f"{px:g} {py:g}" for px, py in points) + "Z"
        return data

    def spot(self, point: Any) -> Iterator[str]:
        """Draw a point with its name."""
        x, y = (point.longitude - self.left) * self.east, (self.top - point.latitude) * self.north
        yield f'<circle class="reported" r="5" cx="{x:.1f}" cy="{y:.1f}"/>'
        yield f'<text class="spot" x="{x + 9:.1f}" y="{y + 5:.1f}">{quote(point.name)}</text>'

    def scale(self) -> Iterator[str]:
        """Draw a scale bar of a round length."""
        length = measure.round_length(250.0 / self.scale_to)
        end, y = 10 + length * self.scale_to, self.height - 12
        yield f'<line class="tick" x1="10" x2="{end:.1f}" y1="{y:.1f}" y2="{y:.1f}"/>'
        yield f'<text x="10" y="{y - 6:.1f}">{length / 1000:g} km ({length / measure.MILE:.1f} mi)</text>'


def _thinned(points: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Leave out points of a line that are within a pixel of the last kept one."""
    kept: list[tuple[float, float]] = []
    for x, y in points:
        if not kept or abs(x - kept[-1][0]) + abs(y - kept[-1][1]) >= 1.5:
            kept.append((x, y))
    return kept


def fan(forecast: Forecast, zone: str, unit: Measure) -> str:
    """Draw the burned area by time: all members, the middle half, the median, and the typical member."""
    issued = forecast.ensemble.issued
    when = [issued + timedelta(seconds=float(moment)) for moment in forecast.moments]
    place = area_chart.Axes(when[0], when[-1], max(float(forecast.areas.max()) * 1.06, 1.0))
    low, quarter, middle, upper, high = np.quantile(forecast.areas, QUARTERS, axis=0)

    def trace(values: NDArray[np.float64]) -> list[str]:
        return [f"{place.x(at)},{place.y(float(value))}" for at, value in zip(when, values, strict=True)]

    def line(values: NDArray[np.float64]) -> str:
        return " ".join(trace(values))

    def between(bottom: NDArray[np.float64], top: NDArray[np.float64]) -> str:
        return " ".join([*trace(top), *reversed(trace(bottom))])

    shapes = [
        *area_chart.scale(place, unit, area_chart.LEFT - 8, "end", True),
        *area_chart.dates(place, zone),
        f'<polygon class="band" points="{between(low, high)}"/>',
        f'<polygon class="band" points="{between(quarter, upper)}"/>',
        f'<polyline class="median" points="{line(middle)}"/>',
        f'<polyline class="typical" points="{line(forecast.areas[forecast.typical])}"/>',
    ]
    label = (
        "Burned area of the members by time. At the end, the smallest, the median and the largest have "
        f"{', '.join(unit.format(float(each[-1])) for each in (low, middle, high))} {unit.name}. "
        "The table below has more times."
    )
    return f"<figure>{_svg(area_chart.WIDTH, area_chart.HEIGHT, label, shapes, 'curve')}</figure>"


def _svg(width: int, height: int, label: str, shapes: list[str], kind: str) -> str:
    return (
        f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="{quote(label)}" class="{kind}">'
        + "".join(shapes)
        + "</svg>"
    )
