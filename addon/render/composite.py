"""Composites ray-marched smoke over surfaces that Cycles rendered, in linear light. Needs no Blender.

Smoke is sampled at taps along each pixel's ray, which give the in-scattered radiance up to the tap, and the
transmittance. A pixel at a silhouette covers a near and a far surface. Its taps are the least and greatest
depth of its 3 x 3 neighbourhood. The coverage of the near surface is estimated from the mean nearness (1 /
distance) of the pixel's few rays, and from its neighbours. Flames have a separate tap.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.grids import blur, dilate
from ..shot.cameras.pixel_rays import SKY

Array = NDArray[np.float32]

_EDGE = 0.02  # smallest difference of transmittance across a silhouette
_REACH, _SAME_DEPTH = 2, 0.1  # pixels round an edge; relative depth tolerance of one surface
_GAP = 1.5  # of white: limit on the radiance of flames in gaps (by eye)
_BEHIND = 1.25  # distance behind flames over the distance at which half of their light is emitted (by eye)
_SOLID = 1.0e-6  # rounding of a share of all rays
_GAPS, _BEYOND = 0.01, 1.1  # least share of gaps that are seen; distance of a tap in the sky over `SKY`
_TOUCHES = 2.0e-3  # relative depth by which text may be behind a surface, such as the ground below it
_SURE = 15.0  # rays at which a pixel's coverage has the same weight as its neighbours'; estimated


@dataclass(frozen=True)
class Surfaces:
    """Surfaces that Cycles rendered for a picture (h, w), without smoke.

    Attributes
    ----------
    colour
        (h, w, 3) radiance of all light, denoised if the settings say so.
    noisy
        (h, w, 3) radiance before denoising.
    fire
        (h, w, 3) share of `noisy` from flames and firebrands.
    distance
        (h, w) m along the ray through the pixel's centre; over `SKY` where the ray meets no surface.
    nearness
        (h, w) mean of 1000 m over the distance of solid surfaces from the camera, 0 for the sky.
    aside
        (h, w) m, lateral offset of the rays' origins from the camera.
    solid
        (h, w) share of rays that met a surface whose material writes its distance.
    fire_distance
        (h, w) m, mean over the flames weighted by their light; 0: no flames.
    flame_distance
        (h, w) m, of the flames that are marched; 0 without any, or if `before` is not known.
    before
        (h, w) share of rays that met a surface nearer than these flames.
    rays
        Rays (samples) per pixel.
    """

    colour: Array
    noisy: Array
    fire: Array
    distance: Array
    nearness: Array
    aside: NDArray[np.float64]
    solid: Array
    fire_distance: Array
    flame_distance: Array
    before: Array
    rays: int


def taps(surfaces: Surfaces) -> Array:
    """Return sample distances of smoke (h, w, 3), m: near surface, far surface and flames."""
    near, far = -dilate(-surfaces.distance, 1), dilate(surfaces.distance, 1)
    # Gaps that no central ray meets show the flames too. A farther tap would see flames behind the ground.
    far = np.where(_extended(surfaces), _BEHIND * surfaces.flame_distance, far)
    far = np.where(_shows_sky(surfaces), np.maximum(far, np.float32(_BEYOND * SKY)), far)
    return np.stack([near, far, surfaces.fire_distance], axis=-1)


@dataclass(frozen=True)
class Layers:
    """A picture, and layers that add up to it, (h, w, 3) radiance each.

    Attributes
    ----------
    picture
        The sum of all layers.
    solid, fire
        Surfaces and flames, dimmed by the smoke in front of them.
    """

    picture: Array
    solid: Array
    fire: Array

    @property
    def smoke(self) -> Array:
        """Light of the smoke."""
        return self.picture - self.solid - self.fire


def compose(surfaces: Surfaces, distances: Array, marched: Array, white: float | None = None) -> Layers:
    """Composite surfaces and smoke.

    Parameters
    ----------
    distances
        (h, w, 3) m, as `taps` returns them.
    marched
        (h, w, 3, 8) at these distances, as `firetwin_core.volume.march` returns it with `parts`. Without
        (h, w, 3, 4), flames in the air count as smoke.
    white
        Radiance that is white in the picture, if the light of flames in gaps is to be softened.
    """
    share = _coverage(surfaces, distances)[..., None]
    smoke, through = marched[..., :3], marched[..., 3:4]
    flamelight = marched[..., 4:7] if marched.shape[-1] > 4 else np.zeros_like(smoke)
    near, far, flames = (through[:, :, k] for k in range(3))
    fire = _flame_light(surfaces)
    solid = surfaces.colour - fire
    behind = solid * (share * near + (1.0 - share) * far)
    smoky = marched[..., 7] if marched.shape[-1] > 7 else marched[..., 3]
    edge = (np.abs(smoky[:, :, 0] - smoky[:, :, 1]) > _EDGE) & ~_extended(surfaces)
    noisy = np.maximum(surfaces.noisy - surfaces.fire, 0.0)
    inner = _without_edges(solid, noisy, distances[..., 0], share[..., 0], edge)
    # At an edge in smoke the near surface takes the colour of its neighbours, because a denoiser mixes it
    # with distant light, such as fire behind smoke. Flames that are marched are not in that colour.
    split = share * inner * (near - far) + solid * far
    behind = np.where(edge[..., None], split, behind)
    flaming = (1.0 - share) * (flamelight[:, :, 1] - flamelight[:, :, 0])
    veil = smoke - flamelight
    gaps = (1.0 - share) * (veil[:, :, 1] - veil[:, :, 0]) + flaming
    light = smoke[:, :, 0] + gaps
    burning = flamelight[:, :, 0] + flaming
    if white is not None:
        excess = gaps * _share_of_flames(gaps)
        limited = _limited(excess, share, _GAP * white) - excess
        light += limited
        burning = np.maximum(burning + limited, np.minimum(burning, 0.0))  # blue of flames is negative
    surface = np.maximum(behind + fire * flames, 0.0)
    cards = np.minimum(fire * flames, surface)
    found = surface + light, surface - cards, cards + burning
    return Layers(*(each.astype(np.float32) for each in found))


def smoke_opacity(surfaces: Surfaces, distances: Array, marched: Array) -> Array:
    """Return 1 - transmittance (h, w) of smoke in front of the surfaces; arguments as in `compose`."""
    share = _coverage(surfaces, distances)
    near, far = marched[:, :, 0, 7], marched[:, :, 1, 7]
    return (1.0 - (share * near + (1.0 - share) * far)).astype(np.float32)


def solid_share(surfaces: Surfaces) -> Array:
    """Return the share (h, w) of the pixel that surfaces cover, and not the sky."""
    return np.where(_is_unknown(surfaces), 1.0, np.clip(surfaces.solid, 0.0, 1.0)).astype(np.float32)


def split_light(
    surfaces: Surfaces, solid: Array, sun: Array, firelight: Array, glow: Array
) -> tuple[Array, Array, Array]:
    """Split the layer of solid surfaces into light of the sun, sky and fire, which add up to it.

    The shares of reflected light are noisy, and are averaged over 3 x 3 pixels. Those of embers have no
    noise, and differ from pixel to pixel.

    Parameters
    ----------
    solid
        (h, w, 3), before `soften_highlights`.
    sun, firelight
        (h, w, 3) parts of the noisy light: of the sun, and of flames on surfaces.
    glow
        (h, w, 3) radiance of embers and flames on surfaces, in the noisy light.
    """
    reflected = np.maximum(blur(np.maximum(surfaces.noisy - surfaces.fire - glow, 0.0)), 1.0e-6)
    glow = np.maximum(glow, 0.0)
    embers = solid * glow / (glow + reflected)
    sun, fire = (np.clip(blur(each) / reflected, 0.0, 1.0) for each in (sun, firelight))
    rest = (solid - embers) / np.maximum(sun + fire, 1.0)
    sun, fire = rest * sun, rest * fire + embers
    return sun, solid - sun - fire, fire


def text_layer(surfaces: Surfaces, distances: Array, text: tuple[Array, Array, Array], front: Array) -> Array:
    """Compute the layer of text (h, w, 4): radiance times alpha, and alpha; nearer surfaces hide it.

    Parameters
    ----------
    distances
        (h, w, 3) m, as `taps` returns them.
    text
        Radiance (h, w, 3) times coverage, coverage (h, w), 0 to 1, and distance (h, w), m. None is denoised.
    front
        (h, w, 4) radiance of the smoke in front of the text, and its transmittance.
    """
    light, cover, distance = text
    share = _coverage(surfaces, distances)
    near, far = (distance <= distances[..., k] * (1.0 + _TOUCHES) for k in (0, 1))
    seen = (share * near + (1.0 - share) * far)[..., None]
    over = light * front[..., 3:] + cover[..., None] * front[..., :3]
    layer = np.concatenate([over * seen, cover[..., None] * seen], axis=-1)
    return np.where(cover[..., None] > 0.0, layer, 0.0).astype(np.float32)


def place_over(picture: Array, layer: Array) -> Array:
    """Place a layer (h, w, 4) of radiance times alpha, and alpha, over a picture (h, w, 3)."""
    return (picture * (1.0 - layer[..., 3:]) + layer[..., :3]).astype(np.float32)


def _share_of_flames(light: Array) -> Array:
    """Estimate the share (h, w, 1) of flames in light (h, w, 3): they have little blue, and smoke is grey."""
    red, blue = light[..., :1], light[..., 2:]
    return np.clip((red - 2.0 * blue) / np.maximum(red, 1.0e-6), 0.0, 1.0)


def _limited(gaps: Array, share: Array, most: float) -> Array:
    """Limit the light (h, w, 3) of gaps in a near surface that covers a share (h, w, 1) of the pixel.

    Light over the radiance `most` in a gap counts less, the more of the pixel is covered: a pixel is then the
    mean of what its parts look like, and edges in front of flames are not ragged by clipped pixels.
    """
    excess = gaps.max(axis=-1, keepdims=True) * share / np.maximum((1.0 - share) * most, 1.0e-6)
    excess = np.maximum(excess, 1.0e-6)
    return gaps * -np.expm1(-excess) / excess


def soften_highlights(layers: Layers, white: float) -> Layers:
    """Spread the light of a picture above a radiance over about 3 pixels, as lenses do.

    Flames are many times brighter than white. Without this, a pixel that shows a little of them between
    leaves is as bright as one full of them, and gaps look like square chips.
    """
    spread = softening(layers.picture, white)
    return Layers(spread(layers.picture), spread(layers.solid), spread(layers.fire))


def softening(picture: Array, white: float) -> Callable[[Array], Array]:
    """Return the function by which `soften_highlights` spreads a layer of a picture; sums stay sums."""
    brightest = picture.max(axis=-1, keepdims=True)
    part = np.clip(1.0 - white / np.maximum(brightest, 1.0e-6), 0.0, 1.0)

    def spread(layer: Array) -> Array:
        excess = layer * part
        return (layer - excess + blur(excess)).astype(np.float32)

    return spread


def infrared_radiance(surface: Array, flames: Array, warmth: Array, sky: Array | float) -> Array:
    """Compute infrared radiance (h, w) without smoke, W m-2 sr-1, from AOVs (see `blender.nodes`).

    Parameters
    ----------
    surface, flames
        (h, w, 3).
    warmth
        (h, w).
    sky
        (h, w) radiance of the clear sky, W m-2 sr-1.
    """
    emissivity = flames[..., 2]
    behind = surface[..., 2] + np.clip(1.0 - surface[..., 1], 0.0, 1.0) * sky
    # Emissivities of overlapping flames can add up to more than 1; the pixel then has their mean radiance.
    return warmth / np.maximum(emissivity, 1.0) + np.clip(1.0 - emissivity, 0.0, 1.0) * behind


def average_hot(radiance: Array, rays: int, hot: float) -> Array:
    """Average infrared radiance (h, w) over 3 x 3 pixels where some of them exceed the radiance `hot`.

    In a burn, hot ground lies between cold crowns that are smaller than pixels. A pixel of few rays sees one
    or the other, so its mean is estimated from its neighbours too. The fewer `rays` per pixel, the more they
    count. Colder pixels are unchanged.
    """
    own = _own_weight(rays)
    near = dilate(radiance > hot, 1)
    smooth = own * radiance + (1.0 - own) * blur(radiance[..., None])[..., 0]
    return np.where(near, smooth, radiance).astype(np.float32)


def _coverage(surfaces: Surfaces, distances: Array) -> Array:
    """Estimate the coverage (h, w), 0 to 1, of each pixel by its near surface."""
    near, far = (1000.0 / np.hypot(distances[..., k], surfaces.aside) for k in (0, 1))
    apart = near - far
    share = np.clip((surfaces.nearness - far) / np.where(apart > 0.0, apart, 1.0), 0.0, 1.0)
    # Before the sky only the pixel's own rays count: its colour has the sky's in the same share.
    own = _own_weight(surfaces.rays)
    sure = np.where(distances[..., 1] < SKY, own, 1.0)
    share = sure * share + (1.0 - sure) * _near_share(surfaces.distance, distances)
    # Materials of an artist do not write distance: only the depth of the centre ray is known.
    share = np.where(
        _is_unknown(surfaces), surfaces.distance <= distances[..., 0] * (1.0 + _SAME_DEPTH), share
    )
    share = np.where(apart > 1.0e-3 * near, share, 1.0)
    before = _before_flames(surfaces)
    # If both surfaces are before the flames, `before` counts rays to the far one too.
    divided = _hides_flames(surfaces, distances) & (distances[..., 1] > surfaces.flame_distance)
    return np.where(divided, before, share)


def _hides_flames(surfaces: Surfaces, distances: Array) -> NDArray[np.bool_]:
    """Return a mask (h, w) of pixels whose near surface, of known distance, is before the flames."""
    return (distances[..., 0] < surfaces.flame_distance) & ~_is_unknown(surfaces)


def _is_unknown(surfaces: Surfaces) -> NDArray[np.bool_]:
    """Return a mask (h, w) of pixels whose central ray meets a material that writes no distance."""
    away = np.hypot(surfaces.distance, surfaces.aside)
    written = surfaces.nearness * away / 1000.0 * surfaces.rays  # at least 1 if the central ray adds to it
    return (surfaces.solid < 0.5) & (written < 0.5) & (surfaces.distance < SKY)


def _shows_sky(surfaces: Surfaces) -> NDArray[np.bool_]:
    """Return a mask (h, w) of pixels some of whose rays meet nothing, next to known materials alone."""
    return (surfaces.solid < 1.0 - _GAPS) & ~dilate(_is_unknown(surfaces), 1)


def _own_weight(rays: int) -> float:
    """Return the weight, 0 to 1, of a pixel of few rays relative to the mean with its neighbours."""
    return rays / (rays + _SURE)


def _before_flames(surfaces: Surfaces) -> Array:
    """Estimate the share (h, w) of the pixel that shows surfaces before the flames."""
    own = _own_weight(surfaces.rays)
    return own * surfaces.before + (1.0 - own) * _mean_before(surfaces)


def _mean_before(surfaces: Surfaces) -> Array:
    """Compute the mean share (h, w) of rays that meet a surface before the flames, over 3 x 3 pixels."""
    return blur(surfaces.before[..., None])[..., 0]


def _extended(surfaces: Surfaces) -> NDArray[np.bool_]:
    """Return a mask (h, w) of foliage before flames with gaps that no central ray goes through."""
    covered = dilate(surfaces.distance, 1) < surfaces.flame_distance
    return covered & (_mean_before(surfaces) < 1.0 - _SOLID)


def _near_share(distance: Array, distances: Array) -> Array:
    """Compute the share (h, w) of each 3 x 3 neighbourhood at its near tap's depth, centre-weighted."""
    middle = np.sqrt(distances[..., 0] * np.minimum(distances[..., 1], 1.0e10))
    padded = np.pad(distance, 1, mode="edge")
    height, width = distance.shape
    total = np.zeros((height, width), np.float32)
    for down, row in enumerate((0.25, 0.5, 0.25)):
        for across, column in enumerate((0.25, 0.5, 0.25)):
            there = padded[down : down + height, across : across + width]
            total += np.float32(row * column) * (there < middle)
    return total


