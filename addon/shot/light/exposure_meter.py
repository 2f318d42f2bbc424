"""Exposure metering: luminance of sun, sky, haze, ground and smoke along a few rays of a camera.

Each ray ends on the ground or in the sky, with or without smoke in front. Smoke is estimated before it is
solved: each fire has a bent-over plume with Briggs' plume rise. Flames are left out, as their brightness
follows the exposure (`scene.glow`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import constants
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ..cameras import clipping
from ..cameras import panorama as sphere
from ..cameras.path import Path
from ..fire import heat_release
from ..shot import Shot
from ..terrain import noise
from . import sky, smoke_haze

_RAYS = 16, 9
_REACH = np.geomspace(40.0, 60_000.0, 72)  # m, distances of ground samples along a ray
_HIGHEST = 4500.0  # m above the scene's zero, upper limit of terrain
_AIR = 50_000.0  # m above the scene's zero, above which lies a ten-thousandth of the haze
_HIGH = 30_000.0  # m, height of eyes that see the Earth as a ball
_GROUND = 0.06  # mean luminance reflectance of forest, brush and ash: `scene.terrain.material`
_SHADE = 0.1  # fraction of that light under trees, from sun flecks and visible sky; by eye
_SLOPE = 40.0  # m to each side, baseline of slopes
_SHADOW = np.geomspace(100.0, 6000.0, 14)  # m towards the sun, distances at which relief may cast a shadow
_CROWNS = 6.0, 25.0  # m above the ground: below crowns, and above most of them
_CLOSED, _BARE = 0.6, 0.4  # kg/m2 of canopy that shades 1 - 1/e of the ground; of that burned trees; by eye
_CLOUD = 0.3  # of lit smoke: a deep ball of it has 0.27, the sun behind the camera, to 0.46, at its side
_YOUNG = 20.0, 600.0  # s in which smoke turns from sooty to white, as in `flow.Detail`
_SOOT = 0.3  # brightness of fresh smoke relative to aged smoke, amid other smoke; as rendered
_BLOCK, _FIRES = 600.0, 80  # m, size within which heat is one fire, at 15 km; fires at most
# s, age of smoke parcels, for a fire of 15 km.
_TIMES = np.array([30.0, 90.0, 180.0, 300.0, 480.0, 720.0, 1080.0, 1600.0])
_HIDES, _FRONT = 0.3, 1.5  # optical depth from which a parcel occludes; radii from its front to its centre
_THROUGH = 0.5  # fraction of smoke's optical depth that attenuates its light: `scene.smoke.flow_material`
_TOP = 3500.0  # m above the fire, upper limit of plume rise
_BRIGGS = 1.6, 0.7 * constants.BUOYANCY_FLUX  # rise is 1.6 F^(1/3) x^(2/3) / u; 0.7 of the heat is convected
# m2/J: 4 m2/g of smoke, which is a fiftieth of the fuel.
_EXTINCTION = 4000.0 * 0.02 / constants.HEAT_OF_COMBUSTION


Array = NDArray[np.float64]


@dataclass(frozen=True)
class SmokeParcels:
    """Estimated smoke: parcels of n fires at m ages, and lights of the fires.

    Attributes
    ----------
    place, radius, depth
        Centres (n, m, 3), m, radii (n, m), m, and optical depths (n, m).
    bright
        (m,) brightness relative to aged smoke.
    light
        Positions (k, 3), m, and luminous powers (k,), W.
    ratio
        Length scale of the fire relative to 15 km.
    """

    place: Array
    radius: Array
    depth: Array
    bright: Array
    light: tuple[Array, Array]
    ratio: float


def clear(light: sky.State) -> Array:
    """Luminance of level ground, and of the clear sky above it."""
    ground = _GROUND / np.pi * light.power * light.direction[2] + _GROUND * light.sky_mean
    return np.array([ground, light.sky_mean])


def measure(shot: Shot, view: Path, frame: int) -> tuple[Array, Array, Array]:
    """Meter a frame. From space the Earth counts as level ground by a clear sky.

    Returns
    -------
    found, level
        (n,) luminances, and those for ground lit as if it were level.
    shine
        (n,) flame light on smoke along rays, GW.
    """
    time = shot.frames.time(frame)
    if view.beyond and clipping.heights(shot.ground.frame, view.position[frame - 1 : frame])[0] > _HIGH:
        level = clear(sky.state(shot, time))
        return level, level, np.zeros(len(level))
    light, smoke = sky.state(shot, time), _smoke(shot, time)
    start, along = _rays(view, frame - 1)
    ends = _ends(shot, start, along)
    ground = np.isfinite(ends)
    far = np.where(ground, ends, 0.0)
    place = start + far[:, None] * along
    sunlit = _GROUND / np.pi * light.power * _sunlit(smoke, place, light, 1.0)
    crowns = 1.0 - (1.0 - _SHADE) * _crowns(shot, view.position[frame - 1], time)
    haze = _haze_depth(start[:, 2], along[:, 2], far, (sky.HAZE * shot.settings.light.haze, sky.HAZE_HEIGHT))
    layer = smoke_haze.smoke(shot.settings.light, smoke_haze.ground_height(shot.run))
    through = np.exp(-haze - _haze_depth(start[:, 2], along[:, 2], far, layer))
    depth, met, bright = _depth(smoke, start, along, ends)
    hidden = 1.0 - np.exp(-depth)
    shade = _sunlit(smoke, start + met[:, None] * along, light, _THROUGH)
    before = hidden * _lit_smoke(light, along) * bright * shade

    def seen(facing: Array | float) -> Array:
        lit = facing * sunlit + _GROUND * light.sky_mean
        behind = crowns * np.where(ground, lit, light.sky_mean * _gradation(along[:, 2]))
        behind = np.where(ground, behind * through + luminance(light.haze) * (1.0 - through), behind)
        return (1.0 - hidden) * behind + before

    facing = np.zeros(len(place))
    facing[ground] = _facing(shot, place[ground], light.direction)
    shine = hidden * _shine(smoke, start, along, ends)
    return seen(facing), seen(light.direction[2]), shine


def _crowns(shot: Shot, eye: Array, time: float) -> float:
    """Fraction of the picture of a camera at (3,) that is canopy or ground in its shade, 0 to 1.

    It applies to a camera no higher than the crowns amid unburned canopy fuel; burned canopy counts in part.
    """
    ground = shot.bare_ground
    if not shot.settings.forest.trees:
        return 0.0
    row, column = ground.under(eye[None])
    low = 1.0 - noise.smoothstep(*_CROWNS, float(eye[2] - ground.up(eye[:1], eye[1:2])[0]))
    canopy = float(bilinear(ground.fields.canopy_fuel, row, column)[0])
    burned = float(ground.arrival_at(row, column)[0]) < time
    return low * (1.0 - np.exp(-canopy / _CLOSED)) * (_BARE if burned else 1.0)


def _facing(shot: Shot, place: Array, direction: Array) -> Array:
    """Direct sunlight fraction (n,) on the ground below points (n, 3): by slope, none in a ridge's shadow."""
    up, (x, y) = shot.bare_ground.up, place[:, :2].T
    east = (up(x + _SLOPE, y) - up(x - _SLOPE, y)) / (2.0 * _SLOPE)
    north = (up(x, y + _SLOPE) - up(x, y - _SLOPE)) / (2.0 * _SLOPE)
    facing = (direction[2] - east * direction[0] - north * direction[1]) / np.sqrt(1.0 + east**2 + north**2)
    toward = direction / max(float(np.hypot(*direction[:2])), 1.0e-6)
    way = np.column_stack([x, y, up(x, y)])[:, None] + (_SHADOW[:, None] * toward)[None]
    ground = up(way[..., 0].ravel(), way[..., 1].ravel()).reshape(way.shape[:2])
    return np.where((ground > way[..., 2]).any(axis=1), 0.0, np.maximum(facing, 0.0))


