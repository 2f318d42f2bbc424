"""Measure solved flames, and pack them as blocks one flame length high.

The flame length is the median, over time and places along the line, of the greatest distance from the middle
of the burning base at which gas is richer than stoichiometric: the length that the flame exceeds half of the
time (intermittency 0.5; Zukoski, Cetegen and Kubota 1985). Places count by their burning gas, so that gaps in
the line do not count.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

LIGHTEST = 0.3  # mixture fraction below which gas is not seen, and stored as 0 (by eye)
FADING = 0.2  # share of the frames that blend into the first ones
_LIGHTEST_CODE = 255.0 * (LIGHTEST / 4.0) ** 0.5
HIGHEST, FARTHEST = 1.8, 2.2  # flame lengths above the ground and behind the front that are stored
_RIM = 0.12  # flame lengths in which flames fade out below the highest and before the farthest cells
_STEP = 4  # codes between stored levels
_DISSOLVING = (0.7, 1.1)  # greatest mixture fraction nearby between which gas is softened (by eye)


@dataclass(frozen=True)
class Solved:
    """Frames and means of a solved flame, in the solver's units.

    Attributes
    ----------
    codes : (frames, nz, ny, nx) uint8, mixture fraction 4 (code / 255)^2.
    heat : heat that leaves the box per length of the line (of y for a crown), over density, specific heat and
        temperature of air.
    rise : (nz,) mean vertical speed of burning gas, 0 where none burns.
    divergence : largest error of the divergence times a cell.
    """

    codes: NDArray[np.uint8]
    heat: float
    rise: NDArray[np.float32]
    divergence: float
    settings: dict[str, Any]


def read_solved(out: Path, settings: dict[str, Any]) -> Solved:
    """Read the output of the solver for `settings`."""
    nx, ny, nz = (int(settings[name]) for name in ("nx", "ny", "nz"))
    codes = np.fromfile(out, np.uint8).reshape(-1, nz, ny, nx)
    values = np.fromfile(out.with_name(out.name + ".profiles"), np.float32)
    return Solved(codes, float(values[0]), values[1:-1], float(values[-1]), settings)


def mixture(codes: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return mixture fractions of codes, in units of the stoichiometric one."""
    return (4.0 * (np.arange(256, dtype=np.float32) / 255.0) ** 2)[codes]


@dataclass(frozen=True)
class Tips:
    """Tips of a flame: the farthest burning cell from the middle of the base, at each time and y.

    `x` (from the base's middle), `height` and `length` (n,) are in the unit of the cell, and `weight` (n,)
    counts the burning cells, 0 in gaps. A crown has one tip at a time, its highest; its length is its height.
    """

    x: NDArray[np.float64]
    height: NDArray[np.float64]
    length: NDArray[np.float64]
    weight: NDArray[np.int64]

    def median(self, values: NDArray[np.float64]) -> float:
        """Return the median of `values` (n,), weighted by burning gas."""
        order = np.argsort(values)
        total = np.cumsum(self.weight[order])
        return float(values[order][np.searchsorted(total, 0.5 * total[-1])])


def find_tips(codes: NDArray[np.uint8], cell: float, base: float, crown: bool) -> Tips:
    """Return the tips of frames whose base has its middle at x = `base` from the first face."""
    burning = mixture(codes) > 1.0
    burning = burning.any(axis=2)[:, :, None] if crown else burning
    nz, nx = burning.shape[1], burning.shape[3]
    z, x = np.meshgrid((np.arange(nz) + 0.5) * cell, (np.arange(nx) + 0.5) * cell - base, indexing="ij")
    distance = z if crown else np.hypot(x, z)
    farthest = np.argsort(distance, axis=None)[::-1]
    columns = burning.transpose(0, 2, 1, 3).reshape(-1, nz * nx)
    weight = columns.sum(axis=1)
    tip = farthest[columns[:, farthest].argmax(axis=1)]
    x, height, length = (np.where(weight > 0, each.ravel()[tip], 0.0) for each in (x, z, distance))
    return Tips(x, height, length, weight)


def base_of(settings: dict[str, Any]) -> float:
    """Return x of the middle of the burning base, in units."""
    return float(settings["front"]) - (0.0 if settings.get("crown") else 0.5 * float(settings["depth"]))


def flame_length(solved: Solved) -> float:
    """Return the flame length in units."""
    settings = solved.settings
    tips = find_tips(solved.codes, 1.0 / settings["cells"], base_of(settings), bool(settings.get("crown")))
    return tips.median(tips.length)


