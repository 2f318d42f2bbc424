"""Section [forest]: vegetation type, trees and grass."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import key
from . import biome_names


@dataclass(frozen=True)
class Forest:
    """Trees and grass."""

    biome: str = key(
        "auto",
        'vegetation type, such as "maquis" or "boreal"; "auto" selects it by place and fuel',
        choices=biome_names.choices,
        affects=("terrain", "forest"),
    )
    greenness: float | None = key(
        None,
        "greenness of grass; 0: cured, 1: green; default: by date, hemisphere and fire",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    shrub_cover: float | None = key(
        None,
        "smallest share of open land under shrubs, except in sierra_conifer; default: by fuel and biome",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    tree_cover: float | None = key(
        None,
        "share of open land under single trees, except in sierra_conifer; default: by biome",
        at_least=0,
        at_most=1,
        affects=("terrain", "forest"),
    )
    trees: bool = key(True, "draw trees where the run has canopy fuel")
    grass: bool = key(True, "draw clumps of grass where the run has surface fuel, within 400 m of a camera")
    density: str = key(
        "stand",
        "tree density",
        choices={"stand": "hundreds per hectare, by canopy fuel", "paper": "one tree per fuel cell"},
    )
    budget: int = key(
        200_000,
        "approximate limit on trees in a stand; distant trees are fewer",
        at_least=1,
        at_most=10_000_000,
        affects=("terrain", "forest"),
    )
    widening: str = key(
        "film",
        "distant trees are wider",
        choices={
            "film": "in films",
            "always": "in exports too",
            "never": "true width",
        },
        affects=("terrain", "forest"),
    )
    understorey: int = key(
        40_000,
        "limit on shrubs, logs, rocks and grass tufts near the cameras; 0: none",
        at_least=0,
        at_most=10_000_000,
    )
    draw_distance: float = key(
        12_000.0,
        "draw distance of trees from the nearest camera; beyond it the terrain's colour represents them",
        unit="m",
        at_least=0,
        at_most=1_000_000,
    )
