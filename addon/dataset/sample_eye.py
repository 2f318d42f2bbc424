"""Eye of a sample: all maps of a picture from one render of its surfaces and one march of its smoke."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
from firetwin_core import sensor, volume
from numpy.typing import NDArray

from ..geometry.grids import dilate
from ..passes import masks
from ..render import composite, smoke_range
from ..render.eye import Eye
from ..scene.smoke import illumination
from ..shot.cameras.pixel_rays import SKY
from ..shot.sections.thermal import BANDS

Array = NDArray[np.float32]

_MIDDLE = ((0.5, 0.5),)  # one marched ray in a pixel: smoke is smooth within four pixels
_WHITE = 1.2  # as in `render.eye`
_OPAQUE = 0.05  # transmittance below which smoke can hide all flames
_CLEAR = 0.999  # transmittance above which infrared smoke is not marched


class Light(NamedTuple):
    """Radiance maps (h, w, 3), and transmittance of smoke (h, w)."""

    picture: Array
    twin: Array
    smoke: Array
    fire: Array
    twin_fire: Array
    clear: Array


class SampleEye(Eye):
    """Eye that computes the maps of a sample."""

    def __init__(self, *arguments: Any, **more: Any) -> None:
        super().__init__(*arguments, **more)
        if self.flames is None:  # flames need the short steps of films
            self.step = smoke_range.STEP

    def light(self) -> Light:
        """Compute the picture with smoke and without, and their parts."""
        rendered = self._surfaces()
        at = composite.taps(rendered)
        marched = self._march_taps(at, True, _MIDDLE)
        self.clear = marched[..., 3].mean(axis=-1)
        composed = self._compose(rendered, at, marched)
        clear = 1.0 - composite.smoke_opacity(rendered, at, marched)
        if not self.smoke:
            self.has_smoke_or_flames = _around(composed.fire.max(axis=-1) > 0.0)
            picture, fire = composed.picture, composed.fire
            return Light(picture, picture, composed.smoke, fire, fire, clear)
        twin = self._compose(rendered, at, self._march_flames(at, marched))
        self.has_smoke_or_flames = _around((clear < _CLEAR) | (twin.fire.max(axis=-1) > 0.0))
        return Light(composed.picture, twin.picture, composed.smoke, composed.fire, twin.fire, clear)

    def _march_flames(self, at: Array, marched: Array) -> Array:
        """March flames without smoke, where the march of both (h, w, taps, 8) met flames or opaque smoke."""
        clear_march = np.zeros_like(marched)
        clear_march[..., 3::4] = 1.0
        if self.flames is None:
            return clear_march
        met = (marched[..., 4:7] != 0.0).any(axis=-1) | (marched[..., 7] < _OPAQUE)
        chosen = _around(met.any(axis=-1))
        if chosen.any():
            rays = self.rays
            clear_march[chosen] = self._march(
                [], rays.origins, rays.directions[chosen], at[chosen], parts=True
            )
        return clear_march

    def _compose(self, rendered: composite.Surfaces, at: Array, marched: Array) -> composite.Layers:
        white = 2.0**-self.stage.scene.view_settings.exposure
        composed = composite.compose(rendered, at, marched, white if self.flames else None)
        return composite.soften_highlights(composed, _WHITE * white) if self.flames else composed

    def kelvin(self) -> Array:
        """Compute the brightness temperature (h, w), K."""
        table = sensor.PlanckTable(BANDS[self.shot.settings.thermal.band])
        return table.brightness_temperature(self.radiance(1)).astype(np.float32)


def _around(chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Widen a mask (h, w) by pixels in which the rays between the first ones meet the same flames."""
    return dilate(chosen, 2)


class CentreEye(SampleEye):
    """Eye whose surfaces were rendered by one ray through the centre of each pixel."""

    @functools.cached_property
    def depth(self) -> Array:
        """Planar depth (h, w), m; inf for the sky."""
        depth = self.channels["Depth"][..., 0]
        return np.where(depth < SKY, depth, np.inf).astype(np.float32)

    @property
    def range(self) -> Array:
        """Distance (h, w), m; inf for the sky."""
        return np.where(np.isfinite(self.depth), self.distance, np.inf).astype(np.float32)

    def classes(self, clear: Array) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.int32]]:
        """Return class, class behind smoke, and instance (h, w), from the transmittance (h, w) of smoke."""
        pixels, clear = self.channels["Combined"].copy(), clear.copy()
        if self.flames:
            ends, burning = self._flames_before(self.distance.copy())
            pixels[burning] = 0.0, 1.0, masks.FIRE
            clear[burning] = self._transmittance(burning, ends)
        surface, instance, _, _ = masks.classes(pixels)
        shown = np.where(clear > 1.0 - masks.HIDES, surface, masks.SMOKE)
        return shown.astype(np.uint8), surface.astype(np.uint8), instance.astype(np.int32)

    def _transmittance(self, chosen: NDArray[np.bool_], ends: Array) -> Array:
        """Return the transmittance (n,) of smoke up to distances (h, w), m, of chosen pixels (h, w)."""
        if not (self.smoke and chosen.any()):
            return np.ones(int(chosen.sum()), np.float32)
        rays = self.rays
        lines = rays.origins, rays.directions[chosen], ends[chosen]
        depth = volume.optical_depth(self.smoke, *lines, smoke_range.STEP)
        return np.exp(-depth * illumination.extinction_factor(self.stage)).astype(np.float32)
