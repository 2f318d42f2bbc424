"""A rendered sample: maps of each pixel, before sensor effects and labels.

All maps are (h, w), or (h, w, 3), of one camera. Classes, instances, depth and range belong to the ray
through the pixel's centre; the other maps are means over the pixel. Needs no Blender.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

Map = NDArray[np.float32]


@dataclass(frozen=True)
class SampleCamera:
    """The camera of a sample; it has no lens distortion.

    Attributes
    ----------
    to_world
        (4, 4) from camera axes (x right, y up, z backwards) to metres east, north and up of the run's origin.
    fx, fy, cx, cy
        Focal lengths and principal point, pixels; the centre of the first pixel is (0.5, 0.5).
    width, height
        Size of the picture, pixels.
    """

    to_world: NDArray[np.float64]
    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int


@dataclass(frozen=True)
class Rendered:
    """The maps of a sample.

    Attributes
    ----------
    rgb
        (h, w, 3) 0 to 1, the visible picture as displays take it (sRGB encoding, with the film's contrast).
    twin
        (h, w, 3) the same without smoke: surfaces, air and flames. Shadows of smoke on the ground remain.
    light, twin_light
        (h, w, 3) radiance of `rgb` and `twin`, linear Rec.709; 1 is white at `exposure` 0. Its only noise
        is the renderer's own.
    smoke_light
        (h, w, 3) radiance of the smoke alone. A smoke-free picture b becomes b * clear + smoke_light.
    exposure
        Stops: `rgb` shows `light` * 2^exposure.
    risen
        Stops of it by which the camera's exposure has risen in the dark.
    clear
        (h, w) transmittance of smoke in front of the surface, 0 to 1; the alpha of smoke is 1 - clear.
    smoke_range
        (h, w) m, distance at which half of the opacity of the smoke is reached; inf without smoke.
    classes, surface
        (h, w) uint8 class (see `passes.masks`), and the class behind the smoke. `surface` is fire also
        where smoke hides it: visible fire is classes == FIRE, amodal fire is surface == FIRE.
    instance
        (h, w) int32 number of the tree or building; 0: none.
    depth, range
        (h, w) m, planar depth and distance of the surface; inf for the sky.
    fire, twin_fire
        (h, w, 3) radiance of flames and firebrands, with smoke in front of them and without. Embers on the
        ground are not in it; `surface` has them.
    kelvin
        (h, w) brightness temperature in the thermal band, K, with air and smoke, without sensor noise.
    camera
        The camera.
    time
        UTC of the sample; `model_time` is the same in s of the run.
    facts
        Further values of the sample, as JSON represents them (sun, air, exposure, cost by part in s).
    """

    rgb: Map
    twin: Map
    light: Map
    twin_light: Map
    smoke_light: Map
    exposure: float
    clear: Map
    smoke_range: Map
    classes: NDArray[np.uint8]
    surface: NDArray[np.uint8]
    instance: NDArray[np.int32]
    depth: Map
    range: Map
    fire: Map
    twin_fire: Map
    kelvin: Map
    camera: SampleCamera
    time: datetime
    model_time: float
    risen: float = 0.0
    facts: dict[str, Any] = field(default_factory=dict)

    @property
    def alpha(self) -> Map:
        """Opacity (h, w) of smoke, 0 to 1."""
        return 1.0 - self.clear
