"""The choice of tiles of a large tree for a shot of many views: seconds of processor.

    python tests/benchmarks/tile_choice.py [--tiles 10000] [--views 240] [--runs 5]

The tree is a quadtree in one tileset.json, whose reading counts too; no tile is fetched. Seconds are medians
with their range.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from firetwin.tiles import cut
from firetwin.tiles.cut import Views
from firetwin_core import lod

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))
import tilesets

_SIDE = 10_000.0  # m


def quadtree(count: int) -> dict:
    """A tree of at least `count` tiles, of levels that are whole, and files that are not there."""
    depth, known = 0, 1
    while known < count:
        depth += 1
        known += 4**depth

    def tile(level: int, x: int, y: int) -> dict:
        half = 0.5 * _SIDE / 2**level
        place = {"x": (2 * x + 1) * half - 0.5 * _SIDE, "y": (2 * y + 1) * half - 0.5 * _SIDE}
        children = (
            [] if level == depth else [tile(level + 1, 2 * x + i, 2 * y + j) for i, j in np.ndindex(2, 2)]
        )
        error = 0.0 if level == depth else 200.0 / 2**level
        uri = f"{level}_{x}_{y}.glb"
        return tilesets.tile(error, uri, children, tilesets.box(**place, half=half), refine="REPLACE")

    return tile(0, 0, 0)


def views_of(count: int) -> Views:
    """A camera that flies 500 m above the set, and looks down at 45 degrees."""
    along = np.linspace(-0.4 * _SIDE, 0.4 * _SIDE, count)
    position = np.column_stack([along, 0.2 * along, np.full(count, 500.0)])
    slant = np.sqrt(0.5)
    rotation = np.array([[0.0, slant, -slant], [-1.0, 0.0, 0.0], [0.0, slant, slant]])
    half = np.tile([0.5, 0.28], (count, 1))
    found = lod.ViewSet(position, np.tile(rotation, (count, 1, 1)), half, above_terrain=False)
    return Views(found, cut.pixels(np.full(count, 1080), half[:, 1]), position)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--tiles", type=int, default=10_000)
    parser.add_argument("--views", type=int, default=240)
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    text, views = json.dumps(tilesets.tileset(quadtree(given.tiles))).encode(), views_of(given.views)
    read, chose = [], []
    for _ in range(given.runs):
        began = time.process_time()
        loader = tilesets.Loader(tilesets.Memory({"tileset.json": text}))
        read.append(time.process_time() - began)
        began = time.process_time()
        choice = cut.choose(loader, views, np.eye(4), 2.0, fetch=False)
        chose.append(time.process_time() - began)
    result = {"tiles": loader.tree.size, "views": given.views, "chosen": len(choice.tiles)}
    for name, took in (("reading, s", read), ("choosing, s", chose)):
        result[name] = f"{np.median(took):.3f} ({min(took):.3f} to {max(took):.3f})"
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
