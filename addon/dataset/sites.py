"""Towers of a run: fixed cameras on high ground around the fire, from which several samples are taken."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .hashing import share
from .plan import Plan
from .run_scene import TREE, RunScene

_CANDIDATES = 12  # points per tower, of which the highest ground is chosen (assumed)
_SECTOR = 40.0  # degrees, width of the sector of the candidates of a tower (assumed)
_AROUND = [(0.0, 0.0), (60.0, 0.0), (-60.0, 0.0), (0.0, 60.0), (0.0, -60.0)]
"""Points around a tower at which trees count, m (assumed)."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tower:
    """Tower: name, and position (3,) of its camera in the run's local frame, m."""

    name: str
    position: Array


def towers(plan: Plan, name: str, scene: RunScene) -> list[Tower]:
    """Place the towers of a run.

    Their distances from the middle of the burned ground follow the distribution `distance_tower`, one tower
    in each equal part of it. Their bearings are random. In a forest the mast stands out above the trees.
    """
    middle = scene.burned.mean(axis=0) if len(scene.burned) else np.zeros(3)
    placed = []
    for site in range(plan.sites):
        label = f"tower {name} {site}"

        def value(what: str, number: int = 0, label: str = label) -> float:
            return share(plan.seed, 0, number, f"{label} {what}")

        part = (site + value("distance")) / plan.sites
        distance = plan.draws["distance_tower"].quantile(part)
        bearing = 360.0 * value("bearing")
        turns = [bearing + _SECTOR * (value("sector", k) - 0.5) for k in range(_CANDIDATES)]
        angles = np.radians(turns)
        east, north = middle[0] + distance * np.sin(angles), middle[1] + distance * np.cos(angles)
        up = scene.ground.up(east, north)
        around = [scene.trees(east + x, north + y) for x, y in _AROUND]
        trees = np.where(np.any(around, axis=0), TREE, 0.0)
        best = int(np.argmax(up - trees))
        mast = plan.draws["mast"].quantile(value("mast")) + trees[best]
        placed.append(Tower(f"tower-{site + 1}", np.array([east[best], north[best], up[best] + mast])))
    return placed
