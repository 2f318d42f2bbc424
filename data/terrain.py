"""Terrain around the King Fire: public spot heights and river lines, with natural relief between them.

Rivers and lakes have their given heights. Between them the land rises as streams would have cut it
(drainage.py), up to an old, gently rolling upland surface through the spot heights: the west slope of the
Sierra Nevada. A last smooth correction, 0 at rivers and lakes, restores the spot heights.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator, RBFInterpolator
from scipy.ndimage import distance_transform_edt

from .drainage import Drainage
from .fractal import fractal, smooth
from .grid import FUEL_CELL_SIZE, FUEL_CELLS, cell_of, local
from .history import Event, Place

MARGIN = (
    80  # fuel cells around the domain, so that valleys do not end at its edge and Pyramid Peak is on the map
)
CELLS = FUEL_CELLS + 2 * MARGIN
STEEPNESS = 120.0  # ks, so that a stream with 1 km2 above it falls by 0.24
CONCAVITY = 0.45  # theta, the usual value (Whipple & Tucker 1999)
STEEPEST = 0.65  # canyon walls, 33 degrees
BEND = 200.0  # m, standard deviation of the bends given to sketched rivers
UPLAND_DEPTH = 260.0  # m below the upland surface over which slopes ease
DRY = ("town", "summit", "ridge")  # kinds of places on the upland
UPLAND_SLOPE = 0.32  # fraction of the slopes that remains on it


@dataclass(frozen=True)
class Terrain:
    """Heights and water on the fuel grid, with the data of the fit.

    Attributes
    ----------
    elevation : (fy, fx) float64, m.
    water : (fy, fx) bool, reservoirs.
    stream : (fy, fx) float64, area in m2 that drains through the cell; rivers have at least 50 km2.
    rivers : name -> (row, column) int arrays of the river's cells from mouth to head, inside the domain only.
    misfit : name of the place -> computed minus given height in m; places outside the domain included.
    """

    elevation: NDArray[np.float64]
    water: NDArray[np.bool_]
    stream: NDArray[np.float64]
    rivers: dict[str, tuple[NDArray, NDArray]]
    misfit: dict[str, float]


def make(event: Event, seed: int = 2014) -> Terrain:
    """Compute the terrain; about half a minute."""
    rivers = _river_cells(event, seed)
    fixed, water = _fixed_heights(event, rivers, _bends(event.places, seed))
    upland = _upland(event.places, fixed, seed)
    drainage = Drainage(fixed, FUEL_CELL_SIZE)
    rock = np.exp(0.28 * fractal(fixed.shape, seed + 1, 60, 2, 1.0))
    first = 2e5 * np.exp(1.5 * fractal(fixed.shape, seed + 2, 30, 2, 1.0))

    def slope_of(area: NDArray, height: NDArray) -> NDArray:
        room = np.clip((upland - height) / UPLAND_DEPTH, 0.0, 1.0) if np.isfinite(height).all() else 1.0
        ease = UPLAND_SLOPE + (1 - UPLAND_SLOPE) * room
        return np.minimum(STEEPNESS * area**-CONCAVITY, STEEPEST) * ease * rock

    height, area = drainage.settle(slope_of, first, rounds=12)
    height = _weather(height, fixed, upland, seed)
    height = _through_spots(height, fixed, event.places)
    stream = np.where(np.isfinite(fixed) & ~water, np.maximum(area, 5e7), area)
    inside = (slice(MARGIN, -MARGIN),) * 2
    misfit = {place.name: float(_at(height, place) - place.height) for place in event.places}
    return Terrain(height[inside], water[inside], stream[inside], _inside(rivers), misfit)


def rms(misfit: dict[str, float]) -> float:
    """Root mean square of the misfits, m."""
    return float(np.sqrt(np.mean(np.square(list(misfit.values())))))


def _cells(latitude: NDArray, longitude: NDArray) -> tuple[NDArray, NDArray]:
    row, column = cell_of(latitude, longitude)
    return row + MARGIN, column + MARGIN


def _at(field: NDArray, place: Place) -> float:
    row, column = _cells(place.latitude, place.longitude)
    return field[row, column]


def _river_cells(event: Event, seed: int) -> dict[str, tuple[NDArray, NDArray, NDArray]]:
    """Name -> row, column, height of the river's cells, mouth to head, on the map with its margin.

    Sketched lines get bends of some 200 m; a mouth within 2 km of an earlier river joins it at its height;
    heights between the given points follow a monotone cubic (Fritsch & Carlson 1980).
    """
    bend = _bends(event.places, seed)
    taken: dict[tuple[int, int], float] = {}
    result: dict[str, tuple[NDArray, NDArray, NDArray]] = {}
    for name, points in event.rivers.items():
        latitude, longitude, height = np.array(points).T
        row, column = (array.astype(float) for array in _cells(latitude, longitude))
        along = np.concatenate([[0], np.cumsum(np.hypot(np.diff(row), np.diff(column)))])
        fine = np.arange(0, along[-1], 0.25)
        row, column = _bent(np.interp(fine, along, row), np.interp(fine, along, column), bend)
        path = list(zip(row.tolist(), column.tolist(), PchipInterpolator(along, height)(fine), strict=True))
        path = [step for step in path if 0 <= step[0] < CELLS and 0 <= step[1] < CELLS]
        path = _without_loops(_joined(path, taken))
        row, column, height = (np.array(part) for part in zip(*path, strict=True))
        result[name] = row, column, np.maximum.accumulate(height)
        taken |= {(r, c): h for r, c, h in zip(*(part.tolist() for part in result[name]), strict=True)}
    return result


def _without_loops(path: list[tuple[int, int, float]]) -> list[tuple[int, int, float]]:
    """Remove loops from a path."""
    result: list[tuple[int, int, float]] = []
    place: dict[tuple[int, int], int] = {}
    for step in path:
        cell = step[:2]
        if cell in place:
            for gone in result[place[cell] + 1 :]:
                del place[gone[:2]]
            del result[place[cell] + 1 :]
        else:
            place[cell] = len(result)
            result.append(step)
    return result


def _joined(path: list[tuple[int, int, float]], taken: dict) -> list[tuple[int, int, float]]:
    """Cut a path at its last contact with earlier rivers, or lead it to the nearest within 2 km."""
    for i in range(len(path) - 1, -1, -1):
        if path[i][:2] in taken:
            level = taken[path[i][:2]]
            return [(*path[i][:2], level)] + [(r, c, max(h, level)) for r, c, h in path[i + 1 :]]
    if not taken:
        return path
    cells = np.array(list(taken))
    away = cells - path[0][:2]
    nearest = int(np.argmin((away**2).sum(axis=1)))
    distance = float(np.hypot(*away[nearest]))
    if distance * FUEL_CELL_SIZE > 2000:
        return path
    level = taken[tuple(cells[nearest].tolist())]
    rise = max(path[0][2] - level, 0)
    steps = int(2 * distance) + 1
    bridge = [
        (*np.rint(cells[nearest] - part * away[nearest]).astype(int).tolist(), level + part * rise)
        for part in np.linspace(0, 1, steps, endpoint=False)
    ]
    return bridge + [(r, c, max(h, level)) for r, c, h in path]


def _bends(places: list[Place], seed: int) -> list[NDArray]:
    """Return offsets of rivers and lakes to the north and east (m), 0 at spot heights on them."""
    bend = [BEND * fractal((CELLS, CELLS), seed + 10 + axis, 55, 12, 1.2) for axis in (0, 1)]
    row, column = np.indices((CELLS, CELLS))
    for place in places:
        if place.kind in ("lake", "valley"):
            at_row, at_column = _cells(place.latitude, place.longitude)
            near = np.exp(-((row - at_row) ** 2 + (column - at_column) ** 2) * (FUEL_CELL_SIZE / 1000) ** 2)
            bend = [field * (1 - near) for field in bend]
    return bend


def _bent(row: NDArray, column: NDArray, bend: list[NDArray]) -> tuple[NDArray, NDArray]:
    r = np.clip(row, 0, CELLS - 1).astype(int)
    c = np.clip(column, 0, CELLS - 1).astype(int)
    row = row + bend[0][r, c] / FUEL_CELL_SIZE
    column = column + bend[1][r, c] / FUEL_CELL_SIZE
    return np.rint(row).astype(int), np.rint(column).astype(int)


def _fixed_heights(
    event: Event, rivers: dict, bend: list[NDArray]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Heights of river and lake cells (NaN elsewhere), and where the lakes are."""
    fixed = np.full((CELLS, CELLS), np.nan)
    for row, column, height in rivers.values():
        fixed[row, column] = np.fmin(fixed[row, column], height)
    water = np.zeros(fixed.shape, dtype=bool)
    wobble = 0.22 * fractal(fixed.shape, 77, 20, 3, 1.5)
    for lake in event.reservoirs.values():
        near = _near_line(lake.line, bend) < lake.width / 2 * np.exp(wobble)
        near &= ~(fixed < lake.height - 1)  # the river below the dam
        fixed[near] = lake.height
        water |= near
    for row, column, _ in rivers.values():  # from head to mouth no cell lies above the one before
        fixed[row, column] = np.minimum.accumulate(fixed[row, column][::-1])[::-1]
    return fixed, water


