"""Fuel models: fuel load and burn-out time by number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SFIRE = (0.166, 0.897, 0.675, 2.468, 0.785, 1.345, 1.092, 1.121, 0.780, 2.694, 2.582, 7.749, 13.024)
"""Fuel load, kg/m2, of Anderson's models 1 to 13 in WRF-SFIRE and CFBM (fgi of namelist.fire)."""

_WEIGHT = (7, 7, 7, 180, 100, 100, 100, 900, 900, 900, 900, 900, 900)
"""s, `weight` of the same models there: remaining fuel falls by e in weight / 0.85 seconds."""

# Sum of dead (1, 10, 100 h) and live loads, kg/m2: Anderson 1982 (GTR INT-122) and Scott and Burgan 2005
# (RMRS-GTR-153), tables of loads in lb/ft2 times 4.88243.
_LOAD = {
    **{1: 0.166, 2: 0.898, 3: 0.674, 4: 3.593, 5: 0.786, 6: 1.348, 7: 1.094, 8: 1.123, 9: 0.781, 10: 2.695},
    **{11: 2.583, 12: 7.748, 13: 13.026, 101: 0.09, 102: 0.247, 103: 0.449, 104: 0.482, 105: 0.65},
    **{106: 0.785, 107: 1.434, 108: 1.973, 109: 2.466, 121: 0.303, 122: 0.583, 123: 0.729, 124: 2.869},
    **{141: 0.437, 142: 1.872, 143: 2.163, 144: 1.065, 145: 1.928, 146: 1.289, 147: 3.228, 148: 2.387},
    **{149: 3.475, 161: 0.83, 162: 0.941, 163: 0.728, 164: 1.457, 165: 3.138, 181: 1.524, 182: 1.323},
    **{183: 1.233, 184: 1.39, 185: 1.805, 186: 1.076, 187: 2.197, 188: 1.861, 189: 3.16},
    **{201: 3.475, 202: 2.858, 203: 2.522, 204: 3.138},
}

HEAVIEST = max(_LOAD.values())
"""Largest fuel load of a standard model, kg/m2: Anderson's 13."""


def loads(category: NDArray, table: str = "standard") -> NDArray[np.float32]:
    """Look up the fuel load (kg/m2) by fuel model number; 0 if unburnable. `table`: "sfire" or "standard"."""
    known = dict(enumerate(SFIRE, 1)) if table == "sfire" else _LOAD
    return _look_up(category, known, 0.0)


def burn_out(category: NDArray) -> NDArray[np.float32]:
    """Look up the burn-out time (s) by fuel model: from front arrival until a spot has burned out.

    The release has the form of `heat_from_intensity`, whose mean time is a third of its end. So it is three
    mean burning times of WRF-SFIRE (weight / 0.85). Scott and Burgan's models take the weight of Anderson's
    of the same kind: grass 7, shrubs 100, timber and slash 900 s.
    """
    weight = dict(enumerate(_WEIGHT, 1))
    kinds = {10: 7, 12: 7, 14: 100, 16: 900, 18: 900, 20: 900}
    weight |= {number: kinds[number // 20 * 2] for number in _LOAD if number > 100}
    return _look_up(category, {number: 3 * each / 0.85 for number, each in weight.items()}, 3 * 100 / 0.85)


def _look_up(category: NDArray, known: dict[int, float], otherwise: float) -> NDArray[np.float32]:
    table = np.full(257, otherwise, np.float32)
    for number, value in known.items():
        table[number] = value
    whole = np.nan_to_num(np.asarray(category, np.float64), nan=256.0, posinf=256.0, neginf=256.0)
    return table[np.clip(np.rint(whole), 0, 256).astype(np.int64)]
