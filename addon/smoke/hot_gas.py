"""Hot gas of the fire: excess temperature of a solved flow. Needs no Blender."""

from __future__ import annotations

import numpy as np
from firetwin_core import volume

from ..shot.shot import Shot
from . import snapshots, sources
from .domains import Domain

ABSORPTION = 8.0e-6
"""1/(m K), absorption of combustion gases per kelvin of their excess temperature, between 8 and 14 um.

Gas that is 1200 K warmer than the air holds about 0.1 bar each of water vapour and of carbon dioxide, which
absorb about 0.1 per bar and metre in this window (assumed). Mixing with air reduces its excess temperature
and its absorption by one factor.
"""


def layers(shot: Shot, frame: int) -> list[volume.HotGas]:
    """Return the hot gas of a frame in all domains of its flow, the finest last; empty without a flow."""
    source = sources.select(shot)
    number = source.snapshot(frame)
    return [_gas(domain, number) for domain in source.domains if domain.has(number)]


def _gas(domain: Domain, frame: int) -> volume.HotGas:
    """Return the hot gas of a frame in a domain."""
    (west, south), excess = snapshots.load_field(domain.snapshot_path(frame), "temperature_excess")
    levels, rows, columns = excess.shape
    box = domain.box
    heights = domain.heights()[:levels, south : south + rows, west : west + columns]
    first = (np.array(box.corner) + (np.array([west, south]) + 0.5) * box.spacing).tolist()
    return volume.HotGas(np.maximum(excess.astype(np.float32), 0.0), heights, first, box.spacing)