def _sunlit(smoke: SmokeParcels, place: Array, light: sky.State, through: float) -> Array:
    """Transmittance (n,) of smoke for sunlight at points (n, 3), with its depth times `through`."""
    depth, _met, _bright = _depth(smoke, place, np.broadcast_to(light.direction, place.shape), np.inf)
    return np.exp(-through * depth)


def _rays(view: Path, frame: int) -> tuple[Array, Array]:
    """Origins and directions (n, 3) of rays, spread evenly over a camera's picture or over all directions."""
    if view.around:
        sine = (np.arange(_RAYS[1]) + 0.5) / _RAYS[1] * 2.0 - 1.0
        bearing = ((np.arange(_RAYS[0]) + 0.5) / _RAYS[0] * 2.0 - 1.0) * np.pi
        bearing, elevation = (v.ravel() for v in np.meshgrid(bearing, np.arcsin(sine)))
        along = sphere.direction(bearing, elevation) @ view.rotation[frame].T
        return np.broadcast_to(view.position[frame], along.shape), along
    across, up = (((np.arange(count) + 0.5) / count * 2.0 - 1.0) for count in _RAYS)
    half = view.halves[frame]
    across, up = (v.ravel() for v in np.meshgrid(across * half[0], up * half[1]))
    turn, place = view.rotation[frame], np.broadcast_to(view.position[frame], (len(up), 3))
    plane = across[:, None] * turn[:, 0] + up[:, None] * turn[:, 1]
    if not view.perspective:
        return place + plane, np.broadcast_to(-turn[:, 2], plane.shape)
    along = plane - turn[:, 2]
    return place, along / np.linalg.norm(along, axis=1, keepdims=True)