def _near_line(line: list[tuple[float, float]], bend: list[NDArray]) -> NDArray[np.float64]:
    """Distance (m) of every cell from a line [(latitude, longitude), ...] that winds like the rivers."""
    centre = (np.arange(CELLS) - (CELLS - 1) / 2) * FUEL_CELL_SIZE
    x, y = np.meshgrid(centre, centre)
    x, y = x - bend[1], y - bend[0]
    px, py = local(*np.array(line).T)
    distance = np.full(x.shape, np.inf)
    for i in range(len(px) - 1):
        dx, dy = px[i + 1] - px[i], py[i + 1] - py[i]
        t = np.clip(((x - px[i]) * dx + (y - py[i]) * dy) / (dx**2 + dy**2), 0, 1)
        distance = np.minimum(distance, np.hypot(x - px[i] - t * dx, y - py[i] - t * dy))
    return distance


def _spots(places: list[Place], kinds: tuple[str, ...]) -> tuple[NDArray, NDArray]:
    chosen = [place for place in places if place.kind in kinds]
    x, y = local([place.latitude for place in chosen], [place.longitude for place in chosen])
    return np.column_stack([x, y]) / 1000, np.array([place.height for place in chosen], dtype=float)


def _spread(points: NDArray, values: NDArray, **options: object) -> NDArray[np.float64]:
    """Radial basis functions through points (n, 2) in km, evaluated on every eighth cell and enlarged."""
    step = 8
    coarse = (np.arange(0, CELLS + step, step) - (CELLS - 1) / 2) * FUEL_CELL_SIZE / 1000
    x, y = np.meshgrid(coarse, coarse)
    field = RBFInterpolator(points, values, **options)(np.column_stack([x.ravel(), y.ravel()])).reshape(
        x.shape
    )
    at = np.arange(CELLS) / step
    low = np.floor(at).astype(int)
    part = at - low
    field = field[low] * (1 - part)[:, None] + field[low + 1] * part[:, None]
    return smooth(field[:, low] * (1 - part) + field[:, low + 1] * part, step / 2)


