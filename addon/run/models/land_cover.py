"""Legend of a fuel layer: fuel model numbers of Scott and Burgan, or land cover codes of Corine.

The meaning of the numbers in ForeFire's landscape is in its fuels table. Without the table the numbers
themselves decide, if they belong to one legend alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..fuel_category import BARE, FARMLAND, NUMBERS, SNOW, UNBURNABLE, URBAN, WATER

# Codes of level 3 of the Corine nomenclature (European Environment Agency, "CORINE Land Cover nomenclature
# guidelines", 2019), and the fuel model of Scott and Burgan of similar vegetation (assumed).
_CORINE = {
    **dict.fromkeys((111, 112, 121, 122, 123, 124, 131, 132, 133, 141, 142), URBAN),
    **{211: 102, 212: FARMLAND, 213: FARMLAND, 221: FARMLAND, 222: 122, 223: 122},  # arable, vines, orchards
    **{231: 102, 241: 102, 242: 102, 243: 122, 244: 122},  # pastures, mixed farmland
    **{311: 182, 312: 188, 313: 183},  # broad-leaved, coniferous and mixed forest
    **{321: 104, 322: 145, 323: 147, 324: 142},  # grassland, heath, sclerophyllous shrubs, young forest
    **{331: BARE, 332: BARE, 333: 101, 334: BARE, 335: SNOW},
    **{411: 103, 412: 103, 421: 103, 422: WATER, 423: WATER},
    **dict.fromkeys((511, 512, 521, 522, 523), WATER),
}
_SCOTT_BURGAN = frozenset(
    number for spans in NUMBERS.values() for first, last in spans for number in range(first, last + 1)
    if first > NUMBERS[UNBURNABLE][0][1]
)  # fmt: skip


def categories(numbers: NDArray) -> tuple[NDArray[np.float32], str] | None:
    """Translate numbers to fuel model numbers (NaN for 0), and name the legend; None without a clear one."""
    whole = np.asarray(numbers, np.int64)
    found = {int(number) for number in np.unique(whole)} - {0}
    corine, standard = found <= _CORINE.keys(), found <= _SCOTT_BURGAN
    if not found or corine == standard:
        return None
    if standard:
        return np.where(whole == 0, np.nan, whole).astype(np.float32), "Scott and Burgan's fuel models"
    table = np.full(max(_CORINE) + 1, np.nan, np.float32)
    for code, model in _CORINE.items():
        table[code] = model
    return table[whole], "Corine land cover, each code as the fuel model of similar vegetation (assumed)"
