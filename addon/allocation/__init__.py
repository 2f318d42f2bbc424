"""Suggested allocation of resources to divisions of a run's front. Exercise: not operational advice.

After Donovan and Rideout (2003), An integer programming model to optimize resource allocation for wildfire
containment, Forest Science 49(2):331-335: resources are chosen so that the line that they build is at least
as long as the front at the hour of containment, at the least cost and loss. The front is the run's, which
does not feel the suppression.

`divisions` reads the front, `resources` says what is read of a resource, `problem` makes arrays of both,
`containment` and `nearest` solve with SciPy, `shortfall` says why there is no answer, `page` prints it.
"""

from __future__ import annotations

LIMITS = (
    "the run's fire does not feel suppression: its front grows as if nobody fought it",
    "line holds once it is built, on any ground and by day and night; nobody tires, rests or is relieved",
    "air resources count only by the line rate that their list gives; drops and water are not modelled",
)
