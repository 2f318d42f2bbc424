"""Hugging Face ImageFolder: the pictures of each split, and `metadata.jsonl` with boxes and facts.

`objects` has `bbox` (x, y, width, height, pixels from the corner), `category` (0 fire, 1 smoke) and `name`.
The pictures are second names (hard links where the file system has them). The library infers the types of
columns from the first rows of each split, so a row without gaps is the first one.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from ..truth import CATEGORIES, Truth
from . import common

FORMAT = {"help": "imagefolder/: Hugging Face ImageFolder, metadata.jsonl of each split"}
ORDER = 40
FOLDER = "imagefolder"
_NAMES = {each.id: each.name for each in CATEGORIES}


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write one folder for each split."""
    for split, members in common.by_split(samples).items():
        folder = out / FOLDER / split
        for truth in members:
            name = common.picture(truth)
            common.link(set_folder / name, folder / PurePosixPath(name).name)
        rows = sorted((row(truth) for truth in members), key=_gaps)
        common.write_lines(folder / "metadata.jsonl", [json.dumps(each) for each in rows])


def row(truth: Truth) -> dict[str, Any]:
    """Return the row of a sample: file name, boxes, and the facts by which users select samples."""
    return {
        "file_name": PurePosixPath(common.picture(truth)).name,
        "objects": _objects(truth),
        "index": truth.index,
        "place": truth.groups.get("place", ""),
        "run": truth.groups.get("run", ""),
        "camera": truth.groups.get("camera", ""),
        "utc": truth.utc,
        "negative": truth.is_negative,
        "seconds_since_ignition": _float(truth.seconds_since_ignition),
    }


def _gaps(found: dict[str, Any]) -> int:
    """Count the columns whose type a row does not show."""
    columns = [*found["objects"].values(), [found["seconds_since_ignition"]]]
    return sum(all(value is None for value in column) for column in columns)


def _objects(truth: Truth) -> dict[str, list[Any]]:
    return {
        "bbox": [[float(side) for side in common.corner_and_size(each.box)] for each in truth.annotations],
        "category": [common.class_index(each) for each in truth.annotations],
        "name": [_NAMES[each.category] for each in truth.annotations],
        "distance_m": [_float(each.distance_m) for each in truth.annotations],
        "visible_fraction": [float(each.visible_fraction) for each in truth.annotations],
    }


def _float(value: float | None) -> float | None:
    return None if value is None else float(value)
