"""Forecast split pass: the pictures of all runs side by side, with the ground tinted as in `forecast`.

Each run is a member of the forecast, such as the typical, the smallest, the largest and the outlier. Each
part names its member with its roles and the area that it has burned, and draws its front. Colours are the
same in all parts: the number of members that have burned the ground. `split` has no colours.
"""

from __future__ import annotations

from . import ComparisonPass

PASS = ComparisonPass(
    name="forecast_split",
    order=78,
    help="Split screen of all [[runs]], with the ground tinted by the members that burned",
    files=("png",),
    film=True,
    captions=False,
    single_view=True,
    aspects=frozenset({"time", "camera", "film", "picture", "terrain", "forecast"}),
    code=("run/ensemble",),
    needs=("rgb", "depth", "comp"),
    needs_of_all=("rgb", "depth", "comp"),
)
