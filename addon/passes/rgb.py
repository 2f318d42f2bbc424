"""Visible picture: display-referred PNG with lens bloom, and scene-linear EXR without it."""

from __future__ import annotations

from ..shot.passes import SURFACES, RenderedPass

ORDER = 10
HELP = "Visible picture"

PASS = RenderedPass(
    files=("png", "exr"),
    shading="light",
    channels="colour",
    bits=16,
    film=True,
    shares_rays=True,
    aspects=SURFACES | {"fire", "smoke", "light", "grain", "colour", "labels"},
)
