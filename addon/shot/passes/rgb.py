"""The visible picture, with the bloom of a lens.

Written as PNG, as people look at it, and as EXR in linear light.
"""

from __future__ import annotations

from . import Pass

PASS = Pass(
    name="rgb",
    order=10,
    help="Visible picture",
    files=("png", "exr"),
    output="Image",
    data=False,
    channels="colour",
    bits=16,
    filmed=True,
    shows=frozenset(
        {"time", "camera", "picture", "terrain", "forest", "fire", "smoke", "light", "grain", "labels"}
    ),
)
