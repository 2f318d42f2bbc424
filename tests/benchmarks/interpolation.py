"""Heat flux interpolated between model times against held-out minutes, compared with linear blending.

Front error: percentage of the cells crossed by the front during a gap that are on its wrong side at the
held-out minute, that is, the position error as a fraction of the distance moved. The integral of F^1.5 drives
size and colour of the flames. Its ripple is the root mean square deviation from a linear course between the
retained minutes; it is visible as one pulse per model step.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from firetwin.bench.harness import OURS, Bench
from firetwin.data import sample, stored
from firetwin.data.grid import MODEL_CELL_SIZE, MODEL_CELLS, axes
from firetwin.run import opening as runs
from firetwin_core.flux import Interpolator
from numpy.typing import NDArray

FIRST, MINUTES = 1000, 240  # four hours of the sample's long run up the canyon
LINEAR = "linear blending"
CASES = {
    "every other minute removed": lambda i: i % 2 == 0,
    "every fifth minute removed": lambda i: i % 5 != 3,
    "four of five minutes removed": lambda i: i % 5 == 0,
}
Interpolate = Callable[[float], NDArray]


def truth(minutes: int) -> NDArray:
    """Return the heat flux (minutes + 1, ny, nx) W/m2 of the sample fire."""
    wanted = np.arange(FIRST, FIRST + minutes + 1)
    return np.stack([frame[0] for frame in sample.frames_of(stored.load(), wanted)]).astype(np.float32)


def write_run(folder: Path, flux: NDArray, seconds: NDArray) -> None:
    """Write a run of these minutes, flux (nt, side, side), on flat terrain."""
    side = flux.shape[1]
    latitude, longitude = axes(side, MODEL_CELL_SIZE * MODEL_CELLS / side)
    still = np.zeros((side, side), np.float32)
    for prefix in ("", "fuel_"):
        np.save(folder / f"{prefix}latitude.npy", latitude)
        np.save(folder / f"{prefix}longitude.npy", longitude)
    for name in ("elevation", "surface_fuel", "canopy_fuel"):
        np.save(folder / f"{name}.npy", still)
    np.save(folder / "heat_flux.npy", flux)
    times = ", ".join(str(float(s)) for s in seconds)
    (folder / "run.toml").write_text(
        f'start = 2014-09-17T04:45:00Z\nvertical = "orthometric"\ntimes_s = [{times}]\nmean_s = 60.0\n'
    )


def front_error(field: NDArray, true: NDArray, before: NDArray, after: NDArray) -> float:
    """Return the percentage of cells crossed from `before` to `after` that are on the front's wrong side."""
    crossed = (before == 0) & (after > 0)
    return float(100 * ((field > 0) != (true > 0))[crossed].sum() / max(1, crossed.sum()))


def brightness(flux: NDArray) -> float:
    """Sum F^1.5."""
    return float(np.sum(np.maximum(flux, 0).astype(float) ** 1.5))


def departure(field: NDArray, expected: NDArray) -> float:
    """Return the root mean square of the relative difference, in percent."""
    return 100 * float(np.sqrt(np.mean(np.square(field / expected - 1))))


def run(bench: Bench) -> None:
    """Measure both interpolations for each pattern of held-out minutes."""
    flux = truth(MINUTES)
    seconds = 60.0 * np.arange(len(flux))
    for case, keeps in CASES.items():
        kept = np.array([i for i in range(len(flux)) if keeps(i)])
        with tempfile.TemporaryDirectory() as folder:
            write_run(Path(folder), flux[kept], seconds[kept])
            model = runs.open(folder)
            tools: dict[str, Interpolate] = {
                OURS: Interpolator(model).at,
                LINEAR: lambda t: linear(model, t),  # noqa: B023
            }
            errors = _errors(tools, flux, seconds, kept)
        for index, name in enumerate(("Front error", "F^1.5 ripple")):
            ours, theirs = (errors[tool][index] for tool in (OURS, LINEAR))
            bench.target(f"{name}, {case}", ours, theirs, "%", most=True, rival=LINEAR)


def linear(run: runs.Run, time: float) -> NDArray:
    """Cross-fade the two model times around `time`."""
    i = int(np.clip(np.searchsorted(run.times, time, "right") - 1, 0, len(run.times) - 2))
    w = (time - run.times[i]) / (run.times[i + 1] - run.times[i])
    return (1 - w) * run.heat_flux(i) + w * run.heat_flux(i + 1)


def _even(flux: NDArray, kept: NDArray, removed: list[int]) -> NDArray:
    return np.interp(removed, kept, [brightness(flux[i]) for i in kept])


def _missing(kept: NDArray) -> list[int]:
    return [i for i in range(kept[0], kept[-1]) if i not in kept]


def _errors(
    tools: dict[str, Interpolate], flux: NDArray, seconds: NDArray, kept: NDArray
) -> dict[str, tuple[float, float]]:
    """Return front error and ripple (%) of each tool."""
    removed = _missing(kept)
    bright = _even(flux, kept, removed)
    errors = {}
    for tool, call in tools.items():
        fields = [call(seconds[i]) for i in removed]
        fronts = []
        for f, i in zip(fields, removed, strict=True):
            before, after = kept[kept < i][-1], kept[kept > i][0]
            fronts.append(front_error(f, flux[i], flux[before], flux[after]))
        ripple = departure(np.array([brightness(f) for f in fields]), bright)
        errors[tool] = float(np.mean(fronts)), ripple
    return errors
