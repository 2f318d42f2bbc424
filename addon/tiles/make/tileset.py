"""Writer of a 3D Tiles 1.1 tileset: a quadtree of terrain, with buildings added to its leaves."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ... import ellipsoid, files
from ...errors import input_error
from ...progress import Progress, silent
from ...run.buildings import Building
from . import building_mesh, glb, pictures, terrain_tile
from .lattice import Lattice
from .pictures import Colours

_GENERATOR = "Firetwin"
_FILE = "tileset.json"


@dataclass
class TilesetSummary:
    """Numbers of the written tileset.

    Attributes
    ----------
    errors
        Largest geometric error of each level, m, from the root on.
    """

    tiles: int = 0
    bytes: int = 0
    buildings: int = 0
    errors: list[float] = field(default_factory=list)


class Maker:
    """Writer of the tiles of a lattice into a folder.

    Parameters
    ----------
    credit
        Credits of the data, written into every tile.
    """

    def __init__(
        self,
        lattice: Lattice,
        colours: Colours | None,
        buildings: Sequence[Building],
        out: Path,
        credit: str = "",
    ) -> None:
        self.lattice, self.colours, self.out, self.credit = lattice, colours, out, credit
        self._buildings = _group_by_leaf(lattice, buildings)
        self.summary = TilesetSummary(errors=[0.0] * (lattice.levels + 1))

    def run(self, progress: Progress = silent) -> TilesetSummary:
        """Write all tiles, and `tileset.json` last."""
        total = (4 ** (self.lattice.levels + 1) - 1) // 3
        tiles: dict[tuple[int, int, int], dict[str, Any]] = {}
        for level in range(self.lattice.levels, -1, -1):
            for row in range(1 << level):
                for column in range(1 << level):
                    tiles[level, row, column] = self._tile(level, row, column, tiles)
                    progress(self.summary.tiles, total, "tiles")
        root = tiles[0, 0, 0]
        whole = {
            "asset": {"version": "1.1", "generator": _GENERATOR}
            | ({"copyright": self.credit} if self.credit else {}),
            "geometricError": _diagonal(self.lattice),
            "root": root,
        }
        files.write_text(self.out / _FILE, json.dumps(whole, separators=(",", ":")) + "\n")
        return self.summary

    def _tile(
        self, level: int, row: int, column: int, tiles: dict[tuple[int, int, int], Any]
    ) -> dict[str, Any]:
        """Write a tile; return its JSON. Its children are removed from `tiles`."""
        children = [
            tiles.pop((level + 1, 2 * row + i, 2 * column + j))
            for i in (0, 1)
            for j in (0, 1)
            if level < self.lattice.levels
        ]
        error = self.lattice.error(level, row, column) if children else 0.0
        if here := self._buildings.get((row, column)) if not children else None:
            children, error = (
                [self._write_buildings(here, row, column)],
                max(each.footprint.height for each in here),
            )
        error = max([error, *(child["geometricError"] for child in children)])
        self.summary.errors[level] = max(self.summary.errors[level], error)
        low, high = terrain_tile.heights(self.lattice, level, row, column)
        for child in children:
            low, high = (
                min(low, child["boundingVolume"]["region"][4]),
                max(high, child["boundingVolume"]["region"][5]),
            )
        about = {
            "boundingVolume": {"region": [*self._sides(level, row, column), low, high]},
            "geometricError": error,
            "refine": "ADD" if here else "REPLACE",
            "content": {"uri": self._write_terrain(level, row, column)},
        }
        return about | ({"children": children} if children else {})

    def _sides(self, level: int, row: int, column: int) -> list[float]:
        """Return west, south, east and north of a tile, radians."""
        rows, columns = self.lattice.block(level, row, column)
        lat, lon = self.lattice.latitude[rows], self.lattice.longitude[columns]
        return [float(np.radians(at)) for at in (lon[0], lat[0], lon[-1], lat[-1])]

    def _write_terrain(self, level: int, row: int, column: int) -> str:
        mesh = terrain_tile.mesh(self.lattice, level, row, column, self._picture(level, row, column))
        return self._write_mesh(f"{level}/{row}_{column}.glb", mesh)

    def _picture(self, level: int, row: int, column: int) -> bytes:
        if self.colours is None:
            return b""
        rows, columns = self.lattice.block(level, row, column)
        latitude, longitude = self.lattice.latitude[rows], self.lattice.longitude[columns]
        metres = (latitude[-1] - latitude[0]) * ellipsoid.metres_per_degree(float(latitude.mean()))[0]
        return pictures.draw(
            self.colours, latitude, longitude, pictures.side(metres, self.colours.resolution)
        )

    def _write_buildings(self, buildings: list[Building], row: int, column: int) -> dict[str, Any]:
        """Write the tile of a leaf's buildings; return its JSON."""
        west, south, east, north = self._sides(self.lattice.levels, row, column)
        sides = [np.radians(each.footprint.outer).T for each in buildings]
        low, high = min(each.base for each in buildings), max(each.roof for each in buildings)
        region = [
            min(west, *(lon.min() for lon, _ in sides)),
            min(south, *(lat.min() for _, lat in sides)),
            max(east, *(lon.max() for lon, _ in sides)),
            max(north, *(lat.max() for _, lat in sides)),
            low,
            high,
        ]
        self.summary.buildings += len(buildings)
        uri = self._write_mesh(f"buildings/{row}_{column}.glb", building_mesh.mesh(buildings))
        return {
            "boundingVolume": {"region": [float(each) for each in region]},
            "geometricError": 0.0,
            "content": {"uri": uri},
        }

    def _write_mesh(self, name: str, mesh: glb.Mesh) -> str:
        data = glb.encode(mesh, self.credit)
        path = self.out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write(path, lambda part: part.write_bytes(data))
        self.summary.tiles += 1
        self.summary.bytes += len(data)
        return name


def _group_by_leaf(lattice: Lattice, buildings: Sequence[Building]) -> dict[tuple[int, int], list[Building]]:
    """Group buildings by row and column of the leaf that contains their middle; others are omitted."""
    groups: dict[tuple[int, int], list[Building]] = {}
    borders = [
        axis[::cells]
        for axis, cells in zip((lattice.latitude, lattice.longitude), lattice.cells, strict=True)
    ]
    for each in buildings:
        row, column = (
            int(np.searchsorted(border, at, "right")) - 1
            for border, at in zip(borders, reversed(each.middle), strict=True)
        )
        if 0 <= row < len(borders[0]) - 1 and 0 <= column < len(borders[1]) - 1:
            groups.setdefault((row, column), []).append(each)
    return groups


def _diagonal(lattice: Lattice) -> float:
    """Compute the diagonal of the lattice, m: the error if nothing is drawn."""
    scale = ellipsoid.metres_per_degree(float(lattice.latitude.mean()))
    sides = [axis[-1] - axis[0] for axis in (lattice.latitude, lattice.longitude)]
    return float(np.hypot(*(side * metres for side, metres in zip(sides, scale, strict=True))))


def refuse_others(out: Path) -> None:
    """Refuse a folder that is neither empty nor a tileset of Firetwin.

    Raises
    ------
    InputError
        It is one.
    """
    if out.is_dir() and any(out.iterdir()) and not _is_own_tileset(out / _FILE):
        raise input_error(out, "is neither empty nor a tileset of Firetwin; name another --out")


def _is_own_tileset(path: Path) -> bool:
    try:
        return files.read_json(path)["asset"]["generator"] == _GENERATOR
    except (OSError, ValueError, LookupError, TypeError):
        return False
