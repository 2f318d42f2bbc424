"""Visible picture: display-referred PNG with lens bloom, and scene-linear EXR without it."""

from __future__ import annotations

from ..shot.passes import RenderedPass

ORDER = 10
HELP = "Visible picture"

PASS = RenderedPass(
    name="rgb",
    files=("png", "exr"),
    shading="light",
    channels="colour",
    bits=16,
    film=True,
    shares_rays=True,
    aspects=frozenset(
        {
            "time",
            "camera",
            "picture",
            "colour",
            "terrain",
            "forest",
            "fire",
            "smoke",
            "light",
            "grain",
            "labels",
            "stations",
        }
    ),
)