def _ends(shot: Shot, start: Array, along: Array) -> Array:
    """Raycast against the terrain: distances (n,), m; infinite without a hit."""
    down = np.minimum(along[:, 2], -1.0e-3)
    begin = np.maximum((_HIGHEST - start[:, 2]) / down, 0.0)
    reach = begin[:, None] + _REACH
    way = start[:, None] + reach[..., None] * along[:, None]
    ground = shot.bare_ground
    low = way[..., 2] <= ground.fields.elevation.max()  # higher points are in the sky
    low[low] = way[low][:, 2] < ground.up(*way[low][:, :2].T)
    return np.where(low.any(axis=1), reach[np.arange(len(low)), np.argmax(low, axis=1)], np.inf)


def _haze_depth(height: Array, up: Array, far: Array, layer: smoke_haze.Layer) -> Array:
    """Optical depth (n,) of a layer along rays from heights (m) with sines of elevation `up`; see `haze`."""
    above = np.maximum((height - _AIR) / np.maximum(-up, 1.0e-3), 0.0)
    height, far = np.minimum(height, _AIR), np.maximum(far - above, 0.0)
    rise = up * far / layer[1]
    rise = np.where(np.abs(rise) < 1.0e-3, 1.0e-3, rise)
    return layer[0] * far * np.exp(-height / layer[1]) * (1.0 - np.exp(-rise)) / rise


def _gradation(up: Array) -> Array:
    """Sky gradation: clear-sky radiance over its mean, by sine of elevation; fitted to Cycles, sun at 34."""
    return 0.55 + 2.7 * (1.0 - np.clip(up, 0.0, 1.0)) ** 2


def _smoke(shot: Shot, time: float) -> SmokeParcels:
    """Estimated smoke at a time; empty (n = 0) if smoke is off."""
    sources = shot.fire.sources(time)
    if not shot.settings.smoke.enabled:
        sources = sources.take(np.empty(0, np.int64))
    block, ages = shot.scale.length(_BLOCK), shot.scale.time(1.0) * _TIMES
    fires = heat_release.lights(sources, block, _FIRES)
    shine = heat_release.lights(shot.fire.luminous(sources), block, _FIRES)
    speed = max(float(np.hypot(*shot.wind)), 1.0)
    drift = np.array([*shot.wind, 0.0])[None, None] * ages[None, :, None]
    flux = (_BRIGGS[1] * fires.power[:, None]) ** (1.0 / 3.0)
    rise = np.minimum(_BRIGGS[0] * flux * (speed * ages) ** (2.0 / 3.0) / speed, _TOP)
    place = fires.position[:, None] + drift
    place[..., 2] += rise
    radius = 0.5 * rise + 0.5 * block  # Briggs: half-width is half of the rise
    depth = shot.fire.smoke.opacity * _EXTINCTION * fires.power[:, None] / (2.0 * radius * speed)
    bright = 1.0 - (1.0 - _SOOT) * noise.smoothstep(*_YOUNG[::-1], _TIMES)
    return SmokeParcels(place, radius, depth, bright, (shine.position, shine.power), shot.scale.ratio)


