"""WebDataset: tar files of about 1 GB by split. A key such as ``000137`` has no dots, the kind follows it.

``000137.jpg`` is the picture, ``000137.json`` the metadata, and ``000137.alpha.png`` the file in `alpha`.
"""

from __future__ import annotations

import io
import tarfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from .. import truth as truths
from ..truth import Truth
from . import common

FORMAT = {"help": "webdataset/: tar files of about 1 GB, with all files of each sample"}
ORDER = 60
FOLDER = "webdataset"


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write the tar files; equal samples give equal bytes."""
    (out / FOLDER).mkdir()
    for split, members in common.by_split(samples).items():
        for number, part in enumerate(common.shards(set_folder, members)):
            with tarfile.open(
                out / FOLDER / f"{split}-{number:06d}.tar", "w", format=tarfile.USTAR_FORMAT
            ) as tar:
                for truth in part:
                    for name, file in _files(set_folder, truth).items():
                        _add(tar, name, file.read_bytes())


def _files(folder: Path, truth: Truth) -> dict[str, Path]:
    """Return the files of a sample by their names in the tar file."""
    key = truths.stem(truth.index)
    found = {f"{key}.json": truths.path(folder, truth.index)}
    for kind, name in sorted(truth.files.items()):
        end = PurePosixPath(name).suffix
        found[f"{key}{end}" if kind == common.PICTURE else f"{key}.{kind}{end}"] = folder / name
    return found


def _add(tar: tarfile.TarFile, name: str, content: bytes) -> None:
    entry = tarfile.TarInfo(name)
    entry.size = len(content)
    tar.addfile(entry, io.BytesIO(content))
