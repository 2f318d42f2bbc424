"""Plots of the score report: maps of hits, misses and false alarms, progression map, and growth curve."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any
from zoneinfo import ZoneInfo

import matplotlib
import numpy as np
from firetwin_core.run import Run
from matplotlib.colors import LightSource
from matplotlib.dates import ConciseDateFormatter
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from ...data import history
from .. import areas, info, measure, times
from .grid import ScoreGrid

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from shapely.geometry.base import BaseGeometry

HITS, FALSE_ALARMS, MISSES = "#56606b", "#e8833a", "#2f6fb7"
RUN, REPORTED, SEEN = "#c8401e", "#1f2933", "#2f6fb7"
_KILO = 1e3
_MOMENTS, _MARKED = 200, 40  # points of a growth curve, and up to how many are marked


def overlap(run: Run, grid: ScoreGrid, here: BaseGeometry, there: BaseGeometry, frame: BaseGeometry) -> str:
    """Draw the overlap of one date as a data URI: burned in both, in the run only, in the reference only."""
    figure, axes = _map(run, grid, frame)
    for shape, colour in (
        (here.intersection(there), HITS),
        (here.difference(there), FALSE_ALARMS),
        (there.difference(here), MISSES),
    ):
        _fill(axes, shape, facecolor=colour, edgecolor="none", alpha=0.82)
    _fill(axes, there, facecolor="none", edgecolor="#0d2f57", linewidth=0.9)
    return _png(figure)


def progress(run: Run, grid: ScoreGrid, shapes: Sequence[BaseGeometry], frame: BaseGeometry) -> str:
    """Draw the burned area of the run by date, latest lightest, as a data URI."""
    figure, axes = _map(run, grid, frame)
    for shape, colour in reversed(list(zip(shapes, ways(len(shapes)), strict=True))):
        _fill(axes, shape, facecolor=colour, edgecolor="#3a120a", linewidth=0.4, alpha=0.9)
    return _png(figure)


def ways(count: int) -> list[str]:
    """Choose colours of dates, darkest first."""
    shades = matplotlib.colormaps["YlOrRd_r"](np.linspace(0.1, 0.8, max(count, 1)))
    return [matplotlib.colors.to_hex(shade) for shade in shades]


def growth(run: Run, results: dict[str, Any], other: Run | None = None) -> str:
    """Draw burned area over time of the run, another run, observations and reports, as SVG."""
    zone, acre = ZoneInfo(results["zone"]), history.SQUARE_METRES_PER_ACRE
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 10}):
        figure = Figure(figsize=(10, 4.1))
        axes = figure.add_axes((0.085, 0.12, 0.83, 0.84))
        for each, colour, name in ((run, RUN, run.name), (other, SEEN, other.name if other else "")):
            if each is not None:
                _curve(axes, each, zone, color=colour, label=name)
        marks = (
            (
                "reported",
                REPORTED,
                "o",
                [(r["time"], r["reported"]) for r in results["reported"] if r["run"]],
            ),
            (
                "perimeters",
                SEEN,
                "s",
                [(r["time"], r["all"]["polygons"]["observed_area"]) for r in results["dates"]],
            ),
        )
        for name, colour, mark, points in marks if other is None else marks[:1]:
            if points:
                when = np.array([datetime.fromisoformat(time).astimezone(zone) for time, _ in points], object)
                area = [each / acre for _, each in points]
                axes.plot(when, area, mark, color=colour, markersize=7, markeredgecolor="white", label=name)
        axes.set_ylabel("burned area, acres")
        axes.set_ylim(bottom=0)
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        right = axes.secondary_yaxis(
            "right", functions=(lambda a: np.asarray(a) * acre / 1e4, lambda h: np.asarray(h) * 1e4 / acre)
        )
        right.set_ylabel("ha")
        right.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        axes.xaxis.set_major_formatter(ConciseDateFormatter(axes.xaxis.get_major_locator(), tz=zone))
        axes.grid(axis="y", color="#d8dde3", linewidth=0.7)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(loc="upper left", frameon=False)
        text = io.StringIO()
        figure.savefig(text, format="svg", transparent=True, metadata={"Date": None})
    svg = text.getvalue()
    return svg[svg.index("<svg") :]


def own_times(run: Run) -> NDArray[np.float64]:
    """Choose model times (s) of a growth curve: the run's own, or an even subset of many."""
    count = len(run.times)
    return run.times[np.unique(np.linspace(0, count - 1, min(count, _MOMENTS)).round().astype(np.int64))]


