"""Temperature of solved smoke as OpenVDB volumes, on cubic voxels as wide as the cells of the flow.

The cells of a flow follow the terrain; its levels flatten towards the top of the box. The temperature is the
standard atmosphere's plus the flow's excess temperature, as in volumes of a model's smoke.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from ..shot.shot import Shot
from ..smoke import snapshots
from ..smoke.domains import Domain
from ..smoke.sources import Source
from .scene_content import SmokeLayer

LEAST = 0.5
"""K, excess temperature below which nothing is stored."""
_SEA_LEVEL, _LAPSE = 288.15, 0.0065  # K, K/m of the standard atmosphere (ISO 2533)


def write(source: Source, layers: list[SmokeLayer], folder: Path) -> None:
    """Write the temperature of all frames of a flow's layers, one for each domain, and enter the files."""
    folder.mkdir(exist_ok=True)
    for layer, domain in zip(layers, source.domains, strict=True):
        for frame in layer.files:
            number = source.snapshot(frame)
            if domain.has(number):
                path = folder / f"temperature_{layer.name}_{frame:06d}.vdb"
                _write_domain(domain, number, path, source.shot)
                layer.temperature[frame] = path


def _write_domain(domain: Domain, number: int, path: Path, shot: Shot) -> None:
    (west, south), excess = snapshots.load_field(domain.snapshot_path(number), "temperature_excess")
    rows, columns = excess.shape[1:]
    block = slice(south, south + rows), slice(west, west + columns)
    levels, spacing = np.array(domain.box.levels), domain.box.spacing
    middles = (0.5 * (levels[1:] + levels[:-1]))[: len(excess)]
    ground, thickness = domain.ground[block], domain.thickness()[block]
    height = np.arange(float(ground.min()), float(ground.max() + middles[-1]), spacing)
    dense = resample(np.maximum(excess.astype(np.float32), 0.0), middles, ground, thickness, height)
    corner = np.array(domain.box.corner) + (np.array([west, south]) + 0.5) * spacing
    air = (_SEA_LEVEL - _LAPSE * height)[:, None, None]
    values = np.where(dense > LEAST, dense + air, 0.0).astype(np.float32)
    values = np.ascontiguousarray(values.transpose(2, 1, 0))
    origin = (*map(float, corner), float(height[0]))
    volume.write(path, {"temperature": values}, spacing, origin, half=True, metadata={"run": shot.run.name})


def resample(
    excess: NDArray[np.float32],
    middles: NDArray[np.float64],
    ground: NDArray[np.float64],
    thickness: NDArray[np.float64],
    height: NDArray[np.float64],
) -> NDArray[np.float32]:
    """Interpolate a field of terrain-following cells (nz, rows, columns) at heights (m,); 0 outside of it.

    Parameters
    ----------
    middles
        (nz,) heights of the cells' centres above flat ground, m.
    ground, thickness
        (rows, columns) ground height, m, and depth of cells relative to flat ground.
    """
    resampled = np.zeros((len(height), *ground.shape), np.float32)
    row, column = np.indices(ground.shape)
    for index, level in enumerate(height):
        above = (level - ground) / thickness
        at = np.interp(above, middles, np.arange(len(middles)))
        low = np.minimum(at.astype(np.int64), max(len(middles) - 2, 0))
        part = (at - low).astype(np.float32)
        high = np.minimum(low + 1, len(middles) - 1)
        value = excess[low, row, column] * (1.0 - part) + excess[high, row, column] * part
        resampled[index] = np.where((above >= 0.0) & (above <= middles[-1]), value, 0.0)
    return resampled
