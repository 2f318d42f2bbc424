"""Section [smoke]: smoke model, resolution and rendering of the smoke volume."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ... import plugins
from ..schema import key

_SOURCES = Path(__file__).parents[2] / "smoke" / "sources"
SMOKE_METHODS: dict[str, str] = plugins.declared(_SOURCES, "METHOD")
"""Help of the sources that a scene file can choose, by name, from modules that are not imported here."""


@dataclass(frozen=True)
class SmokeSettings:
    """The smoke volume."""

    enabled: bool = key(True, "draw the smoke")
    method: str = key(
        "flow",
        "smoke of a run without smoke fields",
        choices=SMOKE_METHODS,
    )
    spin_up: float | None = key(
        None,
        "spin-up before the first frame, in previews 0.6 of it; default: by size of the fire, 1800 for 15 km",
        unit="s",
        at_least=0,
        at_most=172_800,
    )
    cell_budget: float = key(
        3.0,
        "limit on flow cells solved per second of model time; more are finer and take longer",
        unit="millions",
        at_least=0.1,
        at_most=1000,
    )
    cloud_base: float = key(
        4200.0,
        "cloud base above sea level; condensation turns a flow's smoke white above it",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    voxel_size: float = key(
        0.0,
        "edge length of a voxel; 0: chosen by the distance of the nearest camera",
        unit="m",
        at_least=0,
        at_most=100_000,
    )
    draw: str = key(
        "integrated",
        "volume rendering",
        choices={"integrated": "ray march of solved smoke", "volume": "by Cycles, as F12 does"},
    )
    complete: bool = False  # volumes without culling and with all grids, for exports
