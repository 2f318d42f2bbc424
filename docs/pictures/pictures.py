"""The film and the small pictures of README.md, made from rendered files.

``python pictures.py examples/out docs/pictures``; `pictures.sh` renders the files first.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from firetwin_core import sensor
from PIL import Image

FILM, SMALL = (640, 360), (240, 135)  # width and height, pixels
RATE = 83  # ms per frame, 12 frames per second
WHITE_DEPTH = 15_000.0  # m


def open_picture(path: Path) -> Image.Image:
    """Open a picture without its transparency."""
    return Image.open(path).convert("RGB")


def crop(picture: Image.Image, size: tuple[int, int]) -> Image.Image:
    """Crop the centre of a picture to the shape of `size`, and scale it."""
    width, height = picture.size
    wide = min(width, round(height * size[0] / size[1]))
    high = min(height, round(width * size[1] / size[0]))
    left, top = (width - wide) // 2, (height - high) // 2
    return picture.resize(size, Image.Resampling.LANCZOS, (left, top, left + wide, top + high))


def draw_depth(path: Path) -> Image.Image:
    """Draw depth as grey, dark if near; its root, so that near ground is visible."""
    metres = sensor.read_image(path)[..., 0]
    share = np.sqrt(np.clip(np.nan_to_num(metres / WHITE_DEPTH, nan=1.0, posinf=1.0), 0.0, 1.0))
    return Image.fromarray((255 * share).astype(np.uint8)).convert("RGB")


def draw_sheet(pictures: list[Image.Image], columns: int = 2) -> Image.Image:
    """Draw pictures in two rows."""
    width, height = SMALL
    picture = Image.new("RGB", (columns * width, 2 * height))
    for i, each in enumerate(pictures):
        picture.paste(crop(each, SMALL), (i % columns * width, i // columns * height))
    return picture


def draw_story(shots: Path) -> Image.Image:
    """Draw the last map of a story, and pictures of its shots of the fire, in the order of the film."""
    names = ("arrival/flight/rgb", "flames/near/rgb", "active/front/rgb", "infrared/wipe", "night/front/rgb")
    paths = [max((shots / "growth/map").glob("*.png"))]
    paths += [(own := sorted((shots / name).glob("*.png")))[len(own) // 2] for name in names]
    return draw_sheet([open_picture(path) for path in paths], columns=3)


def write_film(frames: list[Path], path: Path) -> None:
    """Write an animated picture that loops."""
    pictures = [crop(open_picture(each), FILM) for each in frames]
    pictures[0].save(
        path, save_all=True, append_images=pictures[1:], duration=RATE, loop=0, quality=82, method=6
    )


def main(out: Path, folder: Path) -> None:
    """Write film.webp, story.webp and the small pictures."""
    drone, satellite = out / "film/drone", out / "film/satellite"
    write_film(sorted((drone / "rgb").glob("*.png")), folder / "film.webp")
    forest = open_picture(out / "forest/flank/rgb/flank_rgb_000001.png")
    masks = open_picture(out / "forest/flank/masks/flank_masks_000001.png")
    sight = open_picture(drone / "rgb/drone_rgb_000030.png")
    above = open_picture(satellite / "rgb/satellite_rgb_000048.png")
    far = draw_depth(drone / "depth/drone_depth_000030.exr")
    small = {
        "forest": forest,
        "smoke": sight,
        "cameras": draw_sheet([sight, far, masks, above]),
        "thermal": open_picture(drone / "thermal/drone_thermal_000030.png"),
        "satellite": above,
        "story": open_picture(max((out / "story/shots/growth/map").glob("*.png"))),
        "maps": open_picture(out / "maps/intensity.png"),
    }
    draw_story(out / "story/shots").save(folder / "story.webp", quality=80, method=6)
    for name, picture in small.items():
        crop(picture, SMALL).save(folder / f"small_{name}.webp", quality=80, method=6)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
