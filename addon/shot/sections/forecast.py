"""Section [forecast]: the ensemble of which the run is one member."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..schema import key


@dataclass(frozen=True)
class ForecastSettings:
    """Members of a forecast in the forecast pass."""

    ensemble: Path | None = key(
        None, "folder of the ensemble, such as `firetwin sample --members 20` writes", affects=()
    )
    member: str = key("", "name of the member that the run shows; empty: the typical one")
    lines: int = key(6, "limit on other members whose fronts are drawn", at_least=0, at_most=15)
    shares: bool = key(True, "tint the ground by the number of members that have burned it")
    places: bool = key(True, "name places, from labels.file or of the fire, with this number")
