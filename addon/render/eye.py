"""One eye of a camera: surfaces rendered by Cycles, composited with ray-marched smoke and flames."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from firetwin_core import sensor, volume
from firetwin_core.flames import FlameVolume
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ..blender import nodes
from ..blender.owned import Stage
from ..geometry.grids import blur, dilate
from ..passes import masks
from ..scene import cell_distances, infrared, temperature
from ..scene.labels.material import COVER
from ..scene.smoke import illumination
from ..shot.sections.thermal import BANDS
from ..shot.shot import Shot
from ..smoke import shutter
from . import composite, flame_distance, opaque_smoke, rays, smoke_range
from .flame_distance import FlameCells
from .surfaces import Channels

Array = NDArray[np.float32]

_STEP = 0.5  # voxels, step of the ray march
_SPARSE, _HIDES = 16, 3.0  # pixels between rays; optical depth that transmits 5 % of light
_FARTHEST, _NEAREST, _TAPS = 2.0e4, 1.0e-3, 48  # m; nearest distance over the surface's; distances of masks
_THIN = 0.9  # transmittance of flames below which more detail may show that they are opaque
_WHITE = 1.2  # radiance times 2^exposure above which lenses spread light visibly (by eye)
_PLACES = ((0.25, 0.25), (0.75, 0.75))  # positions of the marched rays in a pixel, which are averaged
_MIDDLE = ((0.5, 0.5),)
"""The same for pixels without flames in the infrared, where smoke is smooth and nearly transparent."""
_EVERY, _EVEN = 2, 0.03  # pixels between rays of smoke in the infrared; relative range of distances around
_FINER_PLACES = tuple(((n + 0.5) / 5.0, (n * 2 % 5 + 0.5) / 5.0) for n in range(5))
"""The same for pixels with flames in the infrared, where flames are a hundred times brighter than ground."""
_HOT = 350.0  # K, hotter surfaces are burned ground or flames: no sunlit ground is
_AROUND = 2  # pixels by which these pixels extend beyond those with flames on the first rays


class Eye:
    """One eye of a camera at a frame of a scene.

    Parameters
    ----------
    number
        -1 for the left and 1 for the right eye of a stereo camera, or 0.
    smoke
        Smoke volumes of the frame.
    flames, outline
        Flames of the frame that are drawn as a volume, and the same with less detail, to find the pixels that
        show them; None if there are none.
    flame_cells
        Flames in each cell of the picture; None if surfaces do not know them.
    parts
        Keep the parts of the picture.
    """

    def __init__(
        self,
        shot: Shot,
        stage: Stage,
        channels: Channels,
        number: int,
        smoke: Sequence[volume.Bricks],
        flames: FlameVolume | None = None,
        outline: FlameVolume | None = None,
        flame_cells: FlameCells | None = None,
        parts: bool = False,
    ) -> None:
        self.shot, self.stage, self.channels = shot, stage, channels
        self.smoke, self.flames, self.outline = smoke, flames, outline
        self.step = _STEP
        self._burning: dict[str, Any] = {} if flames is None else {"flames": flames}
        self.number = number
        height, width = self.shape = next(iter(channels.values())).shape[:2]
        self._through = functools.partial(
            rays.pixel_rays, stage.evaluated(stage.scene.camera), stage.scene, height, width, number
        )
        self.rays = self._through()
        self._flame_distance = np.zeros(self.shape, np.float32)
        self._near_flames = np.ones(self.shape, bool)
        """Pixels (h, w) that may show flames."""
        if flame_cells is not None:
            self._flame_distance = flame_distance.of_pixels(flame_cells.distance, height, width)
            self._near_flames = flame_distance.of_pixels(flame_cells.lit, height, width)
        self.clear = np.ones(self.shape, np.float32)
        """Transmittance (h, w) of smoke, once `picture` has computed it."""
        self.parts = parts
        self.has_smoke_or_flames = np.ones(self.shape, bool)
        """Pixels (h, w) whose infrared rays are marched; a caller that knows more can set it."""
        # Parts of the picture for passes (see `shot.passes.MarchedPass`), once `picture` has computed them.
        self.composed: composite.Layers
        self.sharp: composite.Layers  # before `composite.soften_highlights`
        self.solid_share = self.smoke_opacity = self.clear
        self.text: Array | None = None

    def picture(self, text: Channels | None = None) -> Array:
        """Compute the radiance (h, w, 3) of surfaces, smoke, flames and `text`, which was rendered alone."""
        rendered = self._surfaces()
        at = composite.taps(rendered)
        marched = self._march_taps(at, self.parts or bool(self.flames))
        self.clear = marched[..., 3].mean(axis=-1)
        white = 2.0**-self.stage.scene.view_settings.exposure
        sharp = composed = composite.compose(rendered, at, marched, white if self.flames else None)
        if self.flames:
            composed = composite.soften_highlights(sharp, _WHITE * white)
        self.text = None if text is None else self._text_layer(rendered, at, text)
        if self.parts:
            self.sharp, self.composed, self.solid_share = sharp, composed, composite.solid_share(rendered)
            self.smoke_opacity = composite.smoke_opacity(rendered, at, marched)
        return composed.picture if self.text is None else composite.place_over(composed.picture, self.text)

    def split_light(self) -> tuple[Array, Array, Array]:
        """Split the solid surfaces of the picture into light (h, w, 3) of the sun, the sky and fire."""
        sun, firelight = (self.channels[f"Combined_{group}"] for group in (nodes.SUN, nodes.FIRELIGHT))
        solid, glow = self.sharp.solid, self.channels[nodes.GLOW]
        sun, sky, fire = composite.split_light(self._surfaces(), solid, sun, firelight, glow)
        if not self.flames:
            return sun, sky, fire
        white = _WHITE * 2.0**-self.stage.scene.view_settings.exposure
        spread = composite.softening(self.sharp.picture, white)
        return spread(sun), spread(sky), spread(fire)

    def _march_taps(self, at: Array, parts: bool, places: Sequence[tuple[float, float]] = _PLACES) -> Array:
        """March rays through `places` of each pixel to the taps (h, w, 3), m, and return their mean."""
        marched = np.zeros((*at.shape, 8 if parts else 4), np.float32)
        marched[..., 3::4] = not (self.smoke or self.flames)
        if not (self.smoke or self.flames):
            return marched
        near = self._near_flames if self.flames else np.zeros(self.shape, bool)
        self._march_chosen(marched, near, at, parts, places, burning=True)
        self._march_chosen(marched, ~near, at, parts, places, burning=False)
        return marched

    def _march_chosen(
        self,
        marched: Array,
        chosen: NDArray[np.bool_],
        at: Array,
        parts: bool,
        places: Sequence[tuple[float, float]],
        burning: bool,
    ) -> None:
        """March rays through `places` of chosen pixels (h, w), and set their means in (h, w, 3, n)."""
        if not chosen.any():
            return
        total = np.zeros((int(chosen.sum()), *marched.shape[2:]), np.float32)
        for weight, smoke, place in _marches(shutter.moments(self.smoke), places):
            lines = _chosen(self._through(at=place), chosen)
            total += np.float32(weight) * self._march(smoke, *lines, at[chosen], parts, burning)
        marched[chosen] = total

    def _march(
        self,
        smoke: Sequence[volume.Bricks],
        origins: NDArray[np.float64],
        directions: NDArray[np.float64],
        ends: Array,
        parts: bool = False,
        burning: bool = True,
    ) -> Array:
        """March rays through smoke and, if `burning`, flames, with the detail that pixels resolve."""
        pixel, more = self.rays.pixel, self._burning if burning else {}
        more = more | ({"parts": True} if parts else {})
        return volume.march(smoke, origins, directions, ends, self._light, self.step, pixel=pixel, **more)

    def _text_layer(self, rendered: composite.Surfaces, at: Array, text: Channels) -> Array:
        """Compute the layer (h, w, 4) of text, with the smoke and flames in front of it."""
        cover = np.clip(text[COVER][..., 0], 0.0, 1.0)
        weight, way, _ = np.moveaxis(text[nodes.FLAMES], -1, 0)
        known = weight > 0.0
        distance = self.rays.from_distance(np.divide(way, weight, out=np.zeros_like(way), where=known))
        front = np.zeros((*cover.shape, 4), np.float32)
        front[..., 3] = 1.0
        written = np.nonzero((cover > 0.0) & known)
        if (self.smoke or self.flames) and len(written[0]):
            origins = self.rays.origins if self.rays.origins.ndim == 1 else self.rays.origins[written]
            lines, ends = self.rays.directions[written], distance[written][:, None]
            marched = np.zeros((len(lines), 4), np.float32)
            for weight, smoke in shutter.moments(self.smoke):
                found = self._march(smoke, origins, lines, ends)
                marched += np.float32(weight) * found.reshape(-1, 4)
            front[written] = marched
        return composite.text_layer(rendered, at, (text["Combined"], cover, distance), front)

    def radiance(self, frame: int) -> Array:
        """Compute the infrared radiance (h, w) of surfaces, air, smoke and flames, W m-2 sr-1."""
        channels = self.channels
        bare = composite.infrared_radiance(
            channels[nodes.SURFACE],
            channels[nodes.FLAMES],
            channels[nodes.WARMTH][..., 0],
            self._clear_sky(frame),
        )
        hot = float(sensor.radiance(_HOT, BANDS[self.shot.settings.thermal.band]))
        bare = composite.average_hot(bare, self.stage.scene.cycles.samples, hot)
        if not (self.smoke or self.flames):
            return bare
        air = illumination.infrared_arguments(self.shot, self.stage, frame)
        burning, alight, within = air | self._burning, np.zeros(self.shape, bool), self.has_smoke_or_flames
        if self.flames and within.any():
            outline, near = air | {"flames": self.outline}, within & self._near_flames
            alight[near] = self._march_infrared([], near, _PLACES, outline)[:, 1] < 1.0
            alight = dilate(alight, _AROUND)
        marched = np.zeros((*self.shape, 2), np.float32)
        marched[..., 1] = 1.0
        plain = within & ~alight
        sparse = plain & self._is_even
        for chosen, places, met in ((plain & ~sparse, _MIDDLE, air), (alight, _FINER_PLACES, burning)):
            if chosen.any():
                marched[chosen] = self._march_infrared(self.smoke, chosen, places, met)
        if sparse.any():
            marched[sparse] = self._interpolated(sparse, air)[sparse]
        light, through = np.moveaxis(marched, -1, 0)
        return bare * through + light

    @functools.cached_property
    def _is_even(self) -> NDArray[np.bool_]:
        """Pixels (h, w) around which surfaces have nearly the same distance."""
        far, near = dilate(self.distance, _EVERY), -dilate(-self.distance, _EVERY)
        return np.asarray(far - near <= _EVEN * near)

    def _interpolated(self, sparse: NDArray[np.bool_], air: dict[str, Any]) -> Array:
        """Return infrared radiance and transmittance (h, w, 2), from a ray in every `_EVERY`-th pixel."""
        height, width = self.shape
        row, column = (np.unique(np.append(np.arange(0, side, _EVERY), side - 1)) for side in self.shape)
        grid = np.ix_(row, column)
        chosen = np.zeros(self.shape, bool)
        chosen[grid] = dilate(sparse, _EVERY)[grid]
        marched = np.zeros((*self.shape, 2), np.float32)
        marched[chosen] = self._march_infrared(self.smoke, chosen, _MIDDLE, air)
        down = np.interp(np.arange(height), row, np.arange(len(row)))
        right = np.interp(np.arange(width), column, np.arange(len(column)))
        values = np.ascontiguousarray(marched[grid])
        rows, columns = np.meshgrid(down, right, indexing="ij")
        return np.stack([bilinear(values[..., k], rows, columns) for k in (0, 1)], axis=-1)

    def _march_infrared(
        self,
        smoke: Sequence[volume.Bricks],
        chosen: NDArray[np.bool_],
        places: Sequence[tuple[float, float]],
        air: dict[str, Any],
    ) -> Array:
        """Return mean radiance and transmittance (n, 2) of chosen pixels (h, w) over places in each pixel."""
        total = np.zeros((int(chosen.sum()), 2), np.float32)
        for place in places:
            lines = _chosen(self._through(at=place), chosen)
            total += volume.march_infrared(smoke, *lines, self.distance[chosen], **air)
        return total / np.float32(len(places))

    def _clear_sky(self, frame: int) -> Array:
        """Infrared radiance (h, w) of the sky without smoke."""
        air = temperature.field(self.shot, float(self.shot.frames.times[frame - 1]))
        origin = self.rays.origins.reshape(-1, 3)[0]
        return infrared.clear_sky(self.shot, air, origin, self.rays.directions[..., 2]).astype(np.float32)

    def masks(self, pixels: Array) -> Array:
        """Add flames and smoke to the mask pixels (h, w, 3) of the surfaces, see `blender.nodes.mask_switch`.

        A pixel is fire if the flames before its surface transmit less than half of the light along its
        central ray. Smoke dims it up to the place where they do.
        """
        ends = self.distance.copy()
        pixels = pixels.copy()
        if self.flames:
            ends, burning = self._flames_before(ends)
            pixels[burning] = 0.0, 1.0, masks.FIRE
        if not self.smoke:
            return pixels
        factor = illumination.extinction_factor(self.stage)
        lines, most = _lines(self.rays), opaque_smoke.DEPTH / max(factor, 1.0e-6)
        depth = volume.optical_depth(self.smoke, *lines, ends.ravel(), smoke_range.STEP, most)
        return pixels * np.exp(-depth * factor).reshape(*self.shape, 1)

    def smoke_range(self, clear: Array) -> Array:
        """Measure the distance (h, w) of smoke of this transmittance (h, w), m (see `smoke_range`)."""
        if not self.smoke:
            return np.full(self.shape, np.inf, np.float32)

        def march(origins: NDArray[np.float64], directions: NDArray[np.float64], at: Array) -> Array:
            light, step = self._light, smoke_range.STEP
            return volume.march(self.smoke, origins, directions, at, light, step)[..., 3]

        return smoke_range.measure(self.rays.origins, self.rays.directions, self.distance, clear, march)

    def _flames_before(self, ends: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return the distances (h, w) up to opaque flames or `ends`, m, and a mask of the opaque flames."""
        first, burning, near = ends.copy(), np.zeros(self.shape, bool), self._near_flames.copy()
        reached = np.minimum(ends, _FARTHEST)[..., None]
        near[near] = self._through_flames(self.outline, near, reached[near])[:, 0] < _THIN
        at = reached[near] * np.geomspace(_NEAREST, 1.0, _TAPS)
        opaque = self._through_flames(self.flames, near, at) < masks.HIDES
        burning[near] = opaque[:, -1]
        first[near] = np.where(opaque[:, -1], at[np.arange(len(at)), opaque.argmax(axis=1)], first[near])
        return first, burning

    def _through_flames(self, flames: FlameVolume | None, chosen: NDArray[np.bool_], at: Array) -> Array:
        """Return the transmittance (n, taps) of flames up to distances (n, taps) in chosen pixels (h, w)."""
        lines = _chosen(self.rays, chosen)
        return volume.march([], *lines, at, self._light, _STEP, flames=flames)[..., 3]

    def hidden_by_near_smoke(self, near: float) -> float:
        """Estimate the share of the picture, 0 to 1, that is hidden by smoke nearer than `near` m."""
        if not self.smoke:
            return 0.0
        rays, every = self.rays, (slice(None, None, _SPARSE), slice(None, None, _SPARSE))
        directions = rays.directions[every].reshape(-1, 3)
        origins = rays.origins if rays.origins.ndim == 1 else rays.origins[every].reshape(-1, 3)
        depth = volume.optical_depth(self.smoke, origins, directions, np.full(len(directions), near), _STEP)
        return float((depth * illumination.extinction_factor(self.stage) > _HIDES).mean())

    @functools.cached_property
    def _light(self) -> volume.Illumination:
        """Light in smoke and haze."""
        if self.smoke:
            return illumination.visible_light(self.stage)
        return illumination.light_without_smoke(self.stage)

    @functools.cached_property
    def distance(self) -> Array:
        """Distances (h, w), m, of the surfaces at pixel centres."""
        return self.rays.from_depth(self.channels["Depth"][..., 0])

    def _surfaces(self) -> composite.Surfaces:
        channels = self.channels
        colour, surface = channels["Combined"], channels[nodes.SURFACE]
        red, way, _ = np.moveaxis(blur(channels[nodes.FLAMES]), -1, 0)
        far = np.where(red > 1.0e-4, way / np.maximum(red, 1.0e-9), 0.0)
        return composite.Surfaces(
            colour=colour,
            noisy=channels.get("Noisy Image", colour),
            fire=np.maximum(channels[f"Combined_{nodes.FIRE}"], 0.0),
            distance=self.distance,
            nearness=surface[..., 0],
            aside=self.rays.aside,
            solid=surface[..., 1],
            fire_distance=self.rays.from_distance(far),
            flame_distance=self._flame_distance,
            before=np.clip(channels[cell_distances.AOV][..., 0], 0.0, 1.0),
            rays=self.stage.scene.cycles.samples,
        )


def _marches(
    moments: Sequence[tuple[float, Sequence[volume.Bricks]]], places: Sequence[tuple[float, float]]
) -> Iterator[tuple[float, Sequence[volume.Bricks], tuple[float, float]]]:
    """Yield weight, smoke and position in the pixel of each march: several in a pixel, and of an exposure."""
    for number, (weight, smoke) in enumerate(moments):
        chosen = places if len(moments) == 1 else (places[number % len(places)],)
        yield from ((weight / len(chosen), smoke, place) for place in chosen)


def _chosen(lines: rays.Rays, chosen: NDArray[np.bool_]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return origins and directions of rays through chosen pixels (h, w)."""
    origins = lines.origins if lines.origins.ndim == 1 else lines.origins[chosen]
    return origins, lines.directions[chosen]


def _lines(lines: rays.Rays) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return origins and directions of rays, in the layout of `firetwin_core.volume`."""
    origins = lines.origins if lines.origins.ndim == 1 else lines.origins.reshape(-1, 3)
    return origins, lines.directions.reshape(-1, 3)
