"""Ember and flame gas particles: drag, wind, gravity, buoyancy and ground contact."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .geo import HeightField

def lift(density: float, air_density: float = 1.2) -> float:
    """Compute the upward acceleration by buoyancy and weight, m/s2: g (air_density / density - 1)."""

class ParticleKind:
    """Properties of particles: embers (heavier than air) or flame gas (lighter). Pairs are uniform ranges.

    Parameters
    ----------
    lift
        Acceleration by buoyancy and weight, upwards, m/s2 (see `lift`).
    relaxation
        Relaxation time of the drag, s. The terminal speed is |lift| relaxation.
    rise, spread
        Upward and horizontal speed at launch, m/s.
    life
        Lifetime, s.
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
        """Acceleration by buoyancy and weight, upwards, m/s2."""
    @property
    def relaxation(self) -> list[float]:
        """Range of the relaxation time, s."""
    @property
    def rise(self) -> list[float]:
        """Range of the upward speed at launch, m/s."""
    @property
    def spread(self) -> list[float]:
        """Range of the horizontal speed at launch, m/s."""
    @property
    def life(self) -> list[float]:
        """Range of the lifetime, s."""

class ParticleCloud:
    """The n particles at one time, ordered by source and number."""

    @property
    def source(self) -> NDArray[np.int64]:
        """(n,) index of the source."""
    @property
    def number(self) -> NDArray[np.int64]:
        """(n,) index of the particle within its source; source and number identify a particle."""
    @property
    def position(self) -> NDArray[np.float64]:
        """(n, 3) m."""
    @property
    def velocity(self) -> NDArray[np.float64]:
        """(n, 3) m/s; 0 for landed particles."""
    @property
    def age(self) -> NDArray[np.float64]:
        """(n,) s."""
    @property
    def life(self) -> NDArray[np.float64]:
        """(n,) s."""
    @property
    def landed(self) -> NDArray[np.bool_]:
        """(n,) True for particles on the ground."""
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
    """Advance particles by one step with the exact solution of dv/dt = (wind - v) / relaxation + lift.

    The solution is stable for any step and for relaxation times from 0 (passive tracer) to infinity (free
    fall). A particle that reaches the ground stays there.

    Parameters
    ----------
    position, velocity
        (n, 3) m and m/s.
    wind, wind_middle, wind_end
        (3,) or (n, 3) wind at the start, middle and end of the step, m/s. Without `wind_middle` it changes
        linearly, without `wind_end` it is constant.
    step
        Duration, s.
    relaxation
        Relaxation time of the drag, s; broadcasts to (n,).
    lift
        Acceleration by buoyancy and weight, upwards, m/s2; broadcasts to (n,).
    landed
        True for particles that do not move; broadcasts to (n,).
    ground
        Ground heights; None for no ground.

    Returns
    -------
    position, velocity, landed
        New (n, 3), (n, 3) and (n,).
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
    """Compute the particles of m sources at a time (s), in closed form: no earlier state is needed.

    A landed particle stays on the ground until the end of its life.

    Parameters
    ----------
    time
        Time, s.
    position
        (m, 3) centres of the sources, m.
    start, end
        (m,) time of the first and the last launch, s.
    rate
        (m,) particles per second.
    kind
        Properties of the particles.
    wind, wind_time
        (k, 3), or (k, m, 3) per source, m/s, at ascending times (k,) s; linear in between and constant
        outside.
    id
        (m,) key of each source's random numbers, such as its cell. Default: its index.
    size
        Side of the square in which particles start, m.
    ground
        Ground heights; None for no ground.
    seed
        Seed of the random numbers.
    """
