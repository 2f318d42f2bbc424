"""Growth habits of tree and shrub species outside of the Sierra, derived from its most similar species.

Shapes follow the species' descriptions in floras; numbers are chosen by eye, as in `habit`.
"""

from __future__ import annotations

from dataclasses import replace

from .habit import BLACK_OAK, CEANOTHUS, MANZANITA, PONDEROSA, WHITE_FIR

HOLM_OAK = replace(  # Quercus ilex: round, dense, dark, often of several stems
    BLACK_OAK, bare=0.12, radius=0.46, size=(0.028, 0.0190), colour=(0.034, 0.044, 0.020), autumn=None
)
LIVE_OAK = replace(  # Quercus agrifolia: wider than tall, nearly to the ground
    BLACK_OAK,
    bare=0.14,
    top=0.50,
    radius=0.52,
    rise=(2.0, 74.0),
    colour=(0.042, 0.052, 0.022),
    autumn=None,
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
    wood=(0.420, 0.400, 0.370),
    autumn=(0.260, 0.185, 0.046),
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
    autumn=(0.110, 0.088, 0.042),
)
EUCALYPT = replace(  # Eucalyptus viminalis, E. pauciflora: pale, smooth, an open crown of hanging leaves
    BLACK_OAK,
    bare=0.40,
    top=0.86,
    radius=0.27,
    branches=36,
    sprays=15,
    leaves=22,
    low=0.18,
    high=0.28,
    irregular=0.36,
    rise=(22.0, 68.0),
    lift=-0.03,
    inner=0.60,
    spread=(0.9, 0.9),
    size=(0.044, 0.0160),
    stem=0.0165,
    dead=7,
    colour=(0.098, 0.110, 0.064),
    wood=(0.400, 0.350, 0.285),
    autumn=None,
    hang=1.1,
    fit=((0.64, 0.58, 0.77), (1.86, 2.56, 0.97), (1.14, 2.57, 0.63)),
)
STRINGYBARK = replace(  # Eucalyptus obliqua: fibrous bark, a denser and greener crown
    EUCALYPT,
    bare=0.34,
    radius=0.24,
    branches=40,
    inner=0.48,
    colour=(0.078, 0.094, 0.046),
    wood=(0.165, 0.130, 0.100),
    fit=((0.61, 0.71, 0.77), (1.66, 2.28, 0.97), (1.45, 2.56, 0.63)),
)
LARCH = replace(  # Larix decidua, L. sibirica: an open spire of soft needles, bare in winter
    WHITE_FIR,
    bare=0.12,
    radius=0.150,
    branches=66,
    high=0.85,
    irregular=0.26,
    rise=(-16.0, 34.0),
    lift=0.14,
    colour=(0.074, 0.104, 0.032),
    wood=(0.100, 0.075, 0.056),
    autumn=(0.260, 0.165, 0.042),
    fit=((0.75, 0.98, 0.77), (1.27, 2.6, 0.9), (1.47, 1.1, 0.68)),
)
BEECH = replace(  # Fagus, Tilia, Quercus robur: a round, full crown
    BLACK_OAK,
    bare=0.16,
    top=0.78,
    radius=0.32,
    branches=60,
    sprays=13,
    leaves=17,
    low=0.20,
    high=0.30,
    rise=(2.0, 76.0),
    size=(0.032, 0.0240),
    stem=0.019,
    colour=(0.052, 0.082, 0.022),
    wood=(0.110, 0.102, 0.092),
    autumn=(0.165, 0.112, 0.040),
    fit=((0.81, 0.75, 0.77), (1.38, 1.97, 0.97), (1.39, 2.6, 0.63)),
)
MAPLE = replace(  # Acer, Liquidambar, Nyssa: an oval crown, red in autumn
    BEECH,
    bare=0.20,
    top=0.84,
    radius=0.27,
    high=0.42,
    colour=(0.060, 0.092, 0.026),
    wood=(0.090, 0.080, 0.070),
    autumn=(0.185, 0.080, 0.034),
    fit=((0.78, 0.69, 0.77), (1.44, 2.09, 0.97), (1.41, 2.6, 0.63)),
)
CROP_PINE = replace(  # Pinus radiata, P. pinaster, P. taeda in rows: straight, pruned, narrow
    PONDEROSA,
    bare=0.45,
    radius=0.135,
    irregular=0.14,
    high=0.62,
    rise=(-4.0, 52.0),
    dead=10,
    colour=(0.040, 0.064, 0.024),
    fit=((0.68, 0.78, 0.78), (1.49, 2.6, 0.99), (1.44, 2.26, 0.57)),
)
LAUREL = replace(  # broad-leaved evergreens of wet tropics: tall, dense, round
    BEECH,
    bare=0.40,
    top=0.86,
    radius=0.26,
    colour=(0.036, 0.066, 0.018),
    wood=(0.170, 0.150, 0.125),
    autumn=None,
    fit=((0.76, 0.7, 0.77), (1.45, 2.03, 0.97), (1.44, 2.6, 0.63)),
)
KAPOK = replace(  # Ceiba pentandra and other emergents: a pale column, a wide flat crown
    BEECH,
    bare=0.62,
    top=0.88,
    radius=0.30,
    branches=40,
    low=0.06,
    high=0.12,
    rise=(8.0, 60.0),
    colour=(0.050, 0.080, 0.026),
    wood=(0.250, 0.225, 0.190),
    autumn=None,
    fit=((0.79, 0.73, 0.77), (1.53, 1.95, 0.97), (1.66, 1.96, 0.63)),
)
LENTISK = replace(CEANOTHUS, radius=0.90, colour=(0.034, 0.046, 0.020), wood=(0.075, 0.060, 0.050))
CISTUS = replace(MANZANITA, radius=0.66, colour=(0.070, 0.078, 0.044), wood=(0.085, 0.062, 0.046))
TREE_HEATH = replace(MANZANITA, radius=0.60, rise=(40.0, 85.0), colour=(0.040, 0.050, 0.021))
