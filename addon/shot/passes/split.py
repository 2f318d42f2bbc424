"""Split screen pass: all runs' visible pictures at one time, with names, burned area and front colours.

Two runs have a half each, with the central half of their pictures: the same landscape in both. Three or four
have a quarter each, with the complete picture at half size.
"""

from __future__ import annotations

from . import ComparisonPass

PASS = ComparisonPass(
    name="split",
    order=70,
    help="Split screen: the pictures of all [[runs]] side by side, with names and time",
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "picture"}),
    needs_of_all=("rgb",),
)
