"""Radiometry, detector model, thermal views and image files."""

from collections.abc import Mapping, Sequence
from numbers import Rational
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike, NDArray

def radiance(kelvin: ArrayLike, band: tuple[float, float] = (8.0, 14.0)) -> NDArray[np.float64]:
    """Compute the radiance of black bodies (K) over a band (micrometres), W m-2 sr-1."""

def brightness_temperature(
    radiance: ArrayLike, band: tuple[float, float] = (8.0, 14.0)
) -> NDArray[np.float64]:
    """Compute the brightness temperature of a band radiance, K: the inverse of `radiance`."""

def spectral_radiance(kelvin: ArrayLike, wavelength: float) -> NDArray[np.float64]:
    """Compute Planck's law at a wavelength (micrometres), W m-2 sr-1 um-1."""

def spectral_temperature(radiance: ArrayLike, wavelength: float) -> NDArray[np.float64]:
    """Compute the temperature of a spectral radiance, K: the inverse of `spectral_radiance`."""

class PlanckTable:
    """Lookup table of `radiance` and its inverse for images: cubic interpolation of logarithms.

    Between 150 and 3000 K the relative error is below 1e-9 before rounding to float32, for bands from 3 to 14
    um and 512 knots. Outside this range the integral is used.
    """

    def __init__(self, band: tuple[float, float] = (8.0, 14.0), knots: int = 512) -> None: ...
    def radiance(self, kelvin: ArrayLike) -> NDArray[np.float32]:
        """Compute the radiance of black bodies (K) over the band, W m-2 sr-1."""

    def brightness_temperature(self, radiance: ArrayLike) -> NDArray[np.float32]:
        """Compute the brightness temperature of a radiance, K."""

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
        """Apply the detector model to at-sensor radiance (h, w), W m-2 sr-1.

        Parameters
        ----------
        radiance
            (h, w) W m-2 sr-1.
        blur
            Standard deviation of the Gaussian point spread function, pixels; edge pixels are replicated.
        noise
            Noise-equivalent temperature difference (NETD) at 300 K, K. The noise is Gaussian and depends only
            on `key` and the pixel.
        saturation
            Brightness temperature at full scale, K; 0: no saturation.
        bits
            Bits of the counts, which are proportional to radiance; at most 16, requires a saturation. 0: not
            quantised.
        key
            Key of the noise.

        Returns
        -------
        measured
            (h, w) radiance, W m-2 sr-1.
        counts
            (h, w) integers; None without `bits`.
        """

def palettes() -> list[str]:
    """List the names of the palettes."""

def palette(name: str) -> NDArray[np.float64]:
    """Return a palette's colours (n, 3), 0..1, at equal steps from cold to hot."""

def colour(
    kelvin: ArrayLike, low: float, high: float, palette: str = "white-hot", knee: float = 0.0
) -> NDArray[np.float32]:
    """Map temperatures (h, w) in K to display colours (h, w, 3).

    The palette is evaluated at (kelvin - low) / (high - low), or with a `knee` (K) at
    log(1 + (kelvin - low) / knee) / log(1 + (high - low) / knee), which expands temperatures near `low`.
    Temperatures are clamped to low..high; NaN is shown as `low`. "inferno" approximates matplotlib's by 17
    stops, within 0.03.
    """

def thermal_composite(
    rgb: ArrayLike, kelvin: ArrayLike, low: float, high: float, strength: float = 1.0
) -> NDArray[np.float32]:
    """Compose the thermal view of the FIRETWIN paper: clamp(rgb + strength * gradient, 0, 1).

    `rgb` has the shape (h, w, 3) and values 0..1; divide 8-bit pixels by 255. The gradient maps the
    temperatures (h, w) in K from `low` to `high` to black, purple, red, orange, yellow and white,
    interpolated linearly. NaN is shown as `low`.
    """