def _upland(places: list[Place], fixed: NDArray, seed: int) -> NDArray[np.float64]:
    """Compute the old surface above the canyons (m): a thin plate through ridges, summits and towns."""
    points, heights = _spots(places, DRY)
    surface = _spread(points, heights + 50.0, kernel="thin_plate_spline", smoothing=2.0)
    high = np.clip((surface - 1500) / 1000, 0, 1)
    rolling = 55 + 110 * high  # the glaciated crest is rougher
    surface += rolling * fractal(fixed.shape, seed + 3, 70, 4, 1.6)
    return np.clip(surface, 350, 3100)


def _weather(height: NDArray, fixed: NDArray, upland: NDArray, seed: int) -> NDArray[np.float64]:
    """Round ridges towards the upland surface, let soil creep, and roughen rock; rivers and lakes stay."""
    ease = 70.0
    over = np.clip((height - upland) / ease, -30, 30)
    height = np.minimum(height, upland + ease) - ease * np.log1p(np.exp(over)) * 0.6
    creep = smooth(height, 0.9)
    high = np.clip((creep - 1500) / 900, 0, 1)
    rough = fractal(height.shape, seed + 4, 30, 3, 1.5) * (4 + 16 * high)
    away = np.clip(distance_transform_edt(np.isnan(fixed)) / 6, 0, 1)
    height = creep + rough * away
    return np.where(np.isfinite(fixed), fixed, np.maximum(height, _nearest(fixed)))


def _nearest(fixed: NDArray) -> NDArray[np.float64]:
    """Return the height of the nearest fixed cell, a lower bound for land next to rivers."""
    row, column = distance_transform_edt(np.isnan(fixed), return_distances=False, return_indices=True)
    return fixed[row, column] * (distance_transform_edt(np.isnan(fixed)) <= 2)


def _through_spots(height: NDArray, fixed: NDArray, places: list[Place]) -> NDArray[np.float64]:
    """Add a smooth correction through the misfits at the spot heights, fading to none at rivers and lakes."""
    weight = 1 - np.exp(-((distance_transform_edt(np.isnan(fixed)) * FUEL_CELL_SIZE / 900) ** 2))
    land = [place for place in places if place.kind in DRY]
    points, target = _spots(places, DRY)
    for _ in range(3):
        found = np.array([_at(height, place) for place in land])
        faded = np.array([_at(weight, place) for place in land])
        wanted = (target - found) / np.maximum(faded, 0.2)
        field = _spread(points, wanted, kernel="gaussian", epsilon=1 / 3.0, degree=-1)
        height = height + weight * field
    return height


def _inside(rivers: dict) -> dict[str, tuple[NDArray, NDArray]]:
    result = {}
    for name, (row, column, _) in rivers.items():
        row, column = row - MARGIN, column - MARGIN
        keep = (row >= 0) & (row < FUEL_CELLS) & (column >= 0) & (column < FUEL_CELLS)
        if keep.any():
            result[name] = row[keep], column[keep]
    return result
