"""Growth habits of tree and shrub species outside of the Sierra, derived from its most similar species.

Shapes follow the species' descriptions in floras; numbers are chosen by eye, as in `habit`.
"""

from __future__ import annotations

from dataclasses import replace

from .habit import BLACK_OAK, CEANOTHUS, MANZANITA, PONDEROSA, WHITE_FIR

HOLM_OAK = replace(  # Quercus ilex: round, dense, dark, often of several stems
    BLACK_OAK, bare=0.12, radius=0.46, size=(0.028, 0.0190), colour=(0.034, 0.044, 0.020)
)
LIVE_OAK = replace(  # Quercus agrifolia: wider than tall, nearly to the ground
    BLACK_OAK, bare=0.14, top=0.50, radius=0.52, rise=(2.0, 74.0), colour=(0.042, 0.052, 0.022)
)
STONE_PINE = replace(  # Pinus pinea, Pinus halepensis: an umbrella on a bare trunk
    PONDEROSA,
    bare=0.58,
    top=0.95,
    radius=0.24,
    low=0.10,
    high=0.25,
    rise=(12.0, 62.0),
    colour=(0.042, 0.060, 0.024),
    wood=(0.130, 0.080, 0.055),
)
SPRUCE = replace(  # Picea abies, Picea glauca: a spire with hanging branches
    WHITE_FIR,
    bare=0.05,
    radius=0.125,
    high=0.92,
    rise=(-34.0, 22.0),
    lift=0.10,
    colour=(0.024, 0.040, 0.020),
    wood=(0.080, 0.062, 0.050),
)
SCOTS_PINE = replace(  # Pinus sylvestris: an orange trunk, a high and uneven crown
    PONDEROSA,
    bare=0.48,
    radius=0.16,
    low=0.25,
    high=0.42,
    irregular=0.32,
    colour=(0.044, 0.060, 0.030),
    wood=(0.170, 0.085, 0.045),
)
BIRCH = replace(  # Betula pendula: slender, of rising branches whose tips hang, white
    BLACK_OAK,
    bare=0.16,
    top=0.93,
    radius=0.31,
    low=0.25,
    high=0.45,
    rise=(22.0, 62.0),
    lift=-0.08,
    size=(0.026, 0.0200),
    stem=0.014,
    colour=(0.066, 0.094, 0.030),
    wood=(0.240, 0.230, 0.210),
)
ACACIA = replace(  # Vachellia tortilis: a flat top on a forked trunk
    BLACK_OAK,
    bare=0.50,
    top=0.84,
    radius=0.56,
    low=0.02,
    high=0.05,
    rise=(10.0, 48.0),
    lift=0.02,
    size=(0.024, 0.0150),
    stem=0.022,
    colour=(0.050, 0.062, 0.024),
    wood=(0.085, 0.066, 0.048),
)
LENTISK = replace(CEANOTHUS, radius=0.90, colour=(0.034, 0.046, 0.020), wood=(0.075, 0.060, 0.050))
CISTUS = replace(MANZANITA, radius=0.66, colour=(0.070, 0.078, 0.044), wood=(0.085, 0.062, 0.046))
TREE_HEATH = replace(MANZANITA, radius=0.60, rise=(40.0, 85.0), colour=(0.040, 0.050, 0.021))
