"""Cameras at a distance from flames: on unburned ground, to windward, with a clear line of sight."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...shot.terrain.terrain import Terrain
from ..coarse_smoke import CoarseSmoke
from . import line_of_sight
from .kinds import FireKind
from .local_fire import LocalFire

EYE = 1.7  # m, of a standing person
_NEAR = 40.0, 100.0  # m, distances up to which cameras are only at eye height, and up to which also at it
_HEIGHTS = (0.08, 0.16, 0.3, 0.45, 0.7)  # other heights over the distance
_DIRECTIONS = 32
_LEEWARD = 0.35  # cosine of a camera's bearing to the wind, above which smoke covers the view (by eye)
_CLEAR_PART = 0.6  # of the line of sight without flames, from the camera
_MARGIN = (2.0, 0.25, 40.0)  # m around a camera that does not burn: least, part of the distance, most
_LATER = 10.0  # s after the clip until which it does not burn
_TRIED, _TRIED_IN = 16, 80  # candidates whose lines of sight are computed; the same in smoke
_CLEAR = 0.2  # least transmittance of smoke before the flames (by eye)
_GOOD = 0.75  # visible share at which the search ends
LEAST = 0.45  # visible share that a camera must have
_WINDWARD, _VEILED, _RAISED = 0.2, 0.6, 0.06  # weights against the visible share (by eye)
_PLUME = 0.3  # part of the estimated smoke that is not above the line of sight (assumed)
_FILL = 0.42  # of the picture's height that flames fill
_LENSES = (14.0, 500.0)  # mm
_SENSOR, _ASPECT = 36.0, 9.0 / 16.0
_SIDE = 0.32  # of the picture's width, to each side, in which flames must be clear
_POINTS = 17  # places along each side of a square of flames
_ASIDE = (-0.08, 0.0, 0.08)  # points of a burning crown across its axis, over its flames' height

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlacedView:
    """Camera in front of flames.

    Attributes
    ----------
    distance
        Requested distance, m.
    eye, target
        (3,) m in the scene; the target is on the ground.
    above
        Height of the camera above the ground, m.
    flame
        Height of the flames, m.
    focal_length
        mm.
    share
        Share of the flames' points that nothing hides, 0..1.
    score
        Rating by share, wind and height.
    """

    distance: float
    eye: Array
    target: Array
    above: float
    flame: float
    focal_length: float
    share: float
    score: float

    @property
    def bearing(self) -> float:
        """Bearing of the camera from the flames, degrees."""
        return float(np.degrees(np.arctan2(*(self.eye - self.target)[:2])))


def focal_length(distance: float, flame: float) -> float:
    """Focal length (mm) with which flames of a height (m) fill `_FILL` of the picture's height."""
    return float(np.clip(_FILL * _SENSOR * _ASPECT * distance / max(flame, 0.05), *_LENSES))


def place(
    fire: LocalFire,
    aims: Array,
    flame: float,
    distance: float,
    kind: FireKind,
    smoke: CoarseSmoke | None = None,
) -> PlacedView | None:
    """Place a camera at a distance (m) from an aim among (n, 2), where flames are `flame` m high; or None.

    With `smoke`, the visible share counts by its transmittance, and more candidates are tried.
    """
    best = None
    for loss, aim, side, height in _candidates(fire, aims, distance)[
        : _TRIED if smoke is None else _TRIED_IN
    ]:
        view = _view(fire, aim, side, height, distance, flame, loss, kind)
        if view.share < LEAST:
            continue
        if smoke is not None:
            clear = float(np.exp(-smoke.depth(0, view.eye, view.target[None] + [0.0, 0.0, 0.5 * flame]))[0])
            if clear < _CLEAR:
                continue
            view = replace(view, score=clear * view.share - loss)
        if best is None or view.score > best.score:
            best = view
        if view.share >= _GOOD and smoke is None:
            break
    return best


def _candidates(fire: LocalFire, aims: Array, distance: float) -> list[tuple[float, Array, Array, float]]:
    """Losses by wind, smoke and height, aims (2,), directions (2,) of cameras from them, and heights (m)."""
    turn = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    side = np.stack([np.sin(turn), np.cos(turn)], axis=-1)
    aim = _outermost(fire.centre, aims, side)
    eye = aim + distance * side
    downwind = side @ _wind(fire)
    good = (downwind <= _LEEWARD) & _over_run(fire.shot.bare_ground, eye)
    good[good] = _unburned(fire, eye[good], distance)
    good[good] = _without_flames(fire, eye[good], aim[good], distance)
    heights = _heights(distance)
    order = []
    for at in np.flatnonzero(good):
        veil = 1.0 - float(np.exp(-_PLUME * fire.smoke.depth(eye[at], aim[at])))
        loss = _WINDWARD * downwind[at] + _VEILED * veil
        order += [(loss + _RAISED * step, int(at), step) for step in range(len(heights))]
    return [(loss, aim[at], side[at], heights[step]) for loss, at, step in sorted(order)]


def _heights(distance: float) -> list[float]:
    """Heights (m) of cameras at a distance (m), the best first."""
    only, also = _NEAR
    raised = [part * distance for part in _HEIGHTS]
    return [EYE] if distance <= only else [EYE, *raised] if distance <= also else raised


