"""Draws how/tiles.svg: the tiles that the core selects for one view of a regular quadtree, seen from above.

``python tile_selection.py how/tiles.svg``; `pictures.sh` calls it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from firetwin_core import lod, tiles

SIDE, DEPTH = 4000.0, 6  # m and levels of the quadtree
ROOT_ERROR = 128.0  # m, geometric error of the root; halved with each level
LIMIT = 8.0  # pixels, screen-space error
HEIGHT, HALF = 360, (0.5, 0.28)  # pixels of the picture, tangents of half the angles of view
EYE = np.array([-0.48 * SIDE, 0.0, 250.0])  # m; looks along x
ROTATION = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
COLOURS = ("#eceff1", "#cfd8dc", "#ffe0b2", "#ffb74d", "#fb8c00", "#e65100", "#bf360c")
WIDTH, TOP, SCALE = 740, 30, 340.0 / SIDE
TITLE = "Tiles selected for a camera, from above: smaller tiles near it, none outside of the frustum"


def quadtree() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Make a quadtree: parents (n,), levels (n,) and south-western corners (n, 2), m."""
    parent, level, corner = [-1], [0], [(-0.5 * SIDE, -0.5 * SIDE)]
    first = 0
    for depth in range(1, DEPTH + 1):
        last, size = len(parent), SIDE / 2**depth
        for tile in range(first, last):
            for i in (0, 1):
                for j in (0, 1):
                    parent.append(tile)
                    level.append(depth)
                    corner.append((corner[tile][0] + i * size, corner[tile][1] + j * size))
        first = last
    return np.array(parent), np.array(level), np.array(corner)


def select() -> tuple[np.ndarray, np.ndarray]:
    """Select tiles; return levels (k,) and south-western corners (k, 2) of visible tiles."""
    parent, level, corner = quadtree()
    size = SIDE / 2.0**level
    centre = np.column_stack([corner + 0.5 * size[:, None], np.zeros(len(level))])
    half = np.column_stack([0.5 * size, 0.5 * size, np.zeros(len(level))])
    axis = np.broadcast_to(np.eye(3), (len(level), 3, 3)).copy()
    views = lod.ViewSet(EYE[None], ROTATION, list(HALF))
    error = ROOT_ERROR * 0.5**level * (level < DEPTH)
    pixels = np.array([HEIGHT / (2.0 * HALF[1])])
    screen = tiles.screen_error(centre, axis, half, np.zeros(len(level)), error, views, pixels)
    flags = np.full(len(level), tiles.REPLACES | tiles.CONTENT, np.uint8)
    none = np.zeros(len(level), np.int64)
    found = tiles.select(parent, flags, screen, none, none, LIMIT, -1, -1, -1).tiles
    found = found[screen[found] >= 0.0]
    return level[found], corner[found]


def point(x: float, y: float) -> str:
    """Convert metres to the drawing's pixels: x to the right, y up."""
    return f"{40 + (x + 0.5 * SIDE) * SCALE:.1f} {TOP + (0.5 * SIDE - y) * SCALE:.1f}"


def draw() -> str:
    """Draw the selection as SVG."""
    level, corner = select()
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="400" viewBox="0 0 {WIDTH} 400" '
        f'role="img" aria-label="{TITLE}"><title>{TITLE}</title>'
        '<style>text{font:14px "DejaVu Sans",Verdana,Arial,sans-serif;fill:#222}.s{font-size:12px;fill:#555}'
        f'</style><rect width="{WIDTH}" height="400" rx="8" fill="#fff"/>'
    ]
    parts.append(
        f'<rect x="40" y="{TOP}" width="{SIDE * SCALE:.0f}" height="{SIDE * SCALE:.0f}" '
        'fill="none" stroke="#90a4ae" stroke-dasharray="5 4"/>'
    )
    for depth, (x, y) in zip(level, corner, strict=True):
        size = SIDE / 2.0**depth
        left, top = point(x, y + size).split()
        parts.append(
            f'<rect x="{left}" y="{top}" width="{size * SCALE:.1f}" height="{size * SCALE:.1f}" '
            f'fill="{COLOURS[depth]}" stroke="#4e342e" stroke-width=".6"/>'
        )
    reach = 0.5 * SIDE - EYE[0]
    sides = " ".join(f"M{point(*EYE[:2])}L{point(0.5 * SIDE, sign * reach * HALF[0])}" for sign in (1, -1))
    parts.append(f'<path d="{sides}" stroke="#d84315" stroke-width="1.8" fill="none"/>')
    parts.append(f'<circle cx="{point(*EYE[:2]).split()[0]}" cy="{point(*EYE[:2]).split()[1]}" r="6"/>')
    parts.append(f'<text x="400" y="60">{len(level)} tiles, error at most {LIMIT:g} pixels</text>')
    for row, depth in enumerate(sorted(set(level.tolist()))):
        y = 84 + 26 * row
        error = ROOT_ERROR * 0.5**depth if depth < DEPTH else 0.0
        box = f'x="400" y="{y}" width="18" height="18"'
        parts.append(f'<rect {box} fill="{COLOURS[depth]}" stroke="#4e342e"/>')
        text = f"level {depth}: {SIDE / 2**depth:,.0f} m wide, geometric error {error:g} m"
        parts.append(f'<text class="s" x="426" y="{y + 13}">{text}</text>')
    return "\n".join([*parts, "</svg>"]) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(draw(), encoding="utf-8")
