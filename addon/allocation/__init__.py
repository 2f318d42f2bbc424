"""Suggested allocation of resources to divisions of a run's front. Exercise: not operational advice.

After Donovan and Rideout (2003), An integer programming model to optimize resource allocation for wildfire
containment, Forest Science 49(2):331-335: the chosen resources build at least as much line as the length of
the front at the hour of containment, at minimum cost and loss. The front comes from the run, and suppression
does not affect it.

`divisions` divides the front, `resources` and `read` provide the resources, `problem` converts both to
arrays, `containment` and `nearest` solve with SciPy, `shortfall` finds the reasons if there is none, `page`
prints the result.
"""

from __future__ import annotations

LIMITS = (
    "suppression does not affect the fire of the run: its front grows as if nobody fought it",
    "a line holds once built, on any ground, by day and night; fatigue, rest and relief are not modelled",
    "air resources count only by the line rate in the file; drops and water are not modelled",
)
