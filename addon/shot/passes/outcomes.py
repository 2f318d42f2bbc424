"""Outcomes pass: the forecast pictures of all runs in turn, with hard cuts, as one film.

Each run is a member of the forecast. Its pictures are shown for 1.5 s, then the pictures of the next one,
at the running clock of the film; after the last comes the first. The bar at the top has a part for each
run, and the shown one is white; a counter names the member, its roles, and the area that it has burned. A
film of nearly one moment (`time.start` and `time.end` a minute apart) compares outcomes at this moment.
Draws of 0.4 s could be followed in studies, and 0.1 s were too short (Kale et al., 2019).
"""

from __future__ import annotations

from . import ComparisonPass

PASS = ComparisonPass(
    name="outcomes",
    order=77,
    help="Forecast pictures of all [[runs]] in turn, 1.5 s each, with hard cuts",
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=frozenset({"time", "camera", "film", "picture", "forecast"}),
    needs=("forecast",),
    needs_of_all=("forecast",),
)