def _flame_light(surfaces: Surfaces) -> Array:
    """Estimate the flame light (h, w, 3) in the denoised colour, with shares blurred as denoisers do."""
    part = blur(surfaces.fire) / np.maximum(blur(surfaces.noisy), 1.0e-6)
    alight = (surfaces.fire_distance > 0.0)[..., None]
    return np.where(alight, surfaces.colour * np.clip(part, 0.0, 1.0), 0.0)


def _without_edges(colour: Array, noisy: Array, near: Array, share: Array, edge: NDArray[np.bool_]) -> Array:
    """Replace the colour (h, w, 3) of edge pixels by the colour of the near surface.

    The colour is the mean of non-edge neighbours at equal depth. Twigs have no such neighbours. There, the
    noisy colours of the pixel and of the neighbour with the least share are extrapolated to full coverage.
    The result is limited to the darkest colour of the 3 x 3 neighbourhood: bright outliers are fire or sky
    behind smoke.

    Parameters
    ----------
    noisy
        (h, w, 3) colour before denoising, which mixes surfaces.
    near
        (h, w) distance of the near surface, m.
    share
        (h, w) share of the pixel that the near surface covers.
    """
    cleaned = colour.copy()
    rows, columns = np.nonzero(edge)
    if len(rows) == 0:
        return cleaned
    height, width = edge.shape
    darkest = np.stack([-dilate(-colour[..., channel], 1) for channel in range(3)], axis=-1)[rows, columns]
    total, weight = np.zeros((len(rows), 3), np.float32), np.zeros(len(rows), np.float32)
    own, covered = noisy[rows, columns], share[rows, columns]
    here, least, farther = near[rows, columns], covered.copy(), own.copy()
    for down in range(-_REACH, _REACH + 1):
        for across in range(-_REACH, _REACH + 1):
            row, column = rows + down, columns + across
            inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            row, column = np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)
            alike = inside & ~edge[row, column] & (np.abs(near[row, column] - here) < _SAME_DEPTH * here)
            part = np.float32(np.exp(-0.5 * (down**2 + across**2))) * alike
            total += part[:, None] * colour[row, column]
            weight += part
            less = share[row, column] < least
            least = np.where(less, share[row, column], least)
            farther = np.where(less[:, None], noisy[row, column], farther)
    apart = np.maximum(covered - least, 1.0e-3)[:, None]
    covering = ((1.0 - least)[:, None] * own - (1.0 - covered)[:, None] * farther) / apart
    mean = total / np.maximum(weight, 1.0e-9)[:, None]
    alone = np.clip(covering, 0.0, darkest)
    cleaned[rows, columns] = np.where(weight[:, None] > 0.0, mean, alone)
    return cleaned