def mean_excess(solved: Solved) -> NDArray[np.float64]:
    """Return (nz,): mean temperature excess over the air's, on the axis, relative to the air's temperature.

    The axis of a line has the greatest mean over time and y, that of a crown is its trunk's. Temperatures
    follow from the mixture fraction as in `solver/combustion.cpp`.
    """
    settings = solved.settings
    rich = mixture(np.arange(256, dtype=np.uint8))
    excess = 3.2 * np.where(rich < 1.0, rich, 1.0 - 0.55 * (rich - 1.0) / 4.0)
    height = (np.arange(settings["nz"]) + 0.5) / settings["cells"]
    kept = 1.0 - 0.35 * np.minimum(height / 1.2, 1.0)
    if settings.get("crown"):
        middle, reach = settings["ny"] // 2, max(1, round(0.05 * settings["cells"]))
        x = round(settings["front"] * settings["cells"])
        core = solved.codes[:, :, middle - reach : middle + reach, x - reach : x + reach]
        return kept * excess[core].mean(axis=(0, 2, 3))
    mean = np.mean([excess.astype(np.float32)[frame].mean(axis=1) for frame in solved.codes], axis=0)
    return kept * mean.max(axis=1)


def save(path: Path, solved: Solved) -> float:
    """Write a block whose flame is 1 long, and return the flame length in the solver's units.

    Besides the fields of `firetwin.shot.fire.flame_library.FlameBlock` it has, for `check.py`: `depth` (L) of
    the burning base, and `excess` (nz,), the mean temperature excess over the air's on the axis.
    """
    settings, length = solved.settings, flame_length(solved)
    cell, scale = 1.0 / (settings["cells"] * length), np.sqrt(length)
    faded = _fade_rims(_soften_dissolving(solved.codes), cell, settings["front"] / length)
    codes, first, levels = _crop(faded)
    crown = bool(settings.get("crown"))
    trunk = [settings[f"crown_{name}"] / length if crown else 0.0 for name in ("base", "top", "radius")]
    np.savez_compressed(
        path,
        codes=_quantise(codes),
        rise=_fill(solved.rise / scale)[:levels].astype(np.float32),
        cell=np.float64(cell),
        front=np.float64(settings["front"] / length - first * cell),
        interval=np.float64(settings["interval"] / scale),
        fade=np.int64(max(1, round(FADING * len(codes)))),
        wind=np.float64(settings.get("wind", 0.0) / scale),
        crown=np.array(trunk),
        depth=np.float64(0.0 if crown else settings["depth"] / length),
        excess=mean_excess(solved)[:levels].astype(np.float32),
    )
    return length


def _soften_dissolving(codes: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return codes with lean gas away from burning gas blurred by 1-2-1: it shows lines of the grid else."""
    softened = np.empty(codes.shape, np.float32)
    low, high = _DISSOLVING
    for frame, out in zip(codes, softened, strict=True):
        nearby, blurred = mixture(frame), frame.astype(np.float32)
        for axis in range(3):
            below, above = (_neighbour(nearby, shift, axis) for shift in (1, -1))
            nearby = np.maximum(nearby, np.maximum(below, above))
            below, above = (_neighbour(blurred, shift, axis) for shift in (1, -1))
            blurred = 0.5 * blurred + 0.25 * (below + above)
        weight = np.clip((high - nearby) / (high - low), 0.0, 1.0)
        out[:] = frame + weight * (blurred - frame)
    return softened


def _neighbour(values: NDArray[np.float32], shift: int, axis: int) -> NDArray[np.float32]:
    """Return the values of the next cell along an axis: y (1) is periodic, ends of z and x repeat."""
    rolled = np.roll(values, shift, axis)
    if axis != 1:
        end = 0 if shift > 0 else -1
        np.moveaxis(rolled, axis, 0)[end] = np.moveaxis(values, axis, 0)[end]
    return rolled


def _fade_rims(codes: NDArray[np.float32], cell: float, front: float) -> NDArray[np.float32]:
    """Return codes that fall to 0 at the highest and the farthest place, and where gas is not seen."""
    nz, nx = codes.shape[1], codes.shape[3]
    z, x = (np.arange(nz) + 0.5) * cell, (np.arange(nx) + 0.5) * cell - front
    low = np.clip((HIGHEST - z) / _RIM, 0, 1).astype(np.float32)
    near = np.clip((FARTHEST - x) / _RIM, 0, 1).astype(np.float32)
    faded = codes * (low[:, None, None] * near)
    faded[faded < _LIGHTEST_CODE] = 0
    return faded


def _crop(codes: NDArray[np.float32]) -> tuple[NDArray[np.float32], int, int]:
    """Return the codes without empty columns at the ends of x and levels on top, the first x, and levels."""
    used_x = np.flatnonzero(codes.any(axis=(0, 1, 2)))
    used_z = np.flatnonzero(codes.any(axis=(0, 2, 3)))
    first, last = max(used_x[0] - 1, 0), min(used_x[-1] + 2, codes.shape[3])
    levels = min(used_z[-1] + 2, codes.shape[1])
    return codes[:, :levels, :, first:last], int(first), int(levels)


def _quantise(codes: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Round to fewer levels, which deflate packs more tightly."""
    return np.minimum(np.rint(codes / _STEP) * _STEP, 255).astype(np.uint8)


def _fill(rise: NDArray[np.float32]) -> NDArray[np.float64]:
    """Give levels without burning gas the speed of the nearest level with some."""
    known = np.flatnonzero(rise > 0)
    return np.interp(np.arange(len(rise)), known, rise[known])
