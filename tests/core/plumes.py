"""Plumes of steady sources, for the flow's tests and benchmarks: as Briggs has them."""

import numpy as np
from firetwin_core import flow

CP, GRAVITY = 1004.7, 9.80665
THETA = 300.0
ENTRAINMENT = 0.6  # Briggs' beta: a bent plume's radius over its rise


def still_air(shape, spacing, lid, depth, gradient, wind, **options):
    """Air of one stability, `gradient` K/m, and one wind east, m/s; levels of about 0.6 of the spacing."""
    levels = np.linspace(0, lid, round(lid / depth) + 1)
    return flow.Solver(
        levels, shape, spacing, [0.0, lid], [THETA, THETA + gradient * lid], [[wind, 0.0]] * 2, **options
    )


def power_of(flux, solver):
    """Heat, W, of a buoyancy flux F (m4/s3, Briggs': without pi)."""
    return flux * np.pi * CP * solver.density[0] * THETA / GRAVITY


def disc(radius):
    """Places (n, 2) 25 m apart within `radius` of the origin."""
    grid = np.arange(-radius, radius + 1, 25.0)
    places = np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2)
    return places[np.hypot(*places.T) <= radius]


def middles(solver):
    return 0.5 * (solver.levels[1:] + solver.levels[:-1])


def bent(spacing, wind=10.0, gradient=0.01, rise=1000.0, depth=90.0, radius=0.0):
    """Mean height of a plume's smoke over what Briggs says, and the account of its smoke.

    A steady source, a point or a disc of `radius` m, in a uniform wind and stable air; smoke from 2.5 to
    4.5 km downwind. The final rise is 2.6 (F / (U s))^(1/3). The source is a cell wide, or the disc, and
    about 2 x `depth` high, so the plume begins with the radius of that area, R0, at the height `depth`, and
    (z + R0 / beta)^3 = rise^3 + (R0 / beta)^3 (Briggs 1984).
    """
    shape = (round(4000 / spacing), round(7600 / spacing))
    solver = still_air(
        shape, spacing, 2400.0, 60.0 * max(1.0, spacing / 100), gradient, wind, source_depth=depth
    )
    stability = GRAVITY / THETA * gradient
    x = (round(1800 / spacing) + 0.5) * spacing
    y = (shape[0] // 2 + 0.5) * spacing
    power = power_of((rise / 2.6) ** 3 * wind * stability, solver)
    place = disc(radius) + np.array([x, y])
    n = len(place)
    solver.set_sources(place, np.full(n, power / n), np.full(n, 10.0 / n))
    solver.step(0.05 * spacing, round(700 / (0.05 * spacing)))
    start = np.sqrt(2 * depth * max(spacing, 2 * radius) / np.pi) / ENTRAINMENT
    expected = (rise**3 + start**3) ** (1 / 3) - start + depth
    downwind = (np.arange(shape[1]) + 0.5) * spacing - x
    smoke = solver.smoke()[:, :, (downwind > 2500) & (downwind < 4500)].sum((1, 2), dtype=float)
    smoke *= np.diff(solver.levels)
    return np.sum(smoke * middles(solver)) / smoke.sum() / expected, solver.mass()
