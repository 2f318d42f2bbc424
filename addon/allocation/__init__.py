"""Suggested allocation of resources to divisions of a run's front. Exercise: not operational advice.

After Donovan and Rideout (2003), An integer programming model to optimize resource allocation for wildfire
containment, Forest Science 49(2):331-335: the chosen resources build at least as much line as the length of
the front at the hour of containment, at minimum cost and loss. The front comes from the run, and suppression
does not affect it.

`control_line` generalises the front, `divisions` divides it, `resources` and `read` provide the resources,
`problem` converts both to arrays, `containment` and `nearest` solve with SciPy, `shortfall` finds the reasons
if there is none, `page` prints the result, `map_layer` writes it as GeoJSON.
"""

from __future__ import annotations

RADIUS = 500.0
"""Radius (m) of the bays and gaps of the front that are closed, by eye: with 1,000 m the lines of most
divisions of the sample run are less than 6 % shorter."""
INDIRECT = 100.0
"""Distance (m) of the line from the fire's edge, assumed."""

LIMITS = (
    "suppression does not affect the fire of the run: its front grows as if nobody fought it",
    "a line holds once built, on any ground, by day and night; fatigue, rest and relief are not modelled",
    "air resources count only by the line rate in the file; drops and water are not modelled",
)
