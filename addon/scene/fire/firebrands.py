"""Firebrands: glowing pieces lofted by the plume and carried by the wind until they fall and cool.

The core's integrator computes each trajectory; the mesh stores it as points at equal time steps. Geometry
nodes draw a streak between the two points before and after the current time, so no other animation data are
needed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from firetwin_core import constants, geo, particles
from numpy.typing import NDArray

from ...run import burning
from ...shot.shot import Shot
from ...shot.terrain import noise
from ...shot.terrain.terrain import Terrain
from . import flames

REACH = 1800.0  # m from a camera; firebrands farther away are too faint for a picture
PER_MEGAJOULE = 0.01  # large pieces per MJ of heat released; chosen by eye
SHUTTER, _LONGEST = 1.0 / 48.0, 1.0 / 12.0
"""s, exposure time of a streak without motion blur, as of a film camera, and the longest."""
_NEAR, _MORE = 400.0, 25.0
"""m from a camera within which pieces are more numerous, in inverse proportion to the distance, and the most
by which: smaller ones are visible there (by eye)."""
_LIFE = (2.0, 16.0)  # s, life of a glowing piece
_MEAN_LIFE = 7.0  # s
_SIZE, _SIZES, _SIZE_RANGE = 0.012, 0.7, (0.003, 0.06)  # m, deviation of the logarithm, m (bark and twigs)
_FALL = (1.0, 4.0)  # m/s, terminal velocity of the smallest and largest (assumed)
_STEP = 0.5  # s between points of a trajectory
_MOMENT = 0.4  # s; part of a trajectory that is stored if frames are further apart than lifetimes
_PLUME = 90.0, 6.0  # m of height and s in which the updraft falls to 1/e: pieces fall out of the plume
_AIR = constants.AIR_DENSITY * constants.SPECIFIC_HEAT * constants.AIR_TEMPERATURE  # J/m3

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Flights:
    """Trajectories of the shot's n firebrands, with k points each.

    Attributes
    ----------
    place
        (n, k, 3) m, in the scene.
    start
        (n,) time of the first point, s after the first frame; points are `step` s apart.
    birth, life
        (n,) s after the first frame; s.
    size
        (n,) m.
    step
        s.
    """

    place: NDArray[np.float32]
    start: Array
    birth: Array
    life: Array
    size: Array
    step: float

    def alive(self, time: float) -> NDArray[np.int64]:
        """Return firebrands in the air, or glowing on the ground, `time` s after the first frame."""
        age = time - self.birth
        return np.flatnonzero((age >= 0.0) & (age < self.life))


@dataclass(frozen=True)
class Launches:
    """State of n firebrands at launch: time (s), place (n, 3), life (s), size (m), updraft (m/s), key."""

    time: Array
    place: Array
    life: Array
    size: Array
    updraft: Array
    key: NDArray[np.int64]
    rank: Array  # the lowest are retained

    def take(self, chosen: NDArray) -> Launches:
        """Return a subset."""
        return Launches(*(getattr(self, field.name)[chosen] for field in fields(self)))


def updraft(intensity: Array) -> Array:
    """Return the updraft (m/s) over a line fire of `intensity` kW/m: (g I / (rho cp T))^(1/3).

    It does not depend on height (Yokoi 1960; Lee and Emmons 1961, J. Fluid Mech. 11, 353). On the axis of the
    plume it is about twice as strong (assumed).
    """
    return np.cbrt(constants.GRAVITY * np.asarray(intensity, np.float64) * 1000.0 / _AIR)


def exposure_time(shot: Shot) -> float:
    """Return the exposure time (s) of streaks, equal to the exposure of motion blur if the shot has it."""
    blurred = shot.settings.render.motion_blur * shot.frames.step
    return min(blurred or SHUTTER, _LONGEST)


def fly(shot: Shot, points: flames.Points) -> Flights | None:
    """Launch, integrate and thin out the firebrands of flames near the cameras; None without firebrands.

    No frame has more than `fire.firebrands`; the nearest to a camera are retained.
    """
    most_shown = shot.settings.fire.firebrands
    if not shot.perspective_paths or most_shown == 0 or len(points.seed) == 0:
        return None
    distance = shot.visibility.distance(points.position)
    fade = np.clip((REACH - distance) / (0.3 * REACH), 0.0, 1.0)
    more = np.clip(_NEAR / np.maximum(distance, 1.0), 1.0, _MORE)
    rate = PER_MEGAJOULE * points.intensity * points.width / 1000.0 * fade * more
    times, zero = shot.built_times, shot.frames.first
    most = max(float(rate[points.lit(float(t))].sum()) for t in times) * _MEAN_LIFE
    rate *= min(1.3 * most_shown / max(most, 1.0), 1.0)
    lapse = shot.frames.step > _LIFE[1] or len(times) == 1
    spans = [(t - _LIFE[1], t) for t in times] if lapse else [(times[0] - _LIFE[1], times[-1])]
    floor = _landing_terrain(shot.ground, points.position[rate > 0.0])
    winds = burning.wind_at(
        shot.run, np.array([0.5 * (begin + end) for begin, end in spans]), shot.fire.surroundings
    )
    parts = []
    for number, span in enumerate(spans):
        launched = _launch(shot.settings.seed + 7919 * number, points, rate, distance, span)
        launched = _thin_out(launched, times[number : number + 1] if lapse else times, most_shown)
        if len(launched.time):
            path = _integrate_paths(launched, winds[number], floor)
            parts.append(_store_flights(launched, path, zero, span[1] if lapse else None))
    if not parts:
        return None
    return Flights(
        np.concatenate([part.place for part in parts]),
        np.concatenate([part.start for part in parts]),
        np.concatenate([part.birth for part in parts]),
        np.concatenate([part.life for part in parts]),
        np.concatenate([part.size for part in parts]),
        parts[0].step,
    )


def _launch(
    seed: int, points: flames.Points, rate: Array, distance: Array, span: tuple[float, float]
) -> Launches:
    """Launch firebrands within `span` (s), uniformly over the part of it in which their flame burns."""
    begin = np.maximum(points.arrival_time, span[0])
    during = np.maximum(np.minimum(points.arrival_time + points.residence, span[1]) - begin, 0.0)
    index = np.arange(len(rate))
    count = np.floor(rate * during + noise.uniform(index, 0, seed)).astype(np.int64)
    source = np.repeat(index, count)
    number = np.arange(len(source)) - np.repeat(np.cumsum(count) - count, count)

    def random(use: int) -> Array:
        return noise.uniform(source, number, seed + use)

    size = np.clip(_SIZE * np.exp(_SIZES * noise.normal(random(1), random(2))), *_SIZE_RANGE)
    side = 0.5 * points.width[source]
    place = points.position[source] + np.stack(
        [
            side * (2.0 * random(3) - 1.0),
            side * (2.0 * random(4) - 1.0),
            1.0 + points.length[source] * random(5),
        ],
        axis=-1,
    )
    return Launches(
        begin[source] + during[source] * (number + random(6)) / np.maximum(count[source], 1),
        place,
        np.minimum(_LIFE[0] - (_MEAN_LIFE - _LIFE[0]) * np.log(np.maximum(random(7), 1.0e-9)), _LIFE[1]),
        size,
        updraft(points.intensity[source]) * (0.6 + 1.6 * random(8)),
        source * 4096 + number,
        random(9) * np.maximum(distance[source], 200.0),
    )


def _thin_out(launched: Launches, times: Array, most: int) -> Launches:
    """Select firebrands alive at one of `times`, thinned so that at most `most` are alive at any of these."""
    shown = np.zeros(len(launched.time), bool)
    limit = np.inf
    for time in times:
        age = time - launched.time
        alive = (age >= 0.0) & (age < launched.life)
        shown |= alive
        if alive.sum() > most:
            limit = min(limit, np.partition(launched.rank[alive], most)[most])
    return launched.take(np.flatnonzero(shown & (launched.rank < limit)))


def _integrate_paths(launched: Launches, wind: Array, floor: geo.HeightField) -> NDArray[np.float32]:
    """Integrate trajectories; positions (n, k, 3), _STEP apart from launch on."""
    count = int(np.ceil(_LIFE[1] / _STEP)) + 1
    n = len(launched.time)
    path = np.empty((n, count, 3), np.float32)
    fall = np.interp(np.log(launched.size), np.log(_SIZE_RANGE), _FALL)
    position, landed = launched.place.copy(), np.zeros(n, bool)
    base = launched.place[:, 2].copy()
    air = _air_velocity(launched, wind, base)
    velocity = air(position, 0.0)
    for step in range(count):
        path[:, step] = position
        age = step * _STEP
        position, velocity, landed = particles.advance(
            position,
            velocity,
            air(position, age),
            _STEP,
            fall / constants.GRAVITY,
            wind_end=air(position + velocity * _STEP, age + _STEP),
            landed=landed,
            ground=floor,
        )
    return path


def _air_velocity(launched: Launches, wind: Array, base: Array) -> Callable[[Array, float], Array]:
    """Return the velocity function of the air (n, 3) at positions (n, 3) and an age (s).

    The wind grows with height as h^(1/7) and carries eddies of two to seven seconds, of a quarter of the
    updraft and a seventh of the wind (assumed). The updraft decays as pieces leave the plume.
    """
    random = [
        noise.uniform(launched.key, use, 31) for use in range(12)
    ]  # frequency and phase of two eddies along three axes
    eddy = 0.25 * launched.updraft + 0.14 * float(np.hypot(*wind))

    def velocity(place: Array, age: float) -> Array:
        height = np.maximum(place[:, 2] - base, 0.0)
        profile = (np.maximum(height, 3.0) / 10.0) ** (1.0 / 7.0)
        swirl = [
            eddy
            * (
                np.sin(age * (0.9 + 2.0 * random[k]) + 6.283 * random[k + 3])
                + 0.6 * np.sin(age * (0.9 + 2.2 * random[k + 6]) + 6.283 * random[k + 9])
            )
            for k in range(3)
        ]
        rise = launched.updraft * np.exp(-height / _PLUME[0] - age / _PLUME[1])
        return np.stack(
            [wind[0] * profile + swirl[0], wind[1] * profile + swirl[1], rise + swirl[2]], axis=-1
        )

    return velocity


def _store_flights(
    launched: Launches, path: NDArray[np.float32], zero: float, moment: float | None
) -> Flights:
    """Return the complete trajectories, or only their part around a model time (s)."""
    birth = launched.time - zero
    if moment is None:
        return Flights(path, birth, birth, launched.life, launched.size, _STEP)
    age = moment - launched.time
    rows = np.arange(len(age))
    ends = []
    for shift in (-0.5, 0.5):
        at = np.clip((age + shift * _MOMENT) / _STEP, 0.0, path.shape[1] - 1.001)
        low = at.astype(np.int64)
        part = (at - low)[:, None].astype(np.float32)
        ends.append(path[rows, low] * (1.0 - part) + path[rows, low + 1] * part)
    return Flights(
        np.stack(ends, axis=1),
        moment - zero - np.full(len(age), 0.5 * _MOMENT),
        birth,
        launched.life,
        launched.size,
        _MOMENT,
    )


def _landing_terrain(ground: Terrain, position: Array) -> geo.HeightField:
    """Return the terrain around the flames, on which firebrands land."""
    if len(position) == 0:
        position = np.zeros((1, 3))
    x, y = (np.linspace(position[:, k].min() - 400.0, position[:, k].max() + 400.0, 120) for k in (0, 1))
    east, north = np.meshgrid(x, y)
    return geo.HeightField(x, y, ground.up(east.ravel(), north.ravel()).reshape(east.shape))