def _outermost(centre: Array, aims: Array, side: Array) -> Array:
    """Aim (m, 2) of each direction (m, 2): the one farthest in it, near the line through the centre."""
    away = aims - centre
    along = away @ side.T
    aside = np.abs(away[:, :1] * side[:, 1] - away[:, 1:] * side[:, 0])
    return aims[np.argmax(along - 1.5 * aside, axis=0)]


def _wind(fire: LocalFire) -> Array:
    wind = np.array(fire.shot.wind)
    return wind / max(float(np.hypot(*wind)), 1.0)


def _over_run(ground: Terrain, eye: Array) -> NDArray[np.bool_]:
    """Return which places (n, 2) are on the run's grid."""
    row, column = ground.indices(*ground.geodetic(*eye.T))
    margin = max(ground.fields.margin, 1)
    inside = [
        (at > margin) & (at < count - 1 - margin)
        for at, count in zip((row, column), ground.shape, strict=True)
    ]
    return inside[0] & inside[1]


def _unburned(fire: LocalFire, eye: Array, distance: float) -> NDArray[np.bool_]:
    """Return around which places (n, 2) no ground burns until after the clip."""
    least, part, most = _MARGIN
    radius = float(np.clip(part * distance, least, most))
    turn = 2.0 * np.pi * np.arange(12) / 12.0
    ring = radius * np.vstack([np.zeros((1, 2)), np.stack([np.sin(turn), np.cos(turn)], axis=-1)])
    around = (eye[:, None] + ring).reshape(-1, 2)
    later: NDArray[np.bool_] = fire.arrival(around) > fire.shot.frames.last + _LATER
    return later.reshape(len(eye), -1).all(axis=1)


def _without_flames(fire: LocalFire, eye: Array, aim: Array, distance: float) -> NDArray[np.bool_]:
    """Return which lines of sight (n of them) have no flames between camera and aim, but near the aim."""
    part = np.linspace(0.0, _CLEAR_PART, 25)[:, None, None]
    way = (eye + part * (aim - eye)).reshape(-1, 2)
    burns = [fire.flame_heights(way, time) > 0.0 for time in (fire.first, fire.shot.frames.last)]
    return ~(burns[0] | burns[1]).reshape(len(part), -1).any(axis=0)


def _view(
    fire: LocalFire,
    aim: Array,
    side: Array,
    height: float,
    distance: float,
    flame: float,
    loss: float,
    kind: FireKind,
) -> PlacedView:
    """Return a camera in a direction (2,) from an aim (2,), m; its score is the share less the loss."""
    bare = fire.shot.bare_ground
    place = aim + _flat(bare, aim, side, height, distance) * side
    rough = np.array([*place, float(bare.up(*place)[0]) + height])
    ground = bare.seen_from(rough[None])
    eye = np.array([*place, float(ground.up(*place)[0]) + height])
    target = np.array([*aim, float(ground.up(*aim)[0])])
    lens = focal_length(float(np.linalg.norm(eye - target)), flame)
    half = 0.5 * _SENSOR / lens * distance * 2.0 * _SIDE
    points = _flame_points(fire, ground, target, side, half, flame, kind)
    share = _visible_share(fire, eye, points, ground, distance)
    return PlacedView(distance, eye, target, height, flame, lens, share, share - loss)


def _visible_share(fire: LocalFire, eye: Array, points: Array, ground: Terrain, distance: float) -> float:
    """Share 0..1 of points (n, 3) that a camera (3,) at a distance (m) sees."""
    if len(points) == 0:
        return 0.0
    seen = line_of_sight.over_terrain(eye, points, ground)
    seen[seen] = line_of_sight.between_plants(eye, points[seen], ground, fire.trees)
    if distance <= _NEAR[1] and float(np.mean(seen)) >= LEAST:
        seen[seen] = line_of_sight.between_plants(eye, points[seen], ground, fire.low_plants)
    return float(np.mean(seen))


def _flat(ground: Terrain, aim: Array, side: Array, height: float, distance: float) -> float:
    """Horizontal distance (m) from an aim on the ground at which a camera is `distance` m away from it."""
    flat, low = distance, float(ground.up(*aim)[0])
    for _ in range(3):
        rise = float(ground.up(*(aim + flat * side))[0]) + height - low
        flat = float(np.sqrt(max(distance**2 - rise**2, 0.25 * distance**2)))
    return flat


def _flame_points(
    fire: LocalFire, ground: Terrain, target: Array, side: Array, half: float, flame: float, kind: FireKind
) -> Array:
    """Points (n, 3) of the flames in the picture, within `half` (m) to both sides; or of a burning crown."""
    if kind.torches:
        up = np.array([[0.0, 0.0, 1.0]]) * (np.array(kind.seen) * flame)[:, None]
        across = np.array([-side[1], side[0], 0.0]) * (np.array(_ASIDE) * flame)[:, None]
        return target + (up[:, None] + across).reshape(-1, 3)
    line = np.linspace(-half, half, _POINTS)
    across = np.array([-side[1], side[0]])
    deep = np.linspace(-0.5 * half, 0.0, 5)
    place = target[:2] + (line[:, None, None] * across + deep[None, :, None] * side).reshape(-1, 2)
    height = fire.flame_heights(place, fire.first)
    burns = height >= 0.4 * flame
    place, height = place[burns], height[burns]
    up = ground.up(*place.T) if len(place) else np.empty(0)
    return np.concatenate([np.column_stack([place, up + part * height]) for part in kind.seen])
