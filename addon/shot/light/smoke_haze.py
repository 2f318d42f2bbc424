"""Air near the ground: haze of a dry day and smoke of distant fires, as one exponential layer.

Smoke comes from a forecast or a monitor as PM2.5 at the ground. Its extinction is `emissions.EXTINCTION`
times its density: 4 m2/g. Medians measured in 27 plumes are 3.3 to 7.4 m2/g (scattering in green light;
Marsavin et al. 2023, doi 10.1039/d2ea00118g), so the visual range has the same uncertainty.
"""

from __future__ import annotations

import numpy as np
from firetwin_core.run import Run

from ..fire.emissions import EXTINCTION
from ..sections.light import Light
from . import sky

_MICROGRAM = 1e-9  # kg

Layer = tuple[float, float]
"""Extinction at z = 0, 1/m, and scale height, m."""


def dry_day(light: Light) -> Layer:
    """Return the layer of dust and moisture near the ground."""
    return sky.HAZE * light.haze * sky.LOW_HAZE, sky.LOW_HEIGHT


def smoke(light: Light, ground: float) -> Layer:
    """Return the layer of smoke, whose density is given at the height `ground`, m."""
    height = light.smoke_height
    return extinction(light.smoke) * float(np.exp(ground / height)), height


def extinction(density: float) -> float:
    """Convert a density of smoke (ug/m3) to extinction, 1/m."""
    return EXTINCTION * _MICROGRAM * density


def near_ground(light: Light, ground: float) -> Layer:
    """Combine both layers into one: exact at the ground, and in the optical depth above it."""
    dry, smoky = dry_day(light), smoke(light, ground)
    if smoky[0] == 0.0:
        return dry
    at_ground = [each[0] * float(np.exp(-ground / each[1])) for each in (dry, smoky)]
    total = sum(at_ground)
    height = (at_ground[0] * dry[1] + at_ground[1] * smoky[1]) / total
    return total * float(np.exp(ground / height)), height


def smoke_depth(light: Light) -> float:
    """Return the optical depth of the smoke above the ground."""
    return extinction(light.smoke) * light.smoke_height


def ground_height(run: Run) -> float:
    """Return the mean elevation of a run, m."""
    return float(np.nanmean(run.elevation))
