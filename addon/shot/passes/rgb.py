"""Visible picture: display-referred PNG with lens bloom, and scene-linear EXR without it."""

from __future__ import annotations

from . import RenderedPass

PASS = RenderedPass(
    name="rgb",
    order=10,
    help="Visible picture",
    files=("png", "exr"),
    shading="light",
    channels="colour",
    bits=16,
    film=True,
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
