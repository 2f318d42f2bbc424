"""Radiometry, thermal views and image files."""

from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

def radiance(kelvin: ArrayLike, band: tuple[float, float] = (8.0, 14.0)) -> NDArray[np.float64]:
    """Planck radiance of a black body (K) over a band (micrometres) -> W m-2 sr-1."""

def brightness_temperature(
    radiance: ArrayLike, band: tuple[float, float] = (8.0, 14.0)
) -> NDArray[np.float64]:
    """Brightness temperature of a band radiance: the inverse of `radiance` -> K."""

def spectral_radiance(kelvin: ArrayLike, wavelength: float) -> NDArray[np.float64]:
    """Planck's law at a wavelength (micrometres) -> W m-2 sr-1 um-1."""

def spectral_temperature(radiance: ArrayLike, wavelength: float) -> NDArray[np.float64]:
    """The inverse of `spectral_radiance`, in closed form -> K."""

class PlanckTable:
    """`radiance` and its inverse for pictures: cubic interpolation of logarithms between `knots` knots.

    Between 150 and 3000 K both are within 1e-9 of the integral's values (relative, of bands from 3 to 14 um
    with 512 knots), before rounding to float32; beyond, the integral itself is used.
    """

    def __init__(self, band: tuple[float, float] = (8.0, 14.0), knots: int = 512) -> None: ...
    def radiance(self, kelvin: ArrayLike) -> NDArray[np.float32]:
        """Radiance of black bodies (K) over the band -> W m-2 sr-1."""

    def brightness_temperature(self, radiance: ArrayLike) -> NDArray[np.float32]:
        """The inverse of `radiance` -> K."""

    def detect(
        self,
        radiance: ArrayLike,
        *,
        blur: float = 0.0,
        noise: float = 0.0,
        saturation: float = 0.0,
        bits: int = 0,
        key: int = 0,
    ) -> tuple[NDArray[np.float32], NDArray[np.uint16] | None]:
        """Detector model: blur, noise (NETD), saturation and quantisation of at-sensor radiance (h, w) W m-2 sr-1.

        `blur`: standard deviation of the Gaussian point spread function, pixels; edge pixels are replicated. `noise`: noise-equivalent temperature difference of black bodies at 300 K; Gaussian, by
        `key` and the pixel alone. `saturation`: brightness temperature at full scale, K; 0: none. `bits`: of
        counts proportional to radiance, at most 16 and with a saturation; 0: not quantised.

        Returns
        -------
        measured
            (h, w) radiance, W m-2 sr-1.
        counts
            (h, w) whole numbers; None without bits.
        """

def palettes() -> list[str]:
    """Names of the palettes that `colour` knows."""

def palette(name: str) -> NDArray[np.float64]:
    """A palette's colours (n, 3), 0..1, at equal steps from cold to hot."""

def colour(
    kelvin: ArrayLike, low: float, high: float, palette: str = "white-hot", knee: float = 0.0
) -> NDArray[np.float32]:
    """Display colours (h, w, 3) of temperatures (h, w) K.

    Each is the palette at (kelvin - low) / (high - low); with a `knee` (K) at
    log(1 + (kelvin - low) / knee) / log(1 + (high - low) / knee), which gives what is within some knees of `low`
    more of the palette. Beyond the ends as at the nearer one, NaN as at `low`. "inferno" is matplotlib's by 17 stops, within 0.03.
    """

def thermal_composite(
    rgb: ArrayLike, kelvin: ArrayLike, low: float, high: float, strength: float = 1.0
) -> NDArray[np.float32]:
    """The paper's thermal view: clamp(pixels (h, w, 3) in 0..1 + strength * gradient, 0, 1).

    The gradient of the temperatures (h, w) K is black, purple, red, orange, yellow and white at equal steps
    from `low` to `high`, linear between; beyond them and NaN as at the nearer end and at `low`.

    8-bit pixels are refused: divide them by 255.
    """

def overlay(
    below: ArrayLike,
    above: ArrayLike,
    kelvin: ArrayLike,
    start: float,
    full: float,
    opacity: float = 1.0,
) -> NDArray[np.float32]:
    """Hot spots `above` over the picture `below`, both (h, w, 3), by temperatures (h, w) K.

    below + opacity * clamp((kelvin - start) / (full - start), 0, 1) * (above - below); NaN shows `below`.
    """

def eye_dome(depth: ArrayLike, strength: float = 4.0, radius: int = 1) -> NDArray[np.float32]:
    """Eye-dome lighting (C. Boucheny 2009) of depths (h, w) m -> (h, w) factors 0..1 for a picture.

    exp(-strength * s), with s the mean over eight neighbours `radius` pixels away of how many times (as a
    logarithm to base 2) the pixel is deeper. NaN and depths beyond 1e9 m count as 1e9 m.
    """

def read_image(path: str | PathLike[str]) -> NDArray[np.float32]:
    """PNG, EXR, TIFF or JPEG (by content) -> (h, w, channels)."""

def decode_image(data: bytes, name: str = "image") -> NDArray[np.float32]:
    """Decode a PNG, EXR, TIFF or JPEG in memory.

    The format is detected from the magic bytes. The limits are those of `read_image`; nothing is written to disk.

    Parameters
    ----------
    data
        The encoded image.
    name
        Stands for the path in error messages, for example a URL.

    Returns
    -------
    (h, w, channels) pixels, top row first. Integers are scaled to 0..1, without a change of colour space.

    Raises
    ------
    InputError
        The data is empty, damaged or in another format, or exceeds 256 million values or 64 channels.
    """

def encode_png(pixels: ArrayLike) -> bytes:
    """Encode (h, w) or (h, w, channels) pixels as an 8-bit PNG; values are clamped to 0..1.

    Raises
    ------
    InputError
        The image has no pixels or more than a PNG can hold.
    """

def read_channels(path: str | PathLike[str]) -> dict[str, NDArray[np.float32]]:
    """The same file as one array (h, w) for each channel, by name; of an EXR also those of its layers."""

def write_image(
    path: str | PathLike[str],
    pixels: ArrayLike,
    metadata: dict[str, str] | None = None,
    channels: list[str] | None = None,
) -> None:
    """Write (h, w) or (h, w, c) pixels to a temporary file that is renamed once it is whole and on the disk.

    .png as 8-bit (values clamped to 0..1), .exr as 32-bit float with ZIP and these names of `channels`.

    Raises
    ------
    InputError
        The file cannot be written, as on a full disk; nothing is left of it, and what was there stays.
    """
