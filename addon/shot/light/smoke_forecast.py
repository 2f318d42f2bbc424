"""Smoke of a weather forecast (HRRR-Smoke in GRIB2) over a run: density at 8 m, and column mass.

HRRR has ``MASSDEN`` (kg/m3, 8 m above the ground) and ``COLMD`` (kg/m2, entire atmosphere) of smoke. Column
over density is the height of the haze: an exponential layer with both values has it as scale height.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...errors import input_error
from ...run import times
from ...run.models import grib2
from ...run.models.grib2 import GribField
from ..schema import fields
from ..sections.light import Light
from .smoke_haze import extinction

_DENSITY, _COLUMN, _RATIO = "MASSDEN", "COLMD", "MASSMR"
_LEVELS = {"8-HTGL", "0-EATM"}
_UNITS = {_DENSITY: "kg/(m^3)", _COLUMN: "kg/(m^2)"}
_DENSEST = 0.01  # kg/m3; more is in another unit: measured wildfire plumes have some 1e-5
_CONTRAST = 3.912  # Koschmieder: optical depth at the visual range, with a contrast of 2 %


@dataclass(frozen=True, eq=False)
class Smoke:
    """Smoke at a time, in cells of the model grid (ny, nx).

    Attributes
    ----------
    density, column
        ug/m3 near the ground, and mg/m2.
    """

    issued: datetime
    valid: datetime
    density: NDArray[np.float64]
    column: NDArray[np.float64]

    @property
    def height(self) -> float:
        """Scale height of a layer with the means of both, m; 0 without smoke."""
        mean = float(self.density.mean())
        return 1e3 * float(self.column.mean()) / mean if mean > 0.0 else 0.0


def read(run: Run, paths: list[Path]) -> list[Smoke]:
    """Read the smoke over a run at each valid time.

    Raises
    ------
    InputError
        The files have no smoke, zeros everywhere, other units or gaps, or do not contain the run.
    """
    latitude, longitude = np.meshgrid(run.latitude, run.longitude, indexing="ij")
    box = (latitude.min(), longitude.min(), latitude.max(), longitude.max())
    found = grib2.read(paths, {_DENSITY, _COLUMN, _RATIO}, _LEVELS, box)
    densities, columns = ([each for each in found if each.element == name] for name in (_DENSITY, _COLUMN))
    if not densities and any(each.element == _RATIO for each in found):
        reason = "has smoke as a mixing ratio (mass per mass of air), not a density (MASSDEN, kg/m3)"
        raise input_error(paths[0], f"{reason}; give the density: ug/kg times the density of air is ug/m3")
    if not densities or [each.valid for each in densities] != [each.valid for each in columns]:
        reason = "has no pair of MASSDEN at 8 m and COLMD"
        raise input_error(paths[0], f"{reason}; give wrfsfc files of HRRR since December 2020")
    for each in (*densities, *columns):
        _check(each)
    return [
        Smoke(low.issued, low.valid, 1e9 * low.at(latitude, longitude), 1e6 * all_.at(latitude, longitude))
        for low, all_ in zip(densities, columns, strict=True)
    ]


def _check(field: GribField) -> None:
    """Check unit and values.

    Raises
    ------
    InputError
        They are not of smoke.
    """
    if field.unit != _UNITS[field.element]:
        reason = f"has {field.element} in {field.unit or 'no unit'}, not {_UNITS[field.element]}"
        raise input_error(field.path, f"{reason}; a mixing ratio is not a density")
    if not (field.values >= 0.0).all():
        raise input_error(field.path, f"has {field.element} that is negative or not a number over the run")
    if field.largest == 0.0:
        reason = f"has {field.element} of 0 everywhere, and a field of zeros is not clean air"
        raise input_error(field.path, f"{reason}; the forecast has no smoke: give another file")
    if field.element == _DENSITY and field.largest > _DENSEST:
        reason = f"has up to {field.largest:.3g} kg/m3 of smoke, most likely in another unit"
        raise input_error(field.path, f"{reason}; give MASSDEN in kg/m3")


def at(smokes: list[Smoke], time: datetime) -> Smoke:
    """Interpolate linearly to a time.

    Raises
    ------
    InputError
        No forecast is valid at it.
    """
    seconds = [(each.valid - time).total_seconds() for each in smokes]
    after = next((index for index, each in enumerate(seconds) if each >= 0.0), None)
    if after is None or (after == 0 and seconds[0] > 0.0):
        have = " to ".join(times.iso(each.valid) for each in (smokes[0], smokes[-1]))
        raise input_error(times.iso(time), f"no smoke is valid at this time; the files have {have}")
    if seconds[after] == 0.0:
        return smokes[after]
    part = -seconds[after - 1] / (seconds[after] - seconds[after - 1])
    one, other = smokes[after - 1], smokes[after]
    density, column = (
        getattr(one, name) * (1.0 - part) + getattr(other, name) * part for name in ("density", "column")
    )
    return Smoke(one.issued, time, density, column)


def page(smokes: list[Smoke], chosen: Smoke, zone: str) -> str:
    """Format a table by valid time, and the lines of a scene file for a chosen time."""
    lines = [f"smoke, issued {', '.join(sorted({times.iso(each.issued) for each in smokes}))}", ""]
    heads = "valid", "ug/m3, mean (lowest, highest)", "mg/m2", "range, km", "depth"
    lines.append("{:22} {:>30} {:>8} {:>10} {:>6}".format(*heads))
    for each in smokes:
        mean, low, high = (float(of(each.density)) for of in (np.mean, np.min, np.max))
        sight = _CONTRAST / extinction(mean) / 1e3 if mean > 0.0 else np.inf
        text = f"{mean:.1f} ({low:.1f}, {high:.1f})"
        depth = extinction(mean) * each.height
        when = times.text(each.valid, zone)
        lines.append(f"{when:22} {text:>30} {each.column.mean():8.1f} {sight:10.3g} {depth:6.2f}")
    lines += ["", f"[light] # {times.text(chosen.valid, zone)}, mean of the run"]
    lines.append(f"smoke = {float(chosen.density.mean()):.1f}")
    if chosen.height:
        height, note = _allowed(chosen.height)
        lines.append(f"smoke_height = {height:.1f}{note}")
    return "\n".join(lines)


def _allowed(height: float) -> tuple[float, str]:
    """Limit a height to the range of its key, and return a comment if it was beyond."""
    key = next(each.key for each in fields(Light) if each.name == "smoke_height")
    assert key.at_least is not None
    assert key.at_most is not None
    limited = float(np.clip(height, key.at_least, key.at_most))
    return limited, "" if limited == height else f" # {height:.0f} m is beyond its limits"
