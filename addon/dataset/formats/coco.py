"""COCO: instances and panoptic segments of each split. Masks are compressed run lengths; ids begin with 1.

`segmentation`, `bbox` and `area` belong to the visible pixels. `attributes` has what COCO has no key for:
amodal box, distance, heights, temperature. Panoptic segments do not overlap: fire is above smoke, smoke above
the classes of the ground. Pixels of fire or smoke that belong to no instance are void: 0.

Instances below the smallest size are regions with `iscrowd` 1, in which a detection is neither right nor
wrong.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from itertools import count
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import files, labels, rle
from ..truth import CATEGORIES, FIRE, SMOKE, Annotation, Truth, stem
from . import common

FORMAT = {"help": "annotations/: COCO instances and panoptic segments of each split"}
ORDER = 10
FOLDER = "annotations"
_SEGMENTS = 1000  # ids of segments of a category
_STANDARD = {"id", "category", "box", "pixels"}
_AROUND = math.isqrt(labels.MIN_PIXELS)  # pixels around a small instance, in which detections do not count


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write `instances_SPLIT.json`, `panoptic_SPLIT.json` and the folder of its PNG files."""
    numbers = count(1)
    for split, members in common.by_split(samples).items():
        instances: list[dict[str, Any]] = []
        panoptic: list[dict[str, Any]] = []
        pictures = out / FOLDER / f"panoptic_{split}"
        pictures.mkdir(parents=True)
        for truth in members:
            masks = files.read_masks(set_folder, truth.index)
            for each in truth.annotations:
                instances.append(_instance(truth, each, masks.visible_pixels(each), next(numbers)))
            instances += [_ignored(truth, each, next(numbers)) for each in truth.below_size if each.pixels]
            panoptic.append(_panoptic(set_folder, truth, masks, pictures))
        head = _head(members)
        things = [_category(each.id, each.name) for each in common.THINGS]
        all_kinds = [
            _category(each.id, each.name) | {"isthing": int(each.has_instances)} for each in CATEGORIES
        ]
        content = head | {"annotations": instances, "categories": things}
        common.write_json(out / FOLDER / f"instances_{split}.json", content)
        content = head | {"annotations": panoptic, "categories": all_kinds}
        common.write_json(out / FOLDER / f"panoptic_{split}.json", content)


def _head(samples: Sequence[Truth]) -> dict[str, Any]:
    images = [
        {
            "id": truth.index,
            "file_name": PurePosixPath(common.picture(truth)).name,
            "width": truth.camera.width,
            "height": truth.camera.height,
            "date_captured": truth.utc,
        }
        for truth in samples
    ]
    return {
        "info": {"description": "Synthetic wildfires of Firetwin", "version": "1"},
        "licenses": [],
        "images": images,
    }


def _category(number: int, name: str) -> dict[str, Any]:
    return {"id": number, "name": name, "supercategory": "wildfire"}


def _instance(truth: Truth, annotation: Annotation, mask: NDArray[np.bool_], number: int) -> dict[str, Any]:
    attributes = {name: value for name, value in asdict(annotation).items() if name not in _STANDARD}
    return {
        "id": number,
        "image_id": truth.index,
        "category_id": annotation.category,
        "bbox": common.corner_and_size(annotation.box),
        "area": annotation.pixels,
        "iscrowd": 0,
        "segmentation": rle.encode(mask),
        "attributes": attributes,
    }


def _ignored(truth: Truth, annotation: Annotation, number: int) -> dict[str, Any]:
    """Describe the region of an instance below the smallest size."""
    x0, y0, x1, y1 = (round(edge) for edge in annotation.box)
    region = np.zeros((truth.camera.height, truth.camera.width), np.bool_)
    region[max(y0 - _AROUND, 0) : y1 + _AROUND, max(x0 - _AROUND, 0) : x1 + _AROUND] = True
    area = int(region.sum())
    return _instance(truth, annotation, region, number) | {
        "bbox": _bounds(region),
        "area": area,
        "iscrowd": 1,
    }


def _panoptic(folder: Path, truth: Truth, masks: files.Masks, pictures: Path) -> dict[str, Any]:
    """Write the segments of a sample as PNG, with ids R + 256 G + 65536 B, and list them."""
    from PIL import Image

    segments = segment_ids(files.read(folder, "classes", truth.index), truth.annotations, masks)
    name = f"{stem(truth.index)}.png"
    Image.fromarray(files.three_bytes(segments)).save(pictures / name, compress_level=3)
    return {"image_id": truth.index, "file_name": name, "segments_info": _segments(segments)}


def segment_ids(
    classes: NDArray[np.uint8], annotations: Sequence[Annotation], masks: files.Masks
) -> NDArray[np.int64]:
    """Compute the segment (h, w) of each pixel: 1000 * category + id of the instance; 0 is void."""
    table = np.zeros(256, np.int64)
    for each in CATEGORIES:
        if not each.has_instances:
            table[each.value] = _SEGMENTS * each.id
    segments = table[classes]
    for category in (SMOKE, FIRE):
        for annotation in annotations:
            if annotation.category == category:
                segments[masks.visible_pixels(annotation)] = _SEGMENTS * category + annotation.id
    return segments


def _segments(segments: NDArray[np.int64]) -> list[dict[str, Any]]:
    entries = []
    areas = np.bincount(segments.ravel())
    for number in (np.flatnonzero(areas[1:]) + 1).tolist():  # without void
        entries.append(
            {
                "id": number,
                "category_id": number // _SEGMENTS,
                "area": int(areas[number]),
                "bbox": _bounds(segments == number),
                "iscrowd": 0,
            }
        )
    return entries


def _bounds(mask: NDArray[np.bool_]) -> list[int]:
    """Return x, y, width and height of the pixels of a mask."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    x, y = int(columns[0]), int(rows[0])
    return [x, y, int(columns[-1]) + 1 - x, int(rows[-1]) + 1 - y]
