"""Labels drawn onto pictures, for people: masks, boxes, front and horizon."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import output
from ..errors import UsageError, input_error
from ..geometry.grids import dilate
from ..geometry.rectangles import common_area
from ..shot.schema.frame_list import FrameList
from . import files, truth
from .files import Masks
from .truth import Annotation, Box, Truth

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

Picture = NDArray[np.uint8]

MOST = 24
"""Maximum number of samples that are drawn without a list."""

_COLOURS = {truth.FIRE: (255, 208, 0), truth.SMOKE: (0, 200, 255)}
_FRONT, _HORIZON = (255, 64, 160), (96, 255, 96)
_FILL = 0.25  # weight of the colour within a mask
_TEXT = 11  # pixels, height of letters in a picture of 640 columns
_KILOMETRE = 1000.0


def draw_sample(folder: Path, index: int, kind: str = "images") -> Picture:
    """Draw the labels of a sample of a data set.

    Parameters
    ----------
    kind
        Picture below the labels: "images", "clean", "twin" or "palette".

    Raises
    ------
    InputError
        A file is missing or damaged.
    """
    return draw(files.read(folder, kind, index), truth.read(folder, index), files.read_masks(folder, index))


def write(folder: Path, only: str, out: Path, overwrite: bool = False) -> Iterator[Path]:
    """Draw the labels of samples of a data set into files ``000137.png`` of a folder, and yield their paths.

    Parameters
    ----------
    only
        Frame list of numbers of samples; "": `MOST` of them, evenly spaced.

    Raises
    ------
    InputError
        The folder has no data set, a file is missing or damaged, or a file of others is in the way.
    UsageError
        The list is invalid.
    """
    from PIL import Image

    known = list(truth.indices(folder))
    if not known:
        raise input_error(folder, "has no samples; make some with: firetwin dataset PLAN.toml --out DIR")
    paths = {index: out / f"{truth.stem(index)}.png" for index in _chosen(known, only)}
    for path in paths.values():
        output.check(path, overwrite)
    for index, path in paths.items():
        output.write(path, Image.fromarray(draw_sample(folder, index)).save, overwrite)
        yield path


def _chosen(finished: list[int], only: str) -> list[int]:
    """Choose samples by a list, or evenly spaced ones without a list."""
    if not only.strip():
        return [
            finished[step] for step in np.linspace(0, len(finished) - 1, min(MOST, len(finished))).astype(int)
        ]
    try:
        wanted = FrameList(only).frames(finished[-1])
    except ValueError:
        raise UsageError(
            f"--only: samples are numbered 1 to {finished[-1]}; write it like 137 or 1-20"
        ) from None
    if missing := sorted({*wanted} - {*finished}):
        raise UsageError(f"--only: sample {missing[0]} is not finished; make it first")
    return wanted


def draw(picture: Picture, labelled: Truth, masks: Masks) -> Picture:
    """Draw labels onto a picture (h, w, 3): masks in colour, boxes, amodal boxes of flames dashed, lines."""
    from PIL import Image, ImageDraw

    shown = picture.copy()
    for category, layer in ((truth.SMOKE, masks.smoke), (truth.FIRE, masks.fire)):
        _tint(shown, layer, _COLOURS[category])
    image = Image.fromarray(shown)
    pen = ImageDraw.Draw(image)
    for line in labelled.horizon:
        pen.line(line, fill=_HORIZON)
    for line in labelled.front:
        pen.line(line, fill=_FRONT)
    taken = [each.box for each in labelled.annotations]
    for each in labelled.annotations:
        _draw_boxes(pen, each)
    for each in labelled.annotations:
        taken.append(_draw_caption(pen, each, taken, *picture.shape[:2]))
    return np.array(image)


def draw_small(picture: Image, labelled: Truth, width: int) -> Image:
    """Draw boxes onto a picture, reduced to a width in pixels."""
    from PIL import ImageDraw

    small = picture.convert("RGB")
    small.thumbnail((width, width))
    scale, pen = small.width / labelled.camera.width, ImageDraw.Draw(small)
    for each in labelled.annotations:
        box, amodal = (_scaled(found, scale) for found in (each.box, each.amodal_box))
        _draw_boxes(pen, replace(each, box=box, amodal_box=amodal))
    return small


def caption(annotation: Annotation) -> str:
    """Describe an annotation in a few words: ``smoke 2, 4.2 km, top 610 m``."""
    words = [f"{_name(annotation)} {annotation.id}"]
    if annotation.distance_m is not None:
        far = annotation.distance_m >= _KILOMETRE
        size, unit = (annotation.distance_m / _KILOMETRE, ".1f") if far else (annotation.distance_m, ".0f")
        words.append(f"{size:{unit}} {'km' if far else 'm'}")
    if annotation.top_above_ground_m is not None:
        words.append(f"top {annotation.top_above_ground_m:.0f} m")
    if annotation.visible_fraction < 1.0:
        words.append(f"{annotation.visible_fraction:.0%} visible")
    return ", ".join(words)


def _name(annotation: Annotation) -> str:
    return next(each.name for each in truth.CATEGORIES if each.id == annotation.category)


def _tint(picture: Picture, layer: NDArray[np.uint8], colour: tuple[int, int, int]) -> None:
    """Tint the inside of masks (h, w) of several ids, and draw their outlines."""
    inside = layer > 0
    picture[inside] = np.rint(picture[inside] * (1.0 - _FILL) + np.array(colour) * _FILL)
    outline = inside & dilate(~inside, 1, False)
    for axis in (0, 1):
        for shift in (-1, 1):
            other = np.roll(layer, shift, axis)
            outline |= inside & (other > 0) & (other != layer)
    picture[outline] = colour


def _scaled(box: Box, scale: float) -> Box:
    """Scale a box; it has at least 2 pixels on each side."""
    x0, y0, x1, y1 = (scale * side for side in box)
    return x0, y0, max(x1, x0 + 2.0), max(y1, y0 + 2.0)


def _draw_boxes(pen: ImageDraw, each: Annotation) -> None:
    """Draw the box of an annotation, and its amodal box if that is larger."""
    _rectangle(pen, each.box, _COLOURS[each.category])
    if each.amodal_box != each.box:
        _dashed(pen, each.amodal_box, _COLOURS[each.category])


def _draw_caption(pen: ImageDraw, each: Annotation, taken: list[Box], height: int, width: int) -> Box:
    """Draw the caption of an annotation next to its box, where it covers the fewest others; return its box.

    Smoke prefers places above its box, fire below.
    """
    from PIL import ImageFont

    size = max(_TEXT * width // 640, 8)
    font, words = ImageFont.load_default(size), caption(each)
    long, line = pen.textlength(words, font=font) + 3, size + 3
    x0, top, x1, bottom = each.box
    above, below = ([first + step * line for step in range(4)] for first in (top - 4 * line, bottom))
    rows = [*above[::-1], *below] if each.category == truth.SMOKE else [*below, *above[::-1]]
    places = [
        (max(min(x, width - long - 1), 0.0), min(max(y, 0.0), height - line))
        for y in rows
        for x in (x0, x1 - long)
    ]
    boxes = [(x, y, x + long, y + line - 1) for x, y in places]
    found = min(boxes, key=lambda box: sum(common_area(box, other) for other in taken if other != each.box))
    pen.rectangle(found, fill=(0, 0, 0))
    pen.text((found[0] + 2, found[1]), words, fill=_COLOURS[each.category], font=font)
    return found


def _rectangle(pen: ImageDraw, box: Box, colour: tuple[int, int, int]) -> None:
    """Draw the outermost pixels of a box."""
    x0, y0, x1, y1 = box
    pen.rectangle((x0, y0, x1 - 1, y1 - 1), outline=colour)


def _dashed(pen: ImageDraw, box: Box, colour: tuple[int, int, int]) -> None:
    """Draw a box with dashes."""
    x0, y0, x1, y1 = (box[0], box[1], box[2] - 1, box[3] - 1)
    for x in np.arange(x0, x1, 6.0):
        for y in (y0, y1):
            pen.line((x, y, min(x + 2, x1), y), fill=colour)
    for y in np.arange(y0, y1, 6.0):
        for x in (x0, x1):
            pen.line((x, y, x, min(y + 2, y1)), fill=colour)
