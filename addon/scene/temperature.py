"""Surface temperatures (K) for the thermal view.

Flames are 1000-1500 K (Frankman et al. 2008); a pixel of the burning edge mixes flame with gaps, so it is
drawn at 1000-1200 K. Behind it the ground cools exponentially. The rate of cooling, the heat of embers
and the warming of the ground by the sun are assumed, not measured.
"""

from __future__ import annotations

from typing import Any

from ..blender import nodes
from ..shot import sun
from ..shot.shot import Shot

LAPSE = 6.5e-3  # K/m, the standard atmosphere
AIR = 300.0  # K at 600 m on the afternoon of 17 Sep 2014 (assumed)
NIGHT = -12.0  # K, the ground at night against the afternoon (assumed)
SUNLIT = 9.0  # K, bare ground square to the sun against its surroundings (assumed)
FLAME_LOW, FLAME_HIGH = 1000.0, 1200.0  # K
EMBER = 850.0  # K, a pixel full of glowing embers (assumed)
SMOULDER, COOLING = 220.0, 1500.0  # K above ambient just behind the flames, s to 1/e (assumed)


def ambient(tree: nodes.Tree, shot: Shot, elevation: Any, canopy: Any) -> nodes.Value:
    """Temperature of unburned ground and crowns: that of the air, warmer where bare ground is sunlit."""
    bearing, height = shot.sun(shot.frames.middle)
    day = float(min(max(height / 20.0, 0.0), 1.0))
    normal = tree.output("ShaderNodeNewGeometry", name="Normal")
    facing = tree.math(
        "MAXIMUM",
        tree.vector("DOT_PRODUCT", normal, tuple(sun.direction(bearing, height)), name="Value"),
        0.0,
    )
    bare = canopy.ramp(0.0, 1.0, 1.0, 0.25) if isinstance(canopy, nodes.Value) else canopy
    air = elevation * -LAPSE + (AIR + LAPSE * 600.0 + (1.0 - day) * NIGHT)
    return air + facing * bare * (SUNLIT * day)


def cooling(tree: nodes.Tree, background: Any, age: nodes.Value, burned: Any) -> nodes.Value:
    """Temperature of what has burned, without flames or embers of its own."""
    return background + (-(tree.math("MAXIMUM", age, 0.0) / COOLING)).exp() * burned * SMOULDER


def burning(
    tree: nodes.Tree, background: Any, age: nodes.Value, burned: Any, flaming: nodes.Value, embers: Any
) -> nodes.Value:
    """Temperature of what burns or has burned: flames and embers (each 0..1) over the cooling ash."""
    glowing = tree.mix(embers, cooling(tree, background, age, burned), EMBER)
    return tree.mix(flaming.smoothstep(0.0, 0.5), glowing, flaming.ramp(0.0, 1.0, FLAME_LOW, FLAME_HIGH))
