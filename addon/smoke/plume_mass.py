"""Plume mass and optical depth of a shot, with published values for comparison.

Needs no Blender. Optical depth includes only the smoke's mass, at 4 m2/g in green light. Ash and droplets of
a crown fire's column (see `flow_frames`) are drawn in addition, for appearance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..shot.fire import emissions
from ..shot.shot import Shot
from . import snapshots, sources
from .domains import Domain

_AVERAGING = 1000.0  # m, averaging width, similar to satellites and photometers
_SMOKY = 0.1  # least optical depth of a column of the plume
_MAX_SNAPSHOTS = 3  # largest number of snapshots to measure

# Savanna fires in Zambia, at 440 nm (Eck et al. 2003, doi 10.1029/2002JD002321), and wildfires in the western
# United States, at 550 nm, where photometers measured 0.5 to 3 (Ye et al. 2022, doi 10.3390/rs14236113). Both
# describe dispersed smoke; young plumes near the fire are deeper than either range.
_PUBLISHED = {
    False: ("of savanna fires", 0.4, 2.5, "Eck et al. 2003"),
    True: ("of western wildfires", 0.5, 3.0, "Ye et al. 2022"),
}


@dataclass(frozen=True)
class PlumeMass:
    """Smoke plume of a shot.

    Attributes
    ----------
    made
        Emitted PM2.5 from the first frame to the last, kg; of a still, in the spin-up before it.
    deepest, wide, mean
        Vertical optical depth: maximum of a column of cells, maximum of the mean over a kilometre, and mean
        over the plume; None without snapshots.
    """

    made: float
    deepest: float | None = None
    wide: float | None = None
    mean: float | None = None


def measure(shot: Shot) -> PlumeMass:
    """Measure the plume of a shot from existing snapshots of the flow."""
    frames = shot.frames
    emitted = shot.fire.smoke_made(_begin(shot), frames.last)
    looks = np.unique(
        np.linspace(1, frames.count, min(_MAX_SNAPSHOTS, frames.count)).round().astype(int)
    ).tolist()
    source = sources.select(shot)
    numbers = [source.snapshot(frame) for frame in looks]
    depths_of = [
        [_depths(domain, number) for number in numbers if domain.has(number)] for domain in source.domains
    ]  # domains, outermost first; a nest does not contain all of the plume
    if not depths_of or not depths_of[0]:
        return PlumeMass(emitted)
    deepest, wide = (max(depths[k] for depths_in in depths_of for depths in depths_in) for k in (0, 1))
    return PlumeMass(emitted, deepest, wide, max(depths[2] for depths in depths_of[0]))


def describe(shot: Shot) -> str:
    """Describe the smoke of a shot: mass, fuels and optical depth."""
    plume, mix = measure(shot), shot.fire.smoke
    shares = [
        f"{round(100.0 * share)} % {kind.name}"
        for kind, share in zip(emissions.KINDS, mix.shares, strict=True)
        if share >= 0.005
    ]
    fuel = shot.fire.fuel
    if not (np.any(fuel.surface > 0.0) or np.any(fuel.canopy > 0.0)):
        shares = ["its heat, as no fuel burns"]
    text = f"{_mass(plume.made)} of smoke in {_duration(shot)}, from {', '.join(shares)}"
    if plume.deepest is None:
        return text
    where, low, high, source = _PUBLISHED[bool(mix.dark > 0.75)]
    return (
        f"{text}; optical depth from above {plume.deepest:.2g} at most, {plume.wide:.2g} averaged over "
        f"1 km x 1 km, {plume.mean:.2g} over the plume (smoke {where}, spread: {low:g} to {high:g}, {source})"
    )


def _depths(domain: Domain, number: int) -> tuple[float, float, float]:
    """Compute optical depths of a snapshot: maximum of a column, over `_AVERAGING`, and the plume's mean."""
    depth = columns(domain, *snapshots.load_smoke(domain.snapshot_path(number)))
    side = max(1, round(_AVERAGING / domain.box.spacing))
    padded = np.pad(depth, [(0, -count % side) for count in depth.shape])
    blocks = padded.reshape(padded.shape[0] // side, side, padded.shape[1] // side, side)
    plume = depth[depth > _SMOKY]
    return float(depth.max()), float(blocks.mean(axis=(1, 3)).max()), float(plume.mean() if len(plume) else 0)


def columns(domain: Domain, low: tuple[int, int], smoke: NDArray[np.float32]) -> NDArray[np.float64]:
    """Compute the vertical optical depth (ny, nx) of smoke (nz, ny, nx), kg/m3, in a block from `low`."""
    (west, south), (_, rows, across) = low, smoke.shape
    thick = np.diff(domain.box.levels)[: len(smoke)]
    thinner = domain.thickness()[south : south + rows, west : west + across]
    return emissions.EXTINCTION * thinner * np.tensordot(thick, smoke.astype(np.float64), 1)


def _mass(kilograms: float) -> str:
    return f"{kilograms / 1000.0:,.3g} t" if kilograms >= 1000.0 else f"{kilograms:,.3g} kg"


def _begin(shot: Shot) -> float:
    """Return the model time (s) from which smoke counts: the first frame, or a still's spin-up."""
    first, last = shot.frames.first, shot.frames.last
    return first if last > first else first - shot.spin_up


def _duration(shot: Shot) -> str:
    still = shot.frames.last == shot.frames.first
    text = f"{(shot.frames.last - _begin(shot)) / 60.0:,.3g} min"
    return f"the {text} before the picture" if still else text