def _depth(
    smoke: SmokeParcels, start: Array, along: Array, ends: Array | float
) -> tuple[Array, Array, Array]:
    """Smoke along rays: optical depth (n,), distance (n,) to the first dense parcel, m, and brightness (n,).

    Only the parcel with the largest depth on a ray counts for each fire.
    """
    n = len(start)
    if len(smoke.place) == 0:
        return np.zeros(n), np.zeros(n), np.ones(n)
    radius = smoke.radius[..., None]
    far = smoke.place @ along.T - (start * along).sum(axis=1)
    beside = np.maximum(_squares(smoke.place, start) - far**2, 0.0)
    seen = (far > 0.0) & (far < ends + radius)
    thick = seen * smoke.depth[..., None] * np.exp(-beside / radius**2)
    most = np.argmax(thick, axis=1)
    thickest, far, radius = (
        np.take_along_axis(np.broadcast_to(v, thick.shape), most[:, None], axis=1)[:, 0]
        for v in (thick, far, radius)
    )
    front = np.where(thickest > _HIDES, np.maximum(far - _FRONT * radius, 0.0), np.inf)
    first, rays = np.argmin(front, axis=0), np.arange(n)
    met = front[first, rays]
    hides = np.isfinite(met)
    bright = np.where(hides, smoke.bright[most[first, rays]], 1.0)
    return thickest.sum(axis=0), np.where(hides, met, 0.0), bright


def _squares(some: Array, others: Array) -> Array:
    """Squared distances (..., n) between points (..., 3) and (n, 3)."""
    return (some**2).sum(axis=-1)[..., None] + (others**2).sum(axis=1) - 2.0 * (some @ others.T)


def _lit_smoke(light: sky.State, along: Array) -> Array:
    """Luminance (n,) of thick smoke on rays: a Lambert sphere in sunlight, plus skylight."""
    phase = np.arccos(-np.clip(along @ light.direction, -1.0, 1.0))
    sphere = (np.sin(phase) + (np.pi - phase) * np.cos(phase)) * 2.0 / (3.0 * np.pi)
    return _CLOUD * (light.power * sphere / np.pi + light.sky_mean)


def _shine(smoke: SmokeParcels, start: Array, along: Array, ends: Array) -> Array:
    """Largest flame light (n,) on smoke along a ray: sum of P / 1 GW exp(-r / 600 m) / (1 + (r / 250 m)^2).

    Smaller fires have shorter lengths, and powers that scale with their squares, as in `flow_frames`.
    """
    places, power = smoke.light
    reach, core = 600.0 * smoke.ratio, 250.0 * smoke.ratio
    if len(places) == 0:
        return np.zeros(len(start))
    far = np.maximum(along @ places.T - (start * along).sum(axis=1)[:, None], 0.0)
    nearest = start[:, None] + np.minimum(far, ends[:, None])[..., None] * along[:, None]
    square = np.maximum(_squares(nearest, places), 0.0)
    light = np.exp(-np.sqrt(square) / reach) / (1.0 + square / core**2)
    return (light @ power).max(axis=1) / (1.0e9 * smoke.ratio**2)


def luminance(colour: tuple[float, ...]) -> float:
    """Luminance of linear red, green and blue (ITU-R BT.709)."""
    return float(np.dot(colour, (0.2126, 0.7152, 0.0722)))
