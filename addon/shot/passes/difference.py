"""Difference pass: ground burned in one run and not in another, as tint over the visible picture.

The first run's picture in grey is tinted where the visible ground, from depth, has burned: in both runs, in
the first only, or in the other only. Fronts match the scores: interpolated linearly between cell centres.
Ground outside of a run's grid stays grey, as its state is unknown. Smoke does not occlude the tint. Two or
three other runs have a part of the picture each (see `split`), compared with the first.
"""

from __future__ import annotations

from . import ComparisonPass

PASS = ComparisonPass(
    name="difference",
    order=75,
    help="Visible picture, tinted where burned areas of the first run and of other [[runs]] differ",
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "picture", "terrain"}),
    needs=("rgb", "depth"),
)
