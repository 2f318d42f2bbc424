"""Layers of the visible picture for compositors, scene-linear.

The EXR has 16-bit floats. Its R, G, B have no bloom, labels and signs. The layers add up, each as the camera
sees it:

- R, G, B = solid + fire + smoke
- solid = light_sun + light_sky + light_fire
- R, G, B x (1 - labels.A) + labels is the picture of `rgb`; `labels` exists if the scene has labels or signs
- the picture of `rgb` + bloom is the one to which the view transform is applied

`solid` and `fire` are already dimmed by the smoke in front of them. `smoke.A` is 1 - transmittance of the
smoke before the surface, and `A` is 1 - share of the sky. `fire` includes soot in flames; its blue can be
slightly negative, because colours of flames are outside of Rec.709. `light_fire` is the light of flames on
surfaces, and embers; `light_sky` includes haze. The denoised surfaces are divided by the shares of the noisy
light groups. Shares are averaged over 3 x 3 pixels, but not the share of embers.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from ..shot.passes import MarchedPass
from . import rgb

ORDER = 11
HELP = "Layers of the visible picture for compositors: flames, smoke, solid, lights and bloom, 16-bit EXR"

PASS = MarchedPass(
    files=("exr",),
    aspects=rgb.PASS.aspects,
    code=("passes/rgb.py",),
    light_groups=("Firetwin Sun", "Firetwin Firelight"),
    aovs=("Firetwin Glow",),
    bloom=True,
    bits=16,
    comments="R, G, B = solid + fire + smoke; solid = light_sun + light_sky + light_fire; "
    "bloom and labels are not in R, G, B",
)


def march(eye: Any, _frame: int) -> dict[str, NDArray]:
    """Return the layers, and the alphas."""
    sun, sky, fire = eye.split_light()
    text = {} if eye.text is None else {"labels.": eye.text[..., :3], "labels.A": eye.text[..., 3:]}
    return {
        "": eye.composed.picture,
        "A": eye.solid_share[..., None],
        "fire.": eye.composed.fire,
        "smoke.": eye.composed.smoke,
        "smoke.A": eye.smoke_opacity[..., None],
        "solid.": eye.composed.solid,
        "light_sun.": sun,
        "light_sky.": sky,
        "light_fire.": fire,
    } | text
