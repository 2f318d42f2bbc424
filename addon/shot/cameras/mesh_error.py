"""Vertical error of the terrain mesh that cameras tolerate: a screen-space error bound by distance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

UNSEEN = 50.0  # m, vertical error of ground that is neither visible nor casts visible shadows
NEAREST = 60.0  # m; nearer ground counts as at this distance
_LEAST_ERROR = 0.02  # m, smallest error; no elevation model is more accurate


class ErrorBounds(NamedTuple):
    """Error bounds of perspective cameras, m per m of distance, and of orthographic ones, m; None without."""

    angle: float | None
    pixel: float | None

    def at(self, distance: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute the bound (m) for visible ground at distances (m) from the nearest camera."""
        near = np.zeros(distance.shape) if self.angle is None else self.perspective(distance)
        return np.minimum(np.maximum(near, self.pixel or 0.0), UNSEEN)

    def perspective(self, distance: NDArray[np.float64]) -> NDArray[np.float64]:
        """Compute the bound (m) of perspective cameras at distances, m."""
        assert self.angle is not None
        return np.clip(self.angle * np.maximum(distance, NEAREST), _LEAST_ERROR, UNSEEN)


def error_bounds(error: float, pixel: tuple[float, float]) -> ErrorBounds:
    """Convert an error in pixels to bounds, by the smallest pixel sizes (see `path.finest`)."""
    angle, flat = (error * size if np.isfinite(size) else None for size in pixel)
    return ErrorBounds(angle, None if flat is None else max(flat, _LEAST_ERROR))
