"""A run of a few cells, with a synthetic fire, for tests."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

NY, NX, FY, FX, NT = 4, 5, 8, 10, 3

RUN_TOML = """\
name = "Small"
start = 2014-09-16T21:45:00-07:00
interval_s = 60.0
vertical = "orthometric"
no_data = -9999.0
synthetic = true
event = "king_fire"

[units]
elevation = "m"
heat_flux = "W/m2"
"""


def small_fields() -> dict[str, NDArray]:
    """All fields of a run of NY x NX cells, FY x FX fuel cells and NT times."""
    rng = np.random.default_rng(1)
    flux = np.zeros((NT, NY, NX), np.float32)
    flux[1, 1, 2] = 1000.5
    flux[2, 1, 2] = 2000.25
    flux[2, 2, 2] = 500.0
    return {
        "latitude": 38.9 + 0.003 * np.arange(NY),
        "longitude": -120.6 + 0.004 * np.arange(NX),
        "elevation": rng.uniform(900, 1500, (NY, NX)).astype(np.float32),
        "fuel_latitude": 38.9 + 0.003 * (np.arange(FY) * 0.5 - 0.25),
        "fuel_longitude": -120.6 + 0.004 * (np.arange(FX) * 0.5 - 0.25),
        "surface_fuel": rng.uniform(0, 2, (FY, FX)).astype(np.float32),
        "canopy_fuel": rng.uniform(0, 3, (FY, FX)).astype(np.float32),
        "heat_flux": flux,
        "temperature": 300 + flux / 10,
        "wind_east": np.full_like(flux, 5.0),
        "wind_north": np.full_like(flux, -2.5),
    }


def write_text(path: Path, values: NDArray) -> None:
    """One row per line, with enough digits to restore each value."""
    digits = "%.9g" if values.dtype == np.float32 else "%.17g"
    np.savetxt(path, np.atleast_2d(values), fmt=digits)


def write_field(folder: Path, name: str, values: NDArray, form: str) -> None:
    if form == "npy":
        np.save(folder / f"{name}.npy", values)
    elif values.ndim == 3:
        (folder / name).mkdir()
        for index, frame in enumerate(values):
            write_text(folder / name / f"{index:06d}.txt", frame)
    else:
        write_text(folder / f"{name}.txt", values)
