"""Files of a sample: pictures, maps and metadata in the folders of a data set (`CONTENT`).

The metadata are written last: a sample is complete if they exist.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..errors import InputError, input_error, reading, refuse_odd
from ..limits import SAMPLE_PIXELS
from ..passes import masks as classes
from . import truth
from .rendered import Rendered
from .truth import Annotation, Truth

if TYPE_CHECKING:
    from PIL.Image import Image

    from .sensor import Sensed

KINDS = {
    "images": ".jpg",
    "clean": ".png",
    "twin": ".png",
    "alpha": ".png",
    "depth": ".tif",
    "classes": ".png",
    "masks": ".png",
    "instances": ".png",
    "thermal": ".tif",
    "palette": ".png",
}
"""File extensions of maps by folder; `truth.FOLDER` is apart."""

CONTENT = {
    "images": "visible picture with sensor effects, JPEG",
    "clean": "the same without sensor effects, PNG",
    "twin": "the same as clean, without smoke, PNG",
    "alpha": "opacity of smoke in green light at the pixel's centre, 16-bit PNG; 65535: opaque",
    "depth": "planar depth of solid surfaces, m, 32-bit TIFF; 0: sky",
    "classes": "class of each pixel, 8-bit PNG",
    "masks": "ids of annotations, PNG: smoke in red, visible fire in green, amodal fire in blue",
    "instances": "numbers of trees and buildings, PNG: red + 256 green + 65536 blue",
    "thermal": "brightness temperature, degrees C, 32-bit TIFF, and conditions of the sensor, JSON",
    "palette": "thermal picture in colours, PNG; not for measurements",
    truth.FOLDER: "labels, camera, all draws and sources, JSON",
}
"""Content of each folder."""

_FULL = 65535  # alpha of opaque smoke
_NO_DATA, _DESCRIPTION, _PREDICTOR = 42113, 270, 317  # tags of TIFF: GDAL_NODATA; baseline; of floats: 3
_KELVIN = 273.15
_LEVEL = 3  # of PNG compression: 5 % larger than level 6 in a third of its time


@dataclass(frozen=True)
class Masks:
    """Ids of annotations in each pixel (h, w) uint8; 0: none.

    Attributes
    ----------
    smoke
        Plumes of smoke.
    fire
        Visible flames.
    amodal
        Flames, with those that smoke hides.
    """

    smoke: NDArray[np.uint8]
    fire: NDArray[np.uint8]
    amodal: NDArray[np.uint8]

    def visible_pixels(self, annotation: Annotation) -> NDArray[np.bool_]:
        """Return the visible pixels (h, w) of an annotation."""
        return (self.smoke if annotation.category == truth.SMOKE else self.fire) == annotation.id

    def amodal_pixels(self, annotation: Annotation) -> NDArray[np.bool_]:
        """Return the pixels (h, w) of an annotation without smoke in front of it."""
        return (self.smoke if annotation.category == truth.SMOKE else self.amodal) == annotation.id


def name(kind: str, index: int) -> str:
    """Return the path of a map, relative to the folder of the data set."""
    return f"{kind}/{truth.stem(index)}{KINDS[kind]}"


def write(
    folder: Path,
    labelled: Truth,
    masks: Masks,
    rendered: Rendered,
    sensed: Sensed,
    kinds: Collection[str] = tuple(KINDS),
) -> Truth:
    """Write the files of a sample, and its metadata last.

    Parameters
    ----------
    kinds
        Folders to write.

    Returns
    -------
    The truth with the names of its files.

    Raises
    ------
    InputError
        The disk is full, or the folder cannot be written.
    """
    index = labelled.index
    put: dict[str, Callable[[Path], object]] = {
        "images": lambda part: part.write_bytes(sensed.jpeg),
        "clean": lambda part: _save(part, eight_bits(rendered.rgb)),
        "twin": lambda part: _save(part, eight_bits(rendered.twin)),
        "alpha": lambda part: _save(part, _sixteen_bits(rendered.alpha)),
        "depth": lambda part: _save_floats(
            part, np.where(np.isfinite(rendered.depth), rendered.depth, 0.0), "planar depth, m", "0"
        ),
        "classes": lambda part: _save_classes(part, rendered.classes),
        "masks": lambda part: _save(part, np.dstack([masks.smoke, masks.fire, masks.amodal])),
        "instances": lambda part: _save(part, three_bytes(rendered.instance)),
        "thermal": lambda part: _save_floats(
            part, sensed.kelvin - _KELVIN, "brightness temperature, degrees C"
        ),
        "palette": lambda part: _save(part, sensed.palette),
    }
    written = {kind: name(kind, index) for kind in KINDS if kind in kinds}
    for kind, path in written.items():
        files.write(folder / path, put[kind])
    if "thermal" in written:
        written["thermal_conditions"] = f"thermal/{truth.stem(index)}.json"
        conditions = json.dumps(sensed.conditions, indent=1, allow_nan=False) + "\n"
        files.write_text(folder / written["thermal_conditions"], conditions)
    complete = replace(labelled, files=written)
    truth.write(folder, complete)
    return complete


def is_complete(folder: Path, index: int) -> bool:
    """Return whether a sample and its metadata are written."""
    return truth.path(folder, index).is_file()


def read(folder: Path, kind: str, index: int) -> NDArray:
    """Read a map of a sample.

    Returns
    -------
    images, clean, twin and palette: (h, w, 3) uint8; alpha: (h, w) 0..1; depth: (h, w) m, inf for the sky;
    classes: (h, w) uint8; instances: (h, w) int32; masks: (h, w, 3) uint8 (see `read_masks`);
    thermal: (h, w) K.

    Raises
    ------
    InputError
        The file is missing or damaged.
    """
    pixels = _read(folder / name(kind, index))
    if kind == "alpha":
        return (pixels / np.float32(_FULL)).astype(np.float32)
    if kind == "depth":
        return np.where(pixels > 0.0, pixels, np.inf).astype(np.float32)
    if kind == "instances":
        return pixels.astype(np.int32) @ np.array([1, 256, 65536], np.int32)
    return pixels + np.float32(_KELVIN) if kind == "thermal" else pixels


def read_masks(folder: Path, index: int) -> Masks:
    """Read the masks of the annotations of a sample.

    Raises
    ------
    InputError
        The file is missing or damaged.
    """
    pixels = read(folder, "masks", index)
    return Masks(*(np.ascontiguousarray(pixels[..., k]) for k in range(3)))


def eight_bits(picture: NDArray) -> NDArray[np.uint8]:
    """Round a picture of 0..1 to 0..255."""
    return np.rint(np.clip(picture, 0.0, 1.0) * 255.0).astype(np.uint8)


def _sixteen_bits(alpha: NDArray) -> NDArray[np.uint16]:
    return np.rint(np.clip(alpha, 0.0, 1.0) * _FULL).astype(np.uint16)


def three_bytes(numbers: NDArray) -> NDArray[np.uint8]:
    """Split numbers below 2^24 into three bytes (h, w, 3), the lowest first."""
    return np.stack([numbers >> shift & 255 for shift in (0, 8, 16)], axis=-1).astype(np.uint8)


def _image(pixels: NDArray) -> Image:
    from PIL import Image

    return Image.fromarray(np.ascontiguousarray(pixels))


def _save(part: Path, pixels: NDArray) -> None:
    """Save pixels as PNG."""
    _image(pixels).save(part, compress_level=_LEVEL)


def _save_classes(part: Path, values: NDArray[np.uint8]) -> None:
    image = _image(values)
    image.putpalette(bytes(sum(classes.COLOURS, ())))
    image.save(part)


def _save_floats(part: Path, values: NDArray, description: str, no_data: str = "") -> None:
    """Save a map as 32-bit TIFF, compressed without loss."""
    tags: dict[int, str | int] = {_DESCRIPTION: description, _PREDICTOR: 3}
    if no_data:
        tags[_NO_DATA] = no_data
    image = _image(values.astype(np.float32))
    image.save(part, "TIFF", compression="tiff_adobe_deflate", tiffinfo=tags)


def _read(path: Path) -> NDArray:
    remedy = "is damaged; delete the metadata of the sample and resume the data set"
    with reading(path):
        path.stat()
    try:
        with open_picture(path) as image:
            return np.array(image)
    except (OSError, ValueError, SyntaxError):
        raise input_error(path, remedy) from None


@contextmanager
def open_picture(path: Path) -> Iterator[Image]:
    """Open a picture of a data set; its pixels are read later.

    Raises
    ------
    OSError, ValueError, SyntaxError
        It is damaged.
    InputError
        It is a pipe or a device, or has more than `limits.SAMPLE_PIXELS` pixels.
    """
    from PIL import Image

    refuse_odd(path)
    with warnings.catch_warnings(action="ignore"):  # of damaged files
        try:
            opened = Image.open(path)
        except Image.DecompressionBombError:
            raise _too_many(path) from None
        with opened:
            if opened.width * opened.height > SAMPLE_PIXELS:
                raise _too_many(path)
            yield opened


def _too_many(path: Path) -> InputError:
    return input_error(path, f"has more than {SAMPLE_PIXELS:,} pixels; no sample has as many: remove it")
