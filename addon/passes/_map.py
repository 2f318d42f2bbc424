"""Map around a camera: a minimap's picture or the run's relief, with fire and camera drawn over it.

The front is a bright line, ground burned in the last half hour orange, the burn scar dark red. The camera is
drawn with its path and field of view. Fire and scar come from the run, so smoke in a minimap's picture does
not occlude them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from firetwin_core.terrain import bilinear
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LightSource
from matplotlib.patches import Polygon, Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from ..run import front, measure

if TYPE_CHECKING:
    from ..shot.cameras.path import Path
    from ..shot.shot import Shot

_RECENT = 1800.0  # s, time for which burned ground is orange
_OPEN, _WOODED = np.array([0.86, 0.82, 0.72]), np.array([0.50, 0.60, 0.42])
_SCAR, _HOT = np.array([0.26, 0.07, 0.05, 0.72]), np.array([1.0, 0.45, 0.05, 0.85])  # colour and opacity
_FRONT = "#ffe14d"
_MIN_REACH = 2000.0  # m, least distance from the centre to the sides
_ROWS = 200  # rows of points that are looked up
_WAY, _EDGE = "#1e62d0", [withStroke(linewidth=2.2, foreground="white")]


def draw(
    axes: Axes, shot: Shot, view: Path, frame: int, photo: NDArray | None = None, swath: float = 0.0
) -> None:
    """Draw into the axes of a panel; `photo` (h, w, 3) is a minimap's picture, `swath` metres wide."""
    box = axes.get_window_extent()
    here, reach = view.position[frame - 1], 0.5 * swath or _reach(view)
    tall = reach * box.height / box.width
    columns = max(round(_ROWS * box.width / box.height), 2)
    east, north = np.linspace(-reach, reach, columns), np.linspace(tall, -tall, _ROWS)
    if photo is None:
        photo, high = _ground(shot, here, east, north), tall
    else:
        high = reach * photo.shape[0] / photo.shape[1]
    axes.imshow(photo, extent=(-reach, reach, -high, high), interpolation="bilinear", aspect="auto")
    _draw_fire(axes, shot, here, east, north, shot.frames.time(frame))
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-tall, tall)
    way = view.position[:, :2] - here[:2]
    axes.plot(*way.T, color=_WAY, linewidth=1.0, path_effects=_EDGE, zorder=5)
    _draw_field_of_view(axes, view, frame, reach)
    axes.plot(0.0, 0.0, "o", color=_WAY, markersize=0.03 * box.height, markeredgecolor="white", zorder=7)
    _draw_scale(axes, reach, tall, box.height)


def _reach(view: Path) -> float:
    """Choose the distance from centre to sides, m, that keeps the target on the map in every frame."""
    away = np.linalg.norm((view.target - view.position)[:, :2], axis=1)
    return max(_MIN_REACH, 2.2 * float(away.max()))


def _ground(shot: Shot, here: NDArray, east: NDArray, north: NDArray) -> NDArray:
    """Compute ground colours (rows, columns, 3) at scene metres from `here`, north first."""
    row, column = shot.ground.indices(*_coordinates(shot, here, east, north))
    fields = shot.ground.fields
    height, canopy = (
        bilinear(f, row, column).reshape(len(north), -1) for f in (fields.elevation, fields.canopy_fuel)
    )
    colour = _OPEN + np.clip(canopy, 0.0, 1.0)[..., None] * (_WOODED - _OPEN)
    shade = LightSource(315, 45).hillshade(
        height, vert_exag=1.5, dx=abs(east[1] - east[0]), dy=abs(north[1] - north[0])
    )
    return np.clip(colour * (0.45 + 0.75 * shade[..., None]), 0.0, 1.0)


def _coordinates(shot: Shot, here: NDArray, east: NDArray, north: NDArray) -> tuple[NDArray, NDArray]:
    """Convert scene metres from `here` to latitude and longitude (rows * columns)."""
    x, y = np.meshgrid(here[0] + east, here[1] + north)
    return shot.ground.geodetic(x.ravel(), y.ravel())


