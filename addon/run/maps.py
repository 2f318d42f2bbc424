"""Maps of a run: fuel load, and maximum heat flux over hill shading."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.colors import LightSource, LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Polygon, Rectangle
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, LogLocator
from numpy.typing import NDArray

from .. import output
from ..data import history
from ..geometry.polygons import area
from . import areas, burned_fraction, measure, thumbnails, times
from .observations import Observations
from .observations.infrared_detections import KINDS

if TYPE_CHECKING:
    from firetwin_core.run import Run
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh

    from .observations import Heat
    from .observations import Polygon as Polygons

FUEL = LinearSegmentedColormap.from_list("fuel", thumbnails.FUEL)
INTENSITY = LinearSegmentedColormap.from_list("intensity", thumbnails.INTENSITY)
SMOKE = LinearSegmentedColormap.from_list("smoke", ["#f7f3ea", "#c9b79c", "#8a6f57", "#4a3728"])
SEEN = LinearSegmentedColormap.from_list("seen", ["#d4e6f7", "#5aa2dd", "#0b3d75"])
HEAT = {"intense": "#c2006e", "scattered": "#6a3fc4", "isolated": "#00625f", "possible": "#5f7a7a"}
NOTHING = Observations()
DPI = 160


def draw(run: Run, out: Path, zone: str, seen: Observations = NOTHING, overwrite: bool = False) -> list[Path]:
    """Write ``fuel.png`` and ``intensity.png``, with the observations of the fire, into the folder `out`.

    Returns
    -------
    list of Path
        Both files.
    """
    paths = [out / "fuel.png", out / "intensity.png"]
    for path in paths:
        output.check(path, overwrite)
    save(fuel_map(run), paths[0], overwrite)
    save(intensity_map(run, zone, seen), paths[1], overwrite)
    return paths


def fuel_map(run: Run) -> Figure:
    """Draw the fuel load: surface and canopy fuel (kg/m2), greener if denser, sand-coloured without fuel."""
    fuel = np.nan_to_num(run.surface_fuel) + np.nan_to_num(run.canopy_fuel)
    figure, axes = _page(run, "Fuel load", "surface and canopy fuel")
    image = _show(axes, run.fuel_latitude, run.fuel_longitude, fuel, FUEL, Normalize(0, fuel.max() or 1))
    _relief(axes, run, 0.18)
    _colour_bar(figure, axes, image, "fuel, kg/m$^2$")
    _places(axes, run)
    return figure


def intensity_map(run: Run, zone: str, seen: Observations = NOTHING) -> Figure:
    """Draw the maximum heat flux (kW/m2) of model cells over hill shading, with observations."""
    flux = np.ma.masked_less(thumbnails.strongest(run), thumbnails.FIRE) / 1e3
    first, last = (times.text(times.utc(run, float(run.times[i])), zone) for i in (0, -1))
    figure, axes = _page(run, "Fire intensity", f"strongest heat flux, {first} to {last}")
    _relief(axes, run, 1.0)
    high = float(flux.max()) if flux.count() else 1.0
    norm = LogNorm(high / 300, high, clip=True)
    image = _show(axes, run.latitude, run.longitude, flux, INTENSITY, norm)
    _colour_bar(figure, axes, image, "heat flux, kW/m$^2$ (logarithmic)", "min")
    _burned_before(axes, run)
    _seen(axes, run, zone, seen)
    _places(axes, run)
    return figure


def smoke_map(run: Run, column: NDArray[np.float64], subtitle: str) -> Figure:
    """Draw the column mass of smoke (mg/m2) in model cells over hill shading."""
    figure, axes = _page(run, "Smoke above the ground", subtitle)
    high = float(column.max()) or 1.0
    image = _show(axes, run.latitude, run.longitude, column.astype(np.float32), SMOKE, Normalize(0, high))
    _relief(axes, run, 0.18)
    _colour_bar(figure, axes, image, "smoke, mg/m$^2$")
    _places(axes, run)
    return figure


def _seen(axes: Axes, run: Run, zone: str, seen: Observations) -> None:
    """Outline observed perimeters, each date in its own blue, and infrared heat by class."""
    if not seen.perimeters and not seen.heat:
        return
    before, bounds = axes.get_legend(), (axes.get_xlim(), axes.get_ylim())
    lines: list[Artist] = []
    for i, perimeter in enumerate(seen.perimeters):
        style = {"edgecolor": SEEN((i + 1) / len(seen.perimeters)), "linewidth": 1.1, "zorder": 4}
        lines.append(_outline(axes, run, perimeter.polygons, style))
        lines[-1].set_label(times.text(perimeter.time, zone))
    for kind in KINDS:
        if heat := [perimeter for perimeter in seen.heat if perimeter.kind == kind]:
            lines.append(_heat(axes, run, kind, heat))
    axes.set(xlim=bounds[0], ylim=bounds[1])
    box = {"framealpha": 0.78, "edgecolor": "none", "fontsize": 8, "title_fontsize": 8}
    axes.legend(handles=lines, title="seen burned by" if seen.perimeters else "seen", loc="upper left", **box)
    if before:
        axes.add_artist(before)


def _outline(axes: Axes, run: Run, polygons: Sequence[Polygons], style: dict) -> PathPatch:
    """Draw rings of polygons as lines of one patch, with holes left open."""
    middle = float(run.longitude[0] + run.longitude[-1]) / 2
    paths = []
    for polygon in polygons:
        for place, (x, y) in enumerate(ring.T for ring in polygon):
            corners = np.column_stack([areas.turned(x, middle), y])
            left = area(corners) > 0.0  # turns; holes have to the other way
            corners = corners if left == (place == 0) else corners[::-1]
            paths.append(Outline([*corners, corners[0]], closed=True))
    patch = PathPatch(Outline.make_compound_path(*paths), facecolor="none", **style)
    axes.add_patch(patch)
    return patch


def _heat(axes: Axes, run: Run, kind: str, heat: Sequence[Heat]) -> Artist:
    """Draw one class of infrared heat of all flights: hatched like the map symbols of the NWCG, or dots."""
    polygons = [polygon for mapped in heat for polygon in mapped.polygons]
    if polygons:
        hatch = {"intense": "////", "scattered": "...."}.get(kind)
        style = {"edgecolor": HEAT[kind], "linewidth": 0.7, "hatch": hatch, "zorder": 4}
        drawn: Artist = _outline(axes, run, polygons, style)
    points = np.concatenate([mapped.points for mapped in heat])
    if len(points):
        middle = float(run.longitude[0] + run.longitude[-1]) / 2
        x, y = areas.turned(points[:, 0], middle), points[:, 1]
        colour = HEAT[kind]
        (drawn,) = axes.plot(x, y, color=colour, marker="o", markersize=2.6, linestyle="none", zorder=5)
    drawn.set_label(f"{kind} heat")
    return drawn


def _burned_before(axes: Axes, run: Run) -> None:
    """Hatch the area that burned before the run began, which released no heat in it."""
    if run.has(burned_fraction.FIELD):
        before = burned_fraction.at(run, run.times[0])
    else:
        with np.errstate(invalid="ignore"):
            before = (run.fuel_arrival_time() < run.times[0]).astype(np.float32)
    if min(before.shape) < 2 or before.min() == before.max():
        return
    axes.contourf(
        run.fuel_longitude,
        run.fuel_latitude,
        before,
        levels=[0.5, 1.5],
        colors=["#4a4541"],
        alpha=0.55,
        zorder=3,
    )
    hatched = Rectangle((0, 0), 1, 1, facecolor="#4a4541", alpha=0.55, label="burned before this run")
    axes.legend(handles=[hatched], loc="lower right", framealpha=0.78, edgecolor="none", fontsize=8)


def _places(axes: Axes, run: Run) -> None:
    """Label towns, summits and lakes of the fire that the run depicts, where positions are published."""
    if run.event not in history.events():
        return
    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    margin = 0.02 * (east - west)
    marks = {"town": "s", "summit": "^", "lake": "o"}
    for place in history.load(run.event).places:
        inside = west + margin < place.longitude < east - 6 * margin
        inside = inside and south + margin < place.latitude < north - margin
        corner = place.longitude < west + 0.3 * (east - west) and place.latitude < south + 0.1 * (
            north - south
        )
        if place.kind not in marks or place.approximate or corner or not inside:  # the scale bar is there
            continue
        style: dict[str, Any] = {"color": "#2166ac" if place.kind == "lake" else "black", "zorder": 8}
        axes.plot(place.longitude, place.latitude, marks[place.kind], markersize=3.2, **style)
        text = axes.annotate(
            place.name,
            (place.longitude, place.latitude),
            xytext=(4, 2),
            textcoords="offset points",
            size=7,
            **style,
        )
        text.set_path_effects([withStroke(linewidth=2, foreground="white", alpha=0.85)])


def _page(run: Run, title: str, subtitle: str) -> tuple[Figure, Axes]:
    """Create a figure with true proportions at the centre of the run."""
    matplotlib.rcParams.update({"font.size": 9, "axes.linewidth": 0.8, "svg.hashsalt": "firetwin"})
    dx, dy = areas.spacing(run.latitude, run.longitude)
    width, height = dx * len(run.longitude), dy * len(run.latitude)
    wide = 7.2
    high = wide * height / width if width > 0 and height > 0 else wide
    figure = Figure(figsize=(wide + 1.6, float(np.clip(high, 2.5, 14)) + 1.3), dpi=DPI)
    axes = figure.add_axes((0.09, 0.075, 0.76, 0.80))
    name = run.name + (" (synthetic)" if run.synthetic and "synthetic" not in run.name.lower() else "")
    figure.text(0.09, 0.945, title, size=17, weight="bold", va="bottom")
    figure.text(0.09, 0.915, f"{name}: {subtitle}", size=9.5, va="center", color="#444444")
    west, east = areas.edges(run.longitude)[[0, -1]]
    south, north = areas.edges(run.latitude)[[0, -1]]
    axes.set_xlim((min(west, east), max(west, east)) if west != east else (west - 0.01, east + 0.01))
    axes.set_ylim((min(south, north), max(south, north)) if south != north else (south - 0.01, north + 0.01))
    axes.set_aspect(1 / np.cos(np.radians(np.mean(axes.get_ylim()))), adjustable="box", anchor="SW")
    axes.locator_params(nbins=6)
    for axis, (negative, positive) in ((axes.xaxis, "WE"), (axes.yaxis, "SN")):
        axis.set_major_formatter(_degrees(axis.get_majorticklocs(), negative, positive))
    axes.tick_params(direction="out", length=3, color="#444444")
    axes.grid(color="black", alpha=0.14, linewidth=0.5, linestyle=(0, (4, 3)), zorder=5)
    if width > 0:  # a single cell has no width
        _scale_bar(axes, width)
    _north_arrow(axes)
    return figure, axes


def _degrees(ticks: NDArray[np.float64], negative: str, positive: str) -> FuncFormatter:
    """Format tick labels such as ``120.6°W`` with the digits needed to distinguish them."""
    step = float(np.min(np.diff(ticks))) if len(ticks) > 1 else 0.1
    digits = max(1, int(np.ceil(-np.log10(step) - 1e-9)))
    digits += round(step * 10**digits, 6) % 1 > 0  # such as steps of 0.25

    def label(at: float, _: object) -> str:
        place = float(areas.turned(at, 0.0))
        return f"{abs(place):.{digits}f}°{negative if place < 0 else positive}"

    return FuncFormatter(label)


def _show(
    axes: Axes,
    latitude: NDArray[np.float64],
    longitude: NDArray[np.float64],
    values: NDArray[np.float32],
    colours: LinearSegmentedColormap,
    norm: Normalize,
) -> QuadMesh:
    return axes.pcolormesh(
        _wide(areas.edges(longitude)),
        _wide(areas.edges(latitude)),
        values,
        cmap=colours,
        norm=norm,
        rasterized=True,
        zorder=2,
    )


def _wide(edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give a single cell a visible width."""
    return edges if edges[0] != edges[-1] else edges + np.array([-0.01, 0.01])


