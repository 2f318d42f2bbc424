"""Radiometry, thermal views and image files."""

from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

def radiance(kelvin: ArrayLike, band: tuple[float, float] = (8.0, 14.0)) -> NDArray[np.float64]:
    """Planck radiance of a black body (K) over a band (micrometres) -> W m-2 sr-1."""

def brightness_temperature(
    radiance: ArrayLike, band: tuple[float, float] = (8.0, 14.0)
) -> NDArray[np.float64]:
    """The inverse of `radiance` -> K."""

def thermal_composite(
    rgb: ArrayLike, kelvin: ArrayLike, low: float, high: float, strength: float = 1.0
) -> NDArray[np.float32]:
    """The paper's thermal view: clamp(pixels (h, w, 3) in 0..1 + strength * gradient, 0, 1).

    The gradient of the temperatures (h, w) K is black, purple, red, orange, yellow and white at equal steps
    from `low` to `high`, linear between; beyond them and NaN as at the nearer end and at `low`.

    8-bit pixels are refused: divide them by 255.
    """

def read_image(path: str | PathLike[str]) -> NDArray[np.float32]:
    """PNG, EXR, TIFF or JPEG (by content) -> (h, w, channels)."""

def write_image(path: str | PathLike[str], pixels: ArrayLike, metadata: dict[str, str] | None = None) -> None:
    """Write (h, w) or (h, w, c) pixels to a temporary file that is renamed once it is whole and on the disk.

    .png as 8-bit (values clamped to 0..1), .exr as 32-bit float with ZIP.

    Raises
    ------
    InputError
        The file cannot be written, as on a full disk; nothing is left of it, and what was there stays.
    """