def overlay(
    below: ArrayLike,
    above: ArrayLike,
    kelvin: ArrayLike,
    start: float,
    full: float,
    opacity: float = 1.0,
) -> NDArray[np.float32]:
    """Blend hot spots `above` over the image `below`, both (h, w, 3), by temperatures (h, w) in K.

    Returns below + opacity * clamp((kelvin - start) / (full - start), 0, 1) * (above - below). NaN shows
    `below`.
    """

def eye_dome(depth: ArrayLike, strength: float = 4.0, radius: int = 1) -> NDArray[np.float32]:
    """Compute eye-dome lighting (C. Boucheny 2009) of depths (h, w) in m: shading factors (h, w), 0..1.

    The factor is exp(-strength * s), where s is the mean over eight neighbours at `radius` pixels of
    max(0, log2(depth) - log2(neighbour's depth)). NaN and depths above 1e9 m are set to 1e9 m.
    """

def read_image(path: str | PathLike[str]) -> NDArray[np.float32]:
    """Read a PNG, EXR, TIFF or JPEG file: (h, w, channels) pixels, top row first.

    The format is detected from the magic bytes. Integers are scaled to 0..1, without a change of colour
    space.

    Raises
    ------
    InputError
        The file is missing, damaged or in another format, or exceeds 256 million values or 64 channels.
    """

def decode_image(data: bytes, name: str = "image") -> NDArray[np.float32]:
    """Decode a PNG, EXR, TIFF or JPEG in memory.

    The format is detected from the magic bytes. The limits of `read_image` apply; nothing is written to
    disk.

    Parameters
    ----------
    data
        The encoded image.
    name
        Replaces the path in error messages, for example a URL.

    Returns
    -------
    pixels
        (h, w, channels), top row first. Integers are scaled to 0..1, without a change of colour space.

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
    """Read an image file as one array (h, w) per channel name, including the layers of an EXR."""

class TimeCode:
    """SMPTE ST 12-1 time code of a frame."""

    def __init__(
        self,
        hours: int,
        minutes: int,
        seconds: int,
        frame: int,
        *,
        drop_frame: bool = False,
        second_field: bool = False,
    ) -> None:
        """Make a time code.

        Parameters
        ----------
        hours, minutes, seconds
            At most 23, 59 and 59.
        frame
            At most 29. Rates above 30 frames per second count pairs of frames.
        drop_frame
            The count skips numbers, to follow the clock at 29.97 frames per second.
        second_field
            Second frame of a pair.

        Raises
        ------
        ValueError
            A number is out of range.
        """

def write_image(
    path: str | PathLike[str],
    pixels: ArrayLike,
    metadata: Mapping[str, str | float | Rational | TimeCode | ArrayLike] | None = None,
    names: Sequence[str] | None = None,
    *,
    half: bool = False,
    one_line: bool = False,
) -> None:
    """Write (h, w) or (h, w, c) pixels to a .png (8 bit, clamped to 0..1) or .exr file (lossless).

    Writing is atomic: a temporary file is renamed after it has been flushed to the disk.

    Parameters
    ----------
    path
        File name ending in .png or .exr.
    pixels
        (h, w) or (h, w, c).
    metadata
        Attributes of the header by OpenEXR's names. The value determines the type: text, `int`, `float`,
        `fractions.Fraction` (rational), `TimeCode`, arrays of 2 or 3 (v2f, v3f), and of 4 by 4 (m44f, for row
        vectors). ``capDate`` is the start of 1970 unless given. A PNG keeps texts only.
    names
        Channel names of an EXR, up to 64. Default: R, G, B...
    half
        Write 16-bit floats to an EXR, with finite values limited to 65504; otherwise 32-bit floats.
    one_line
        Compress each line of an EXR separately (ZIPS); otherwise 16 lines together (ZIP).

    Raises
    ------
    InputError
        The file cannot be written, for example on a full disk. An existing file is not changed.
    ValueError
        An array in `metadata` has another shape, or `names` another length than the channels.
    """