def _relief(axes: Axes, run: Run, strength: float) -> None:
    """Draw hill shading, lit from the north-west."""
    elevation = np.nan_to_num(run.elevation.astype(np.float64))
    if min(elevation.shape) < 3:
        return
    dx, dy = areas.spacing(run.latitude, run.longitude)
    if run.latitude[0] < run.latitude[-1]:
        elevation = elevation[::-1]
    if run.longitude[0] > run.longitude[-1]:
        elevation = elevation[:, ::-1]
    shade = LightSource(azdeg=315, altdeg=45).hillshade(elevation, vert_exag=2.0, dx=dx, dy=dy)
    extent = (*axes.get_xlim(), *axes.get_ylim())
    grey = np.zeros((*shade.shape, 4))
    grey[..., 3] = (1 - shade) * (0.65 if strength >= 1 else strength * 2.5)
    if strength >= 1:
        axes.set_facecolor("#ece8df")
    axes.imshow(grey, extent=extent, interpolation="bicubic", zorder=1 if strength >= 1 else 3, aspect="auto")
    axes.set_aspect(1 / np.cos(np.radians(np.mean(axes.get_ylim()))), adjustable="box", anchor="SW")


def _colour_bar(figure: Figure, axes: Axes, image: QuadMesh, label: str, extend: str = "neither") -> None:
    axes.apply_aspect()
    box = axes.get_position()
    bar = figure.colorbar(
        image, cax=figure.add_axes((box.x1 + 0.02, box.y0, 0.022, box.height * 0.62)), extend=extend
    )
    bar.set_label(label)
    if isinstance(image.norm, LogNorm):
        bar.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        bar.ax.minorticks_off()
    bar.outline.set_linewidth(0.6)


