"""Growth habits of the Sierra's tree species: crown shape, branching and colour.

Lengths are in tree heights. Crowns are somewhat wider than in dense stands (crown radius 0.10 to 0.15 of the
height there), as our trees are fewer. Shapes follow the species' descriptions in Burns & Honkala, Silvics of
North America (1990). Numbers are chosen by eye.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from .shape import Colour

Fit = tuple[float, float, float]


@dataclass(frozen=True)
class Habit:
    """Growth habit of a tree.

    Attributes
    ----------
    bare, top
        Heights of the lowest living branches and of the trunk's top.
    radius
        Length of the longest branches.
    branches, sprays, leaves
        Branches, sprays on each, and leaves (clumps of needles drawn as one) on each spray.
    low, high
        Exponents of branch length in the distance from the crown's base and top: small `low` and large `high`
        make a spire, the reverse a flat top.
    irregular
        Standard deviation of the logarithm of branch length.
    whorled
        0: branches leave the trunk at random heights; 1: in whorls.
    rise
        Angle of a branch above the horizontal at the crown's base and at its top, degrees.
    lift
        Upward bend of a branch's tip, in branch lengths; negative: it droops.
    inner
        Fraction of a branch next to the trunk without leaves.
    spread
        Scatter of leaves about the line of their spray, sideways and up.
    size
        Length and width of a leaf.
    stem
        Radius of the trunk at its base.
    dead
        Number of dead branches below the living ones.
    colour, wood
        Linear reflectances of leaves and bark.
    autumn
        Reflectance of leaves that have turned; None: the tree is evergreen.
    needles
        Needles into which a leaf is divided close by; 1: a leaf.
    hang
        Weight with which leaves hang down, against the direction of their spray.
    fit
        Levels of detail 1, 2 and 3: factors of the triangles' width and height and of the colour's
        brightness that give them the cover and the brightness of level 0, from the side and from above
        (measured).
    """

    bare: float
    top: float
    radius: float
    branches: int
    sprays: int
    leaves: int
    low: float
    high: float
    irregular: float
    whorled: float
    rise: tuple[float, float]
    lift: float
    inner: float
    spread: tuple[float, float]
    size: tuple[float, float]
    stem: float
    dead: int
    colour: Colour
    wood: Colour
    autumn: Colour | None = None
    needles: int = 1
    hang: float = 0.0
    fit: tuple[Fit, Fit, Fit] = ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0))


SUGAR_PINE = Habit(
    bare=0.38,
    top=0.975,
    radius=0.185,
    branches=58,
    sprays=13,
    leaves=18,
    low=0.55,
    high=0.42,
    irregular=0.34,
    whorled=0.8,
    rise=(-8.0, 30.0),
    lift=-0.04,
    inner=0.30,
    spread=(0.75, 0.65),
    size=(0.022, 0.0075),
    stem=0.0135,
    dead=16,
    colour=(0.040, 0.062, 0.029),
    wood=(0.105, 0.070, 0.048),
    needles=3,
    fit=((0.79, 0.80, 0.82), (1.25, 2.24, 0.93), (1.31, 1.22, 0.63)),
)
PONDEROSA = Habit(
    bare=0.32,
    top=0.975,
    radius=0.15,
    branches=66,
    sprays=11,
    leaves=20,
    low=0.30,
    high=0.55,
    irregular=0.26,
    whorled=0.7,
    rise=(-18.0, 48.0),
    lift=0.16,
    inner=0.35,
    spread=(0.85, 0.80),
    size=(0.024, 0.0080),
    stem=0.0140,
    dead=18,
    colour=(0.052, 0.070, 0.024),
    wood=(0.125, 0.078, 0.048),
    needles=3,
    fit=((0.71, 0.80, 0.78), (1.38, 2.30, 0.99), (1.40, 1.76, 0.57)),
)
WHITE_FIR = Habit(
    bare=0.10,
    top=0.975,
    radius=0.155,
    branches=104,
    sprays=13,
    leaves=13,
    low=0.10,
    high=0.82,
    irregular=0.18,
    whorled=0.5,
    rise=(-20.0, 28.0),
    lift=0.06,
    inner=0.14,
    spread=(0.80, 0.42),
    size=(0.017, 0.0100),
    stem=0.0125,
    dead=14,
    colour=(0.034, 0.056, 0.027),
    wood=(0.092, 0.080, 0.066),
    needles=3,
    fit=((0.68, 0.82, 0.77), (1.16, 2.26, 0.90), (1.45, 1.10, 0.68)),
)
INCENSE_CEDAR = Habit(
    bare=0.06,
    top=0.975,
    radius=0.135,
    branches=110,
    sprays=11,
    leaves=14,
    low=0.12,
    high=0.62,
    irregular=0.17,
    whorled=0.0,
    rise=(-32.0, 52.0),
    lift=0.30,
    inner=0.20,
    spread=(0.55, 0.75),
    size=(0.020, 0.0085),
    stem=0.0165,
    dead=10,
    colour=(0.056, 0.078, 0.024),
    wood=(0.135, 0.070, 0.042),
    needles=3,
    fit=((0.69, 0.87, 0.77), (1.21, 2.01, 1.05), (1.44, 1.42, 0.61)),
)
RED_FIR = replace(
    WHITE_FIR,
    bare=0.22,
    radius=0.13,
    branches=92,
    high=0.62,
    dead=24,
    colour=(0.032, 0.050, 0.026),
    fit=((0.61, 0.94, 0.76), (1.27, 2.40, 0.94), (1.46, 1.28, 0.61)),
)
YOUNG_FIR = replace(
    WHITE_FIR,
    bare=0.03,
    radius=0.21,
    branches=76,
    high=0.95,
    size=(0.026, 0.0140),
    dead=0,
    stem=0.012,
    fit=((0.73, 0.83, 0.76), (1.22, 2.33, 0.88), (1.41, 1.24, 0.63)),
)
YOUNG_PINE = replace(
    PONDEROSA,
    bare=0.10,
    radius=0.19,
    branches=48,
    high=0.75,
    size=(0.036, 0.0110),
    dead=8,
    stem=0.014,
    fit=((0.74, 0.80, 0.79), (1.43, 2.18, 0.93), (1.34, 1.36, 0.55)),
)
BLACK_OAK = Habit(
    bare=0.22,
    top=0.55,
    radius=0.44,
    branches=44,
    sprays=14,
    leaves=20,
    low=0.10,
    high=0.12,
    irregular=0.16,
    whorled=0.0,
    rise=(8.0, 78.0),
    lift=0.05,
    inner=0.38,
    spread=(1.2, 1.1),
    size=(0.032, 0.0230),
    stem=0.026,
    dead=6,
    colour=(0.064, 0.080, 0.026),
    wood=(0.060, 0.052, 0.046),
    autumn=(0.150, 0.098, 0.038),
    fit=((0.81, 0.77, 0.77), (1.27, 1.71, 0.97), (1.17, 2.39, 0.63)),
)
MANZANITA = Habit(
    bare=0.03,
    top=0.12,
    radius=0.80,
    branches=30,
    sprays=9,
    leaves=12,
    low=0.05,
    high=0.05,
    irregular=0.20,
    whorled=0.0,
    rise=(25.0, 80.0),
    lift=0.08,
    inner=0.45,
    spread=(1.2, 1.1),
    size=(0.070, 0.0500),
    stem=0.020,
    dead=4,
    colour=(0.070, 0.082, 0.045),
    wood=(0.110, 0.040, 0.026),
    fit=((0.95, 0.93, 0.96), (1.32, 1.21, 1.47), (1.16, 2.40, 0.77)),
)
CEANOTHUS = replace(
    MANZANITA,
    radius=1.0,
    branches=36,
    rise=(12.0, 70.0),
    colour=(0.048, 0.062, 0.030),
    wood=(0.08, 0.07, 0.06),
    fit=((0.99, 0.84, 0.89), (1.12, 1.21, 1.47), (1.11, 1.88, 0.89)),
)
