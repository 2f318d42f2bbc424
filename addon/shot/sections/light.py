"""Section [light]: haze, exposure and point lights of the flames."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import key


@dataclass(frozen=True)
class Light:
    """Haze, exposure and the light of the flames."""

    haze: float = key(1.0, "strength of haze; 0: none, 1: a dry September day", at_least=0, at_most=100)
    smoke: float = key(
        0.0,
        "haze of smoke from distant fires: PM2.5 at the ground; firetwin haze reads it from a forecast",
        unit="ug/m3",
        at_least=0,
        at_most=10_000,
    )
    smoke_height: float = key(
        1500.0,
        "height above the ground at which 37 % of that smoke is left",
        unit="m",
        at_least=300,
        at_most=20_000,
    )
    exposure: float | None = key(
        None,
        "exposure; default: exposure metering per camera: about 0.5 by day, up to 4 by night, 6 at dusk",
        unit="stops",
        at_least=-20,
        at_most=20,
    )
    lamps: int = key(
        48,
        "limit on point lights of far flames at low sun; 0: flames light no terrain or trees, near or far",
        at_least=0,
        at_most=500,
    )
