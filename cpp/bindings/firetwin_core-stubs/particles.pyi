"""Particles of embers and flame gas: drag, wind, gravity, buoyancy and contact with the ground."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import HeightField

def lift(density: float, air_density: float = 1.2) -> float:
    """Weight less buoyancy of a particle, upwards, m/s2: g (air_density / density - 1)."""

class ParticleKind:
    """Particle properties: embers (heavier than air) or flame gas (lighter). Pairs are uniform ranges.

    `lift` m/s2 upwards; `relaxation` of the drag, s (terminal speed = |lift| relaxation); `rise` upward and
    `spread` sideways speed at launch, m/s; `life` s.
    """

    def __init__(
        self,
        lift: float,
        relaxation: tuple[float, float],
        rise: tuple[float, float],
        spread: tuple[float, float],
        life: tuple[float, float],
    ) -> None: ...
    @property
    def lift(self) -> float:
        """m/s2 upwards."""
    @property
    def relaxation(self) -> list[float]:
        """s, least and most."""
    @property
    def rise(self) -> list[float]:
        """m/s upwards at launch, least and most."""
    @property
    def spread(self) -> list[float]:
        """m/s sideways at launch, least and most."""
    @property
    def life(self) -> list[float]:
        """s, least and most."""

class ParticleCloud:
    """The n particles at one time, in order of source and number."""

    @property
    def source(self) -> NDArray[np.int64]:
        """(n,) index of the source."""
    @property
    def number(self) -> NDArray[np.int64]:
        """(n,) number of the particle within its source; source and number identify a particle."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) m."""
    @property
    def velocity(self) -> NDArray[np.float64]:
        """(n, 3) m/s, 0 for those that landed."""
    @property
    def age(self) -> NDArray[np.float64]:
        """(n,) s."""
    @property
    def life(self) -> NDArray[np.float64]:
        """(n,) s."""
    @property
    def landed(self) -> NDArray[np.bool_]:
        """(n,)"""
    def __len__(self) -> int: ...

def advance(
    position: ArrayLike,
    velocity: ArrayLike,
    wind: ArrayLike,
    step: float,
    relaxation: ArrayLike,
    lift: ArrayLike = -9.80665,
    wind_end: ArrayLike | None = None,
    wind_middle: ArrayLike | None = None,
    landed: ArrayLike = False,
    ground: HeightField | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """One step (s) of position (n, 3) m and velocity (n, 3) m/s -> new position, velocity, landed (n,).

    Solves dv/dt = (wind - v) / relaxation + lift exactly, for relaxation 0 (carried by the wind) to infinity
    (free fall) and any step, in a wind (3,) or (n, 3) m/s that changes linearly to `wind_end` within the step, or
    as the parabola through `wind_middle`. A particle that meets the ground stays there, and so does one that has `landed`.
    """

def state(
    time: float,
    position: ArrayLike,
    start: ArrayLike,
    end: ArrayLike,
    rate: ArrayLike,
    kind: ParticleKind,
    wind: ArrayLike,
    wind_time: ArrayLike = [0.0],
    id: ArrayLike | None = None,
    size: float = 0.0,
    ground: HeightField | None = None,
    seed: int = 0,
) -> ParticleCloud:
    """Particles at a time (s) from m sources, in closed form: no earlier state is needed.

    Sources at position (m, 3) launch `rate` (m,) particles a second from `start` to `end` (m,) s, in a square
    `size` m wide. `wind` (k, 3), or (k, m, 3) for each source, in m/s at `wind_time` (k,) s, is linear between
    and constant outside. `id` (m,) keys a source's random numbers (its cell, for instance; default its
    index). A particle stays where it lands until its life ends.
    """
