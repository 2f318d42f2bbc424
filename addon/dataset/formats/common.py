"""Facts that several formats need: splits, runs, names of files, and boxes."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ... import files
from ..truth import CATEGORIES, Annotation, Box, Truth

THINGS = tuple(each for each in CATEGORIES if each.has_instances)
"""Categories with boxes; their position is the class index of formats that count from 0."""
UNSPLIT = "all"
"""Name of the only split of a set without splits."""
PICTURE = "images"
_ORDER = ("train", "val", "test")


def by_split(samples: Iterable[Truth]) -> dict[str, list[Truth]]:
    """Sort the samples into their splits: train, val, test, then others."""
    found: dict[str, list[Truth]] = defaultdict(list)
    for truth in samples:
        found[truth.split or UNSPLIT].append(truth)
    return {name: found[name] for name in sorted(found, key=_place)}


def by_run(samples: Iterable[Truth]) -> dict[str, list[Truth]]:
    """Sort the samples into their runs, which have separate local metres. Keys are unique folder names."""
    samples_of: dict[str, list[Truth]] = defaultdict(list)
    for truth in samples:
        samples_of[truth.groups.get("run", "run")].append(truth)
    folders: dict[str, list[Truth]] = {}
    for run in sorted(samples_of):
        name = re.sub(r"[^A-Za-z0-9_-]+", "_", run) or "run"
        while name in folders:
            name += "_"
        folders[name] = samples_of[run]
    return folders


def picture(truth: Truth) -> str:
    """Return the path of the visible picture, relative to the data set."""
    return truth.files[PICTURE]


def class_index(annotation: Annotation) -> int:
    """Return the class of an annotation for formats that count from 0: 0 fire, 1 smoke."""
    return [each.id for each in THINGS].index(annotation.category)


def corner_and_size(box: Box) -> list[float]:
    """Turn a box into x, y, width, height from the corner of the picture, as COCO has it."""
    x0, y0, x1, y1 = box
    return [x0, y0, x1 - x0, y1 - y0]


def write_json(path: Path, content: Any) -> None:
    """Write JSON without spaces; equal contents give equal bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def write_lines(path: Path, lines: Iterable[str]) -> None:
    """Write lines of text, with line feeds on every system."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8", newline="\n")


def numbers(values: Iterable[float]) -> str:
    """Format numbers in a line with 12 digits."""
    return " ".join(f"{float(value):.12g}" for value in values)


def link(source: Path, path: Path) -> None:
    """Give a file a second name in a folder that may not exist yet."""
    path.parent.mkdir(parents=True, exist_ok=True)
    files.link_or_copy(source, path)


def _place(split: str) -> tuple[int, str]:
    return (_ORDER.index(split) if split in _ORDER else len(_ORDER), split)
