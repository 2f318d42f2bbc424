"""Section [tiles]: 3D Tiles as ground."""

from __future__ import annotations

from dataclasses import dataclass

from ..schema import key


@dataclass(frozen=True)
class TileSettings:
    """3D Tiles as ground: photogrammetry, terrain and buildings, selected once per shot."""

    sources: tuple[str, ...] = key(
        (),
        "tilesets: folders, tileset.json, .3tz archives or URLs; paths start at the scene file's folder",
        affects=("terrain",),
    )
    root: str = key(
        "",
        "folder within which files of local tilesets may refer to ../FILE; empty: their own folder",
        affects=("terrain",),
    )
    max_screen_space_error: float = key(
        2.0,
        "largest screen-space error of a tile; interactive viewers often use 16",
        unit="pixels",
        at_least=0.1,
        at_most=10_000,
        affects=("terrain",),
    )
    max_tiles: int = key(
        2000,
        "limit on tiles; beyond a limit the error threshold of the shot is raised, and reported",
        at_least=1,
        at_most=1_000_000,
        affects=("terrain",),
    )
    max_size: int = key(
        2000,
        "limit on the content fetched for a shot",
        unit="MB",
        at_least=1,
        at_most=1_000_000,
        affects=("terrain",),
    )
    max_triangles: int = key(
        30_000_000, "limit on triangles", at_least=1, at_most=1_000_000_000, affects=("terrain",)
    )
    geoid: float | None = key(
        None,
        "height of the geoid above the WGS84 ellipsoid; default: EGM96, by a grid of this machine",
        unit="m",
        at_least=-200,
        at_most=200,
        affects=("terrain",),
    )
    vegetation: str = key(
        "scene",
        "vegetation on tiles",
        choices={"scene": "flattens vegetation of tiles", "tileset": "", "scene_near_burn": ""},
        affects=("terrain", "forest"),
    )
