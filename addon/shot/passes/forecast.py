"""Forecast pass: the visible picture of one member, and how many members have burned the ground by now.

Ground that members have burned has one of at most five colours, by their number. Lines are the fronts of
other members at the same time; the outlier, the smallest and the largest have labels. Both follow the
ground below each pixel, from depth, with the fronts of the scores, so hills hide them. They fade under
smoke as the ground itself does, and flames stay in front (see `comp`). Hatched ground was not simulated by
all members that reach this time. Places have names, and the number of members that have burned them.
Captions name the member, the fire model, and the issue and valid times. Colours do not depend on the time
or on the member.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="forecast",
    order=76,
    help="Visible picture of one member, with fronts of others, and ground tinted by the members that burned",
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=frozenset({"time", "camera", "film", "picture", "terrain", "forecast"}),
    code=("run/ensemble",),
    needs=("rgb", "depth", "comp"),
)
