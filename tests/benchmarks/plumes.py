"""The flow against plume theory, in more winds, in calm air and on finer grids than the tests have time for.

    .venv/bin/python tests/benchmarks/plumes.py [--json]

Prints how high smoke rises over what theory says, and how well its mass adds up; two minutes on 2 cores.
Exits with 1 where a plume is outside of the bounds that are printed beside it.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "core"))
from plumes import bent, disc, middles, power_of, still_air

GRAVITY, THETA = 9.80665, 300.0


def unbalanced(mass: dict[str, float]) -> float:
    """Smoke that is neither in the air nor has left, over what was given off."""
    return abs((mass["airborne"] + mass["left"]) / mass["emitted"] - 1.0)


def calm() -> tuple[float, float]:
    """Top of a plume in calm air and height of the layer that it spreads into, over what theory says.

    5.0 F^(1/4) s^(-3/8), and 2.13 / 2.8 of that (Morton, Taylor and Turner 1956, "Turbulent gravitational
    convection from maintained and instantaneous sources"; the number is Briggs', 1969).
    """
    spacing, rise, gradient, radius, n = 75.0, 1500.0, 0.01, 150.0, 72
    solver = still_air(
        (n, n), spacing, 3000.0, 50.0, gradient, 0.0,
        source_depth=50.0, gust_strength=0.6, gust_size=100.0, gust_time=20.0, top=0.1,
    )  # fmt: skip
    place = disc(radius) + n * spacing / 2
    power = power_of((rise / 5.0) ** 4 * (GRAVITY / THETA * gradient) ** 1.5, solver)
    solver.set_sources(place, np.full(len(place), power / len(place)), np.full(len(place), 0.1))
    solver.step(0.05 * spacing, round(700 / (0.05 * spacing)))
    smoke = solver.smoke().sum((1, 2), dtype=float)
    share = np.cumsum(smoke * np.diff(solver.levels))
    top = float(np.interp(0.99, share / share[-1], solver.levels[1:]))
    return top / rise, float(middles(solver)[smoke.argmax()]) / (2.13 / 2.8 * rise)


def measured() -> dict[str, tuple[float, float, float]]:
    """Of each plume: what was found, and the bounds between which it has to be."""
    found = {}
    for wind in (6.0, 14.0):
        found[f"bent, {wind:.0f} m/s, over Briggs"] = bent(100.0, wind=wind, rise=800.0)[0], 0.85, 1.15
    by_grid = {spacing: bent(spacing, radius=150.0) for spacing in (200.0, 100.0, 50.0)}
    for (spacing, (ratio, mass)), most in zip(by_grid.items(), (0.2, 0.15, 0.15), strict=True):
        found[f"disc, cells of {spacing:.0f} m, over Briggs"] = ratio, 1.0 - most, 1.0 + most
        found[f"disc, cells of {spacing:.0f} m, mass amiss"] = unbalanced(mass), 0.0, 1e-6
    top, layer = calm()
    found["calm, top over Morton, Taylor and Turner"] = top, 0.85, 1.15
    found["calm, layer over Morton, Taylor and Turner"] = layer, 0.75, 1.25  # the source is not a point
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true")
    as_json = parser.parse_args().json
    result = measured()
    if as_json:
        print(json.dumps({name: value for name, (value, _, _) in result.items()}))
    else:
        for name, (value, low, high) in result.items():
            print(f"{name:44} {value:10.3g}   {low:g} to {high:g}")
    if any(not low <= value <= high for value, low, high in result.values()):
        sys.exit(1)


if __name__ == "__main__":
    main()
