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
light groups.
"""

from __future__ import annotations

from ..shot.passes import MarchedPass
from . import rgb

ORDER = 11
HELP = "Layers of the visible picture for compositors: flames, smoke, solid, lights and bloom, 16-bit EXR"

PASS = MarchedPass(
    name="comp",
    files=("exr",),
    aspects=rgb.PASS.aspects,
    code=("passes/rgb.py",),
)
