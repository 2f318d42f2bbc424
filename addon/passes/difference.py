"""Difference pass: ground burned in one run and not in another, as tint over the visible picture.

The first run's picture in grey is tinted where the visible ground, from depth, has burned: in both runs, in
the first only, or in the other only. Fronts match the scores: interpolated linearly between cell centres.
Ground outside of a run's grid stays grey, as its state is unknown. Smoke does not occlude the tint. Two or
three other runs have a part of the picture each (see `split`), compared with the first.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from firetwin_core import sensor
from numpy.typing import NDArray

from ..imaging import split_screen
from ..run import times
from ..run.front import reach
from ..shot import comparison, picture_credits
from ..shot.cameras import pixel_rays
from ..shot.passes import ComparisonPass, Files
from ..shot.shot import Shot
from ..shot.surface import fronts

ORDER = 75
HELP = "Visible picture, tinted where burned areas of the first run and of other [[runs]] differ"

PASS = ComparisonPass(
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "picture", "terrain"}),
    needs=("rgb", "depth"),
)

BOTH = "#f0a03c"
_TINT = 0.6  # opacity of the tint
_GREY = 0.75  # factor on the grey picture's brightness


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Tint the picture."""
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    planar = sensor.read_image(needed["depth"]["exr"])[..., 0]
    points = pixel_rays.points(pixel_rays.path_of(shot.paths, camera), frame, planar)
    names, colours = [shot.label, *shot.others], fronts.colours(shot)
    pictures, keys = [], []
    for label, kinds in zip(shot.others, classes(shot, points, frame), strict=True):
        shades = [BOTH, colours[shot.label], colours[label]]
        pictures.append(tint(rgb, kinds, shades))
        keys.append(list(zip(shades, ("burned in both", f"only {names[0]}", f"only {label}"), strict=True)))
    said = comparison.caption(shot, frame)
    height, width = pictures[0].shape[:2]
    below = picture_credits.foot(shot, width, height, compares=True)
    sensor.write_image(files["png"], split_screen.sheet(pictures, keys, said, below))


def classes(shot: Shot, points: NDArray[np.float64], frame: int) -> list[NDArray[np.uint8]]:
    """Classify scene points (h, w, 3), by other run: 1 burned in both, 2 first only, 3 other only.

    0 is unburned, no ground, or ground outside of either grid.
    """
    ground = np.isfinite(points).all(axis=-1)
    latitude, longitude, _ = shot.local_frame.reverse(points[ground])
    moment, result = shot.utc(frame), []
    burned = {}
    for label, run in {"": shot.run, **shot.others}.items():
        burned[label] = reach(run).burned(latitude, longitude, times.seconds(run, moment))
    first = burned.pop("")
    for other in burned.values():
        kinds = np.zeros(ground.shape, np.uint8)
        known = np.isfinite(first) & np.isfinite(other)
        here, there = first == 1.0, other == 1.0
        kinds[ground] = np.where(known, np.where(here, np.where(there, 1, 2), np.where(there, 3, 0)), 0)
        result.append(kinds)
    return result


def tint(rgb: NDArray, kinds: NDArray[np.uint8], shades: list[str]) -> NDArray[np.float32]:
    """Tint a picture (h, w, 3), converted to grey, by classes 1 to 3 (h, w)."""
    grey = _GREY * (rgb @ np.array([0.2126, 0.7152, 0.0722]))[..., None]
    colour = np.array([[0.0] * 3, *([int(s[at : at + 2], 16) / 255.0 for at in (1, 3, 5)] for s in shades)])
    share = np.where(kinds > 0, _TINT, 0.0)[..., None]
    return (grey * (1.0 - share) + colour[kinds] * share).astype(np.float32)