def _scale_bar(axes: Axes, width: float) -> None:
    """Draw a scale bar of a round length in km, about a fifth of the map, in the lower left corner."""
    length = measure.round_length(width / 1e3 / 5)
    share = length * 1e3 / width
    x, y, thick = 0.035, 0.035, 0.011
    axes.add_patch(
        Rectangle((x - 0.015, y - 0.018), share + 0.075, 0.075, transform=axes.transAxes, **_PLATE, zorder=6)
    )
    for part, colour in ((0, "black"), (1, "white")):
        axes.add_patch(
            Rectangle(
                (x + part * share / 2, y),
                share / 2,
                thick,
                transform=axes.transAxes,
                facecolor=colour,
                edgecolor="black",
                linewidth=0.8,
                zorder=7,
            )
        )
    for at, text in ((0, "0"), (0.5, f"{length / 2:g}"), (1, f"{length:g} km")):
        axes.text(
            x + at * share,
            y + thick + 0.006,
            text,
            transform=axes.transAxes,
            ha="center",
            va="bottom",
            size=8,
            zorder=7,
        )


def _north_arrow(axes: Axes) -> None:
    axes.add_patch(Rectangle((0.925, 0.875), 0.055, 0.105, transform=axes.transAxes, **_PLATE, zorder=6))
    axes.text(0.9525, 0.945, "N", transform=axes.transAxes, ha="center", va="bottom", weight="bold", zorder=7)
    for side, colour in ((-1, "black"), (1, "white")):
        points = [(0.9525, 0.942), (0.9525 + side * 0.016, 0.885), (0.9525, 0.9)]
        axes.add_patch(
            Polygon(
                points,
                transform=axes.transAxes,
                facecolor=colour,
                edgecolor="black",
                linewidth=0.8,
                zorder=7,
            )
        )


_PLATE: dict[str, Any] = {"facecolor": "white", "alpha": 0.78, "edgecolor": "none"}


def save(figure: Figure, path: Path, overwrite: bool = False) -> None:
    """Write a figure as PNG, in place of an earlier one."""
    metadata = {"Software": "Firetwin"}
    output.write(path, lambda part: figure.savefig(part, dpi=DPI, metadata=metadata), overwrite)