def _curve(axes: Axes, run: Run, zone: ZoneInfo, **style: Any) -> None:
    """Draw acres at the run's times, linear between them; marks are drawn for few times only."""
    moments = own_times(run)
    when = np.array([times.utc(run, float(moment)).astimezone(zone) for moment in moments], object)
    area = np.array(info.burned(run, moments), np.float64) / history.SQUARE_METRES_PER_ACRE
    axes.plot(when, area, linewidth=2, marker="o" if len(moments) <= _MARKED else "", markersize=4, **style)


def _map(run: Run, grid: ScoreGrid, frame: BaseGeometry) -> tuple[Figure, Axes]:
    """Draw hill shading of a shape's extent, in km east and north, with a scale bar."""
    west, south, east, north = (bound / _KILO for bound in frame.bounds)
    margin = 0.06 * max(east - west, north - south)
    west, south, east, north = west - margin, south - 2 * margin, east + margin, north + margin
    wide = 4.2
    figure = Figure(figsize=(wide, float(np.clip(wide * (north - south) / (east - west), 2.0, 7.0))), dpi=170)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(west, east), ylim=(south, north), aspect="equal", facecolor="#eef0ee")
    axes.set_axis_off()
    _relief(axes, run, grid)
    _bar(axes, east - west)
    return figure, axes


def _relief(axes: Axes, run: Run, grid: ScoreGrid) -> None:
    height = np.nan_to_num(run.elevation.astype(np.float64))
    if min(height.shape) < 3:
        return
    turn = slice(None, None, 1 if run.latitude[0] < run.latitude[-1] else -1)
    over = slice(None, None, 1 if run.longitude[0] < run.longitude[-1] else -1)
    dx, dy = areas.spacing(run.latitude, run.longitude)
    shade = LightSource(315, 45).hillshade(height[turn, over], vert_exag=2.0, dx=dx, dy=dy)
    west, south, east, north = (bound / _KILO for bound in grid.box.bounds)
    axes.imshow(
        0.62 + 0.38 * shade,
        extent=(west, east, south, north),
        origin="lower",
        cmap="gray",
        vmin=0,
        vmax=1,
        interpolation="bicubic",
        zorder=0,
    )


def _bar(axes: Axes, wide: float) -> None:
    length = measure.round_length(wide / 4)
    (west, _), (south, north) = axes.get_xlim(), axes.get_ylim()
    x, y = west + 0.05 * wide, south + 0.05 * (north - south)
    axes.plot([x, x + length], [y, y], color="white", linewidth=5, solid_capstyle="butt", zorder=8)
    axes.plot([x, x + length], [y, y], color="#1f2933", linewidth=2.2, solid_capstyle="butt", zorder=9)
    box = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 1.5}
    axes.text(x + length / 2, y + 0.025 * wide, f"{length:g} km", ha="center", size=8, bbox=box, zorder=9)


def _fill(axes: Axes, shape: BaseGeometry, **style: Any) -> None:
    import shapely

    for part in shapely.get_parts(shape):
        if part.geom_type == "Polygon" and not part.is_empty:
            rings = [part.exterior, *part.interiors]
            paths = [Path(shapely.get_coordinates(ring) / _KILO, closed=True) for ring in rings]
            axes.add_patch(PathPatch(Path.make_compound_path(*paths), zorder=3, **style))


def _png(figure: Figure) -> str:
    data = io.BytesIO()
    figure.savefig(data, format="png", metadata={"Software": "Firetwin"})
    return "data:image/png;base64," + base64.b64encode(data.getvalue()).decode()