def _draw_fire(axes: Axes, shot: Shot, here: NDArray, east: NDArray, north: NDArray, time: float) -> None:
    """Draw the burned area at a model time (s) and its front over the ground."""
    reach, places = front.reach(shot.run), _coordinates(shot, here, east, north)
    burned = reach.burned(*places, time).reshape(len(north), -1) == 1.0
    age = time - shot.ground.arrival_at(*shot.ground.indices(*places)).reshape(burned.shape)
    fresh = np.clip(1.0 - np.nan_to_num(age, nan=0.0) / _RECENT, 0.0, 1.0)[..., None]
    colour = _SCAR + fresh * (_HOT - _SCAR)
    colour[~burned] = 0.0
    extent = (east[0], east[-1], north[-1], north[0])
    axes.imshow(colour, extent=extent, interpolation="nearest", aspect="auto", zorder=2)
    latitude, longitude, after = reach.line(time)
    line = shot.local_frame.forward(latitude, longitude, np.zeros(len(after)))[:, :2] - here[:2]
    size = 0.006 * axes.get_window_extent().height
    for width, edge in ((2.0 * size, "black"), (size, _FRONT)):
        pieces = np.stack([line, line[after]], axis=1)
        axes.add_collection(
            LineCollection(pieces, colors=edge, linewidths=width, capstyle="round", zorder=3), autolim=False
        )


def _draw_field_of_view(axes: Axes, view: Path, frame: int, reach: float) -> None:
    """Draw the field of view: filled up to the target, with its sides extended to the edge of the map."""
    if not view.perspective:
        return
    ahead = -view.rotation[frame - 1][:2, 2]
    length = float(np.linalg.norm((view.target - view.position)[frame - 1, :2]))
    if np.linalg.norm(ahead) < 0.05 or length < 0.02 * reach:
        return
    bearing = np.arctan2(*ahead) + np.arctan(view.halves[frame - 1, 0]) * np.linspace(-1.0, 1.0, 25)
    rim = length * np.stack([np.sin(bearing), np.cos(bearing)], axis=-1)
    axes.add_patch(Polygon([(0.0, 0.0), *rim], facecolor="white", alpha=0.22, edgecolor="none", zorder=4))
    axes.add_patch(Polygon([(0.0, 0.0), *rim], fill=False, edgecolor="white", linewidth=1.0, zorder=6))
    for side in (rim[0], rim[-1]):
        axes.plot(*np.stack([side, side * 3.0 * reach / length], axis=1), "w:", linewidth=1.0, zorder=6)


def _draw_scale(axes: Axes, reach: float, tall: float, height: float) -> None:
    """Draw a scale bar of a round length and a north arrow."""
    length = measure.round_length(0.5 * reach)
    size = 0.036 * height * 0.72
    x, y = -0.97 * reach, -0.92 * tall
    edge: dict[str, Any] = {"edgecolor": "black", "linewidth": 0.6, "zorder": 8}
    for part, colour in ((0, "black"), (1, "white")):
        corner = x + 0.5 * part * length, y
        axes.add_patch(Rectangle(corner, 0.5 * length, 0.025 * tall, facecolor=colour, **edge))
    name = f"{length / 1e3:g} km" if length >= 1000.0 else f"{length:g} m"
    said: dict[str, Any] = {
        "size": size,
        "family": "DejaVu Sans",
        "color": "black",
        "path_effects": _EDGE,
        "zorder": 9,
    }
    axes.text(x, y + 0.05 * tall, name, va="bottom", **said)
    axes.annotate(
        "N",
        (0.94 * reach, 0.93 * tall),
        (0.94 * reach, 0.62 * tall),
        ha="center",
        arrowprops={"arrowstyle": "-|>", "color": "black", "linewidth": 1.0, "path_effects": _EDGE},
        **said,
    )
