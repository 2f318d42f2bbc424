"""Formats of data sets: modules with `write(set_folder, samples, out)`, and the fields of their `Format`.

`set_folder` has the files of the samples, and `out` is an empty folder, whose content moves to `set_folder`
after all of it is written (see `staging`). So paths in its files are relative to `set_folder`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ... import plugins
from ...errors import UsageError
from ...staging import staging

if TYPE_CHECKING:
    from ..truth import Truth

    Writer = Callable[[Path, Sequence[Truth], Path], None]


@dataclass(frozen=True)
class Format:
    """A format of data sets.

    Attributes
    ----------
    help
        Content and place of the files, in one line.
    """

    help: str


FORMATS = {name: Format(**each) for name, each in plugins.declared(Path(__file__).parent, "FORMAT").items()}


_CONVERTERS = {
    "parquet": "write hf, and convert it with Dataset.to_parquet of the library datasets (docs/datasets.md)",
    "tum": "write colmap or nerfstudio, which have the same poses",
    "voc": "write coco, and convert it: pip install globox; globox convert -f coco -F pascalvoc FILE voc",
    "webdataset": "pack the files of a sample with webdataset.ShardWriter (docs/datasets.md)",
}
"""Remedies for formats of former versions."""


def names(text: str) -> tuple[str, ...]:
    """Split a list of formats such as ``coco,yolo``; "all" stands for each.

    Raises
    ------
    UsageError
        A format is unknown.
    """
    if text == "all":
        return tuple(FORMATS)
    chosen = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    for name in chosen:
        if name in _CONVERTERS:
            raise UsageError(f"firetwin does not write {name}; {_CONVERTERS[name]}")
        if name not in FORMATS:
            raise UsageError(f'there is no format "{name}"; choose from {", ".join(FORMATS)}, all')
    return chosen


def writer(name: str) -> Writer:
    """Return the function that writes a format."""
    return plugins.module(__name__, name).write


def write(
    set_folder: Path, samples: Sequence[Truth], formats: Iterable[str], overwrite: bool = False
) -> None:
    """Write the labels of the samples in each format; files of a format appear when it is complete.

    Raises
    ------
    InputError
        The disk is full, a file of a sample is missing or damaged, or a file of others is in the way.
    """
    for name in formats:
        with staging(set_folder, overwrite) as out:
            writer(name)(set_folder, samples, out)
