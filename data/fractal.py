"""Seeded noise fields with the self-similar spectrum of natural terrain and vegetation."""

import numpy as np
from numpy.typing import NDArray


def fractal(
    shape: tuple[int, int],
    seed: int,
    longest: float,
    shortest: float = 2.0,
    roughness: float = 2.0,
) -> NDArray[np.float64]:
    """Gaussian noise (shape) of mean 0 and standard deviation 1, made in Fourier space.

    Parameters
    ----------
    shape
        Rows and columns.
    seed
        The same seed gives the same field.
    longest, shortest
        Wavelengths in cells between which there is power.
    roughness
        Amplitude falls with wavenumber as k^-roughness; 2 is like eroded terrain, 1 like patchy vegetation.
    """
    ny, nx = shape
    padded = (ny + int(longest), nx + int(longest))  # the noise is periodic: cut the wrap-around off
    white = np.random.default_rng(seed).standard_normal(padded)
    k = np.hypot(np.fft.fftfreq(padded[0])[:, None], np.fft.rfftfreq(padded[1])[None, :])
    band = (k > 1 / longest) & (k < 1 / shortest)
    amplitude = np.where(band, np.maximum(k, 1e-9) ** -roughness, 0.0)
    field = np.fft.irfft2(np.fft.rfft2(white) * amplitude, s=padded)[:ny, :nx]
    return (field - field.mean()) / field.std()


def smooth(field: NDArray, sigma: float) -> NDArray[np.float64]:
    """Gaussian blur with a standard deviation of `sigma` cells; edges are mirrored."""
    reach = int(4 * sigma + 1)
    weight = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weight /= weight.sum()
    result = np.asarray(field, dtype=float)
    for axis in (0, 1):
        padding = [(0, 0), (0, 0)]
        padding[axis] = (reach, reach)
        padded = np.pad(result, padding, mode="symmetric")
        length = padded.shape[axis]
        spectrum = np.fft.rfft(padded, axis=axis)
        kernel = np.zeros(length)
        kernel[: 2 * reach + 1] = weight
        kernel = np.fft.rfft(np.roll(kernel, -reach))
        spectrum *= kernel[:, None] if axis == 0 else kernel[None, :]
        blurred = np.fft.irfft(spectrum, n=length, axis=axis)
        result = blurred[reach:-reach] if axis == 0 else blurred[:, reach:-reach]
    return result
