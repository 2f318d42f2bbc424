"""Check of the formats of a data set: boxes of COCO and YOLO are within half a pixel of the truth."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from . import rle
from .check_labels import differs
from .findings import REWRITE, Finding
from .formats import coco, common, yolo
from .truth import Annotation, Box, Truth, stem

KIND = "formats"
Labels = Sequence[tuple[int, Box]]  # category and box


def check(folder: Path, samples: Sequence[Truth]) -> Iterator[Finding]:
    """Compare the files of each written format with the metadata."""
    for name, faults in (("coco", _coco), ("yolo", _yolo)):
        for fault in faults(folder, samples):
            yield Finding(KIND, f"{fault}; {REWRITE.format(folder=folder, name=name)}")


def _yolo(folder: Path, samples: Sequence[Truth]) -> Iterator[str]:
    if not (folder / "data.yaml").is_file():
        return
    for sample in samples:
        path = Path(yolo.FOLDER) / f"{stem(sample.index)}.txt"
        try:
            lines = (folder / path).read_text(encoding="utf-8").splitlines()
            found = [yolo.box(line, sample.camera) for line in lines]
        except (OSError, ValueError):
            yield f"{path}: is missing or damaged"
            continue
        yield from _compare(path, [(kind + 1, box) for kind, box in found], sample)


def _coco(folder: Path, samples: Sequence[Truth]) -> Iterator[str]:
    if not (folder / coco.FOLDER).is_dir():
        return
    for split, members in common.by_split(samples).items():
        path = Path(coco.FOLDER) / f"instances_{split}.json"
        try:
            content = json.loads((folder / path).read_text(encoding="utf-8"))
            images = {image["id"]: list[dict[str, Any]]() for image in content["images"]}
            for each in content["annotations"]:
                images[each["image_id"]].append(each)
            ids = [each["id"] for each in content["annotations"]]
        except (OSError, ValueError, KeyError, TypeError):
            yield f"{path}: is missing or damaged"
            continue
        if min(ids, default=1) < 1 or len(set(ids)) != len(ids):
            yield f"{path}: ids of annotations are repeated or below 1"
        if set(images) != {sample.index for sample in members}:
            yield f"{path}: does not have the samples of the split {split}"
            continue
        for sample in members:
            yield from _coco_sample(path, images[sample.index], sample)


def _coco_sample(path: Path, found: Sequence[dict[str, Any]], sample: Truth) -> Iterator[str]:
    boxes = [(each["category_id"], _corners(*each["bbox"])) for each in found]
    yield from _compare(path, boxes, sample)
    for each in found:
        try:
            pixels = int(rle.decode(each["segmentation"]).sum())
        except (ValueError, KeyError, TypeError):
            pixels = -1
        if pixels != each["area"]:
            yield f"{path}: the mask of annotation {each['id']} does not have its area"


def _corners(x: float, y: float, w: float, h: float) -> Box:
    return x, y, x + w, y + h


def _compare(path: Path, found: Labels, sample: Truth) -> Iterator[str]:
    """Compare the labels of a file, in the order of the annotations."""
    expected: Sequence[Annotation] = sample.annotations
    if [kind for kind, _ in found] != [each.category for each in expected]:
        yield f"{path}: has other labels for sample {sample.index} than the metadata"
        return
    for (_, box), each in zip(found, expected, strict=True):
        if differs(box, each.box):
            yield f"{path}: a box of sample {sample.index} is more than 0.5 pixels off"
