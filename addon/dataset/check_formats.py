"""Check of the formats of a data set: their files are those that the metadata give now."""

from __future__ import annotations

import filecmp
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from .. import plugins
from ..errors import InputError
from . import formats
from .findings import REWRITE, Finding
from .truth import Truth

KIND = "formats"
CHECKED = ("coco", "yolo", "nerfstudio", "colmap")
"""Formats that refer to the pictures of the set."""


def check(folder: Path, samples: Sequence[Truth]) -> Iterator[Finding]:
    """Write each format that the set has again, in a temporary folder, and compare the files."""
    for name in CHECKED:
        if not (folder / plugins.module(formats.__name__, name).FOLDER).is_dir():
            continue
        with tempfile.TemporaryDirectory() as temporary:
            try:
                formats.writer(name)(folder, samples, Path(temporary))
            except InputError:  # a missing file, which is reported with the files
                continue
            for again in sorted(each for each in Path(temporary).rglob("*") if each.is_file()):
                path = again.relative_to(temporary).as_posix()
                if not (folder / path).is_file() or not filecmp.cmp(folder / path, again, shallow=False):
                    remedy = REWRITE.format(folder=folder, name=name)
                    yield Finding(KIND, f"{path}: does not agree with the metadata; {remedy}")
