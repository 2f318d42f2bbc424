"""Hugging Face ImageFolder: the pictures of each split, and `metadata.jsonl` with boxes and facts.

`objects` has `bbox` (x, y, width, height, pixels from the corner), `category` (0 fire, 1 smoke) and `name`.
The pictures are second names (hard links where the file system has them).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from ..truth import CATEGORIES, Truth
from . import common

FOLDER = "imagefolder"
_NAMES = {each.id: each.name for each in CATEGORIES}


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write one folder for each split."""
    for split, members in common.by_split(samples).items():
        folder = out / FOLDER / split
        for truth in members:
            name = common.picture(truth)
            common.link(set_folder / name, folder / PurePosixPath(name).name)
        common.write_lines(folder / "metadata.jsonl", [json.dumps(row(truth)) for truth in members])


def row(truth: Truth) -> dict[str, Any]:
    """Return the row of a sample: file name, boxes, and the facts by which users select samples."""
    return {"file_name": PurePosixPath(common.picture(truth)).name, "objects": objects(truth)} | facts(truth)


def objects(truth: Truth) -> dict[str, list[Any]]:
    """Return the boxes of a sample as lists."""
    return {
        "bbox": [common.corner_and_size(each.box) for each in truth.annotations],
        "category": [common.class_index(each) for each in truth.annotations],
        "name": [_NAMES[each.category] for each in truth.annotations],
        "distance_m": [each.distance_m for each in truth.annotations],
        "visible_fraction": [each.visible_fraction for each in truth.annotations],
    }


def facts(truth: Truth) -> dict[str, Any]:
    """Return the facts by which users select samples."""
    return {
        "index": truth.index,
        "place": truth.groups.get("place", ""),
        "run": truth.groups.get("run", ""),
        "camera": truth.groups.get("camera", ""),
        "utc": truth.utc,
        "negative": truth.is_negative,
        "seconds_since_ignition": truth.seconds_since_ignition,
    }
