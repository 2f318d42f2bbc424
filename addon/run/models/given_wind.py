"""Prescribed wind: input wind of a fire model, at the times of a run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Wind = Callable[[float], tuple[NDArray, NDArray]]
"""Wind (ny, nx) along a grid's columns and rows, m/s, at a time (s)."""


def steps(u: NDArray, v: NDArray, begin: float, lasts: float) -> Wind:
    """Interpolate as steps: each value (nt, ny, nx) lasts `lasts` seconds, the end values longer."""

    def at(time: float) -> tuple[NDArray, NDArray]:
        index = int(np.clip((time - begin) // lasts, 0, len(u) - 1)) if len(u) > 1 else 0
        return u[index], v[index]

    return at
