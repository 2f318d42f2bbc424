"""Transfer curve of sRGB (IEC 61966-2-1), for values of 0..1."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def to_linear(display: NDArray) -> NDArray:
    """Convert sRGB display values to linear light."""
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)


def to_display(light: NDArray) -> NDArray:
    """Convert linear light to sRGB display values."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)
