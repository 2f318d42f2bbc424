"""Former names of files: views of comparison runs had ``@`` in their paths (see `passes.file_stem`)."""

from __future__ import annotations

import contextlib
from pathlib import Path, PurePosixPath

from ..errors import writing
from ..shot import passes
from . import store as stores
from .store import Store


def rename(out: Path) -> int:
    """Rename files of an output folder that have a former name, and their entries; return their number.

    A file whose present name is in the store, too, keeps its former name. After an interruption the next
    call renames the rest.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    if not (out / stores.NAME).exists():
        return 0
    with Store(out) as store:
        names = store.names()
        former = [name for name in names if "@" in name and passes.file_stem(name) not in {*names}]
        for name in former:
            path = out / passes.file_stem(name)
            with writing(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                with contextlib.suppress(FileNotFoundError):  # renamed already, or deleted
                    (out / name).replace(path)
            store.rename(name, passes.file_stem(name))
        for name in former:
            for folder in PurePosixPath(name).parents[:-1]:
                with contextlib.suppress(OSError):  # it has other files
                    (out / folder).rmdir()
    return len(former)
