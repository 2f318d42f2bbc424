"""Estimate of the smoke before flames: straight plumes of all ground that burned in the last minutes.

It takes milliseconds, where a coarse flow takes a minute, and it only ranks cameras.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...run import burning
from ...shot.fire import emissions
from ...shot.shot import Shot

_SMOKE = 0.02  # kg of PM2.5 per kg of fuel (as `emissions.PLAIN`)
_CALM = 1.0  # m/s, least wind that carries smoke
_WIDTH = (
    60.0,
    0.25,
)  # m, standard deviation of a plume's width at its source, and its growth over the distance
_DEPTH = (250.0, 0.4)  # m, the same of its vertical depth (both assumed, of a neutral surface layer)
_REACH = 5000.0  # m, farther smoke is aloft
_SAMPLES = 12  # along a line of sight

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plume:
    """Smoke of n burning cells.

    Attributes
    ----------
    place
        (n, 2) m in the scene.
    rate
        (n,) m2/s, extinction cross-section of the smoke that a cell emits.
    wind
        (2,) m/s.
    """

    place: Array
    rate: Array
    wind: Array

    @classmethod
    def of_shot(cls, shot: Shot) -> Plume:
        """Return the smoke at the first frame of a shot."""
        ground, fields, now = shot.bare_ground, shot.bare_ground.fields, shot.frames.first
        row, column = np.nonzero(
            (ground.burned >= 0.5) & (ground.arrival <= now) & (ground.arrival > now - burning.BURN_TIME)
        )
        place = ground.point(*ground.places(row, column))[:, :2] if len(row) else np.empty((0, 2))
        fuel = fields.surface_fuel[row, column] + fields.canopy_fuel[row, column]
        rate = emissions.EXTINCTION * _SMOKE * fuel * float(np.prod(ground.cell)) / burning.BURN_TIME
        return cls(place, rate, np.array(shot.wind))

    def depth(self, eye: Array, target: Array) -> float:
        """Estimate the optical depth along the ground from a camera to its target, (2,) m in the scene."""
        speed = max(float(np.hypot(*self.wind)), _CALM)
        wind = self.wind / speed
        part = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        away = (eye + part[:, None] * (target - eye))[:, None] - self.place
        along = away @ wind
        across = away[..., 0] * wind[1] - away[..., 1] * wind[0]
        lee = np.clip(along, 0.0, None)
        width, high = (least + growth * lee for least, growth in (_WIDTH, _DEPTH))
        shape = np.exp(-0.5 * (across / width) ** 2) * (along > 0.0) * (along < _REACH)
        density = (self.rate / speed * shape / (np.sqrt(2.0 * np.pi) * width * high)).sum(axis=1)
        return float(density.mean() * np.hypot(*(target - eye)))
