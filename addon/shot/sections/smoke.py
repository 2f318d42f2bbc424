"""Section [smoke]: smoke model, resolution and rendering of the smoke volume."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ... import plugins
from ..schema import key


class SmokeMethod(NamedTuple):
    """A choice of `smoke.method`.

    Attributes
    ----------
    history
        Key with the history that it needs before the first frame.
    solved
        True if the flow of the air is solved on cells.
    """

    help: str
    history: str
    solved: bool


_SOURCES = Path(__file__).parents[2] / "smoke" / "sources"
SMOKE_METHODS = {name: SmokeMethod(**each) for name, each in plugins.declared(_SOURCES, "METHOD").items()}
"""The sources of smoke that a scene file can choose, from their modules, which are not imported here."""


@dataclass(frozen=True)
class SmokeSettings:
    """The smoke volume."""

    enabled: bool = key(True, "draw the smoke")
    method: str = key(
        "flow",
        "smoke model for a run without smoke fields",
        choices={name: each.help for name, each in SMOKE_METHODS.items()},
    )
    spin_up: float | None = key(
        None,
        "spin-up of a flow before the first frame; default: by the size of the fire, 1800 for 15 km",
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
    max_age: float = key(5400.0, "age at which a puff is removed", unit="s", above=0, at_most=10_000_000)
    extinction: float = key(
        0.0,
        "upper limit of the extinction coefficient; smaller is faster, 0: chosen as voxel_size is",
        unit="1/m",
        at_least=0,
        at_most=10,
    )
    lighting: str = key(
        "solved",
        "illumination of solved smoke",
        choices={
            "solved": "once per frame",
            "traced": "by Cycles: noisier, sun can be moved",
        },
    )
    draw: str = key(
        "integrated",
        "volume rendering",
        choices={"integrated": "ray march of solved smoke", "volume": "by Cycles, as F12 does"},
    )
    complete: bool = key(False, "write smoke outside of all views too, and temperature and flame grids")
