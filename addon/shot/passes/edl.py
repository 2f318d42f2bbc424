"""Eye-dome lighting of the visible picture: pixels behind their neighbours are darkened, to show shape.

The FIRETWIN paper uses it without its parameters; strength and radius are chosen by eye.
"""

from __future__ import annotations

from . import DerivedPass

PASS = DerivedPass(
    name="edl",
    order=40,
    help="Visible picture with eye-dome lighting from depth",
    files=("png",),
    film=True,
    needs=("rgb", "depth"),
)
