"""Radiance of black bodies and clear, cold air, for `volume.march_infrared`."""

import numpy as np

PLANCK = dict(coldest=180.0, kelvin_step=2.0)
KELVINS = np.arange(180.0, 1900.0, 2.0)
EVERY = 5.670374e-8 * KELVINS**4 / np.pi  # W m-2 sr-1, of all wavelengths
EMPTY = dict(
    kelvin=np.full((1, 1), 300.0),
    elevation=np.zeros((1, 1)),
    corner=(0.0, 0.0),
    spacing=(1.0, 1.0),
    lapse=0.0,
    absorption=0.0,
)
