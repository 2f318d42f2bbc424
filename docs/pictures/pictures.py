"""Draws the film and the small pictures of README.md from rendered files.

``python pictures.py examples/out docs/pictures``; `pictures.sh` renders the files first.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from PIL import Image

FILM, SMALL = (640, 360), (240, 135)  # width and height, pixels
RATE = 125  # ms a frame
PALEST = 15_000.0  # m; depth from which its picture is white


def opened(path: Path) -> Image.Image:
    """A picture without its transparency."""
    return Image.open(path).convert("RGB")


def fitted(picture: Image.Image, size: tuple[int, int]) -> Image.Image:
    """The middle of a picture in the shape of `size`, scaled to it."""
    width, height = picture.size
    wide = min(width, round(height * size[0] / size[1]))
    high = min(height, round(width * size[1] / size[0]))
    left, top = (width - wide) // 2, (height - high) // 2
    return picture.resize(size, Image.Resampling.LANCZOS, (left, top, left + wide, top + high))


def depth(path: Path) -> Image.Image:
    """Depth as grey, near is dark; by its root, so that near ground shows."""
    metres = sensor.read_image(path)[..., 0]
    share = np.sqrt(np.clip(np.nan_to_num(metres, nan=PALEST, posinf=PALEST) / PALEST, 0.0, 1.0))
    return Image.fromarray((255 * share).astype(np.uint8)).convert("RGB")


def sheet(pictures: list[Image.Image]) -> Image.Image:
    """Four pictures in two rows."""
    width, height = SMALL
    found = Image.new("RGB", (2 * width, 2 * height))
    for i, each in enumerate(pictures):
        found.paste(fitted(each, SMALL), (i % 2 * width, i // 2 * height))
    return found


def film(frames: list[Path], path: Path) -> None:
    """An animated picture that begins again at its end."""
    pictures = [fitted(opened(each), FILM) for each in frames]
    pictures[0].save(
        path, save_all=True, append_images=pictures[1:], duration=RATE, loop=0, quality=82, method=6
    )


def main(out: Path, folder: Path) -> None:
    """Writes film.webp and the small pictures."""
    drone, satellite = out / "film/drone", out / "film/satellite"
    film(sorted((drone / "rgb").glob("*.png")), folder / "film.webp")
    forest = opened(out / "forest/flank/rgb/flank_rgb_000001.png")
    masks = opened(out / "forest/flank/masks/flank_masks_000001.png")
    sight = opened(drone / "rgb/drone_rgb_000030.png")
    above = opened(satellite / "rgb/satellite_rgb_000048.png")
    far = depth(drone / "depth/drone_depth_000030.exr")
    small = {
        "forest": forest,
        "smoke": sight,
        "cameras": sheet([sight, far, masks, above]),
        "thermal": opened(drone / "thermal/drone_thermal_000030.png"),
        "satellite": above,
        "maps": opened(out / "maps/intensity.png"),
    }
    for name, picture in small.items():
        fitted(picture, SMALL).save(folder / f"small_{name}.webp", quality=80, method=6)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
