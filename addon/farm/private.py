"""A task's own output folder. What it finishes goes from there to the film's folder. Needs no Blender."""

from __future__ import annotations

import contextlib
import functools
import json
import os
import shutil
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

from .. import files
from ..render.fingerprint import Fingerprints
from ..render.store import Store
from ..run.content import fingerprint
from .entries import Entry, Log


class PrivateFolder:
    """A folder with a store of its own, on the machine's own disk.

    Parameters
    ----------
    folder
        Which other processes do not know.
    out
        Folder of the film.
    log
        Of the attempt.
    """

    def __init__(self, folder: Path, out: Path, log: Log) -> None:
        self.folder, self.out, self.log = folder, out, log
        self.published = 0
        """Number of the last entry of the store that is published."""

    def seed(self, whole: Iterable[Entry], made_with: Fingerprints) -> None:
        """Enter files of the film that are whole already, so that they are not made again."""
        found: dict[tuple[str, str], dict[str, dict[str, object]]] = defaultdict(dict)
        for each in whole:
            _same(self.out / each.path, self.folder / each.path)
            found[each.camera, each.name][each.path] = each.plain()
        with Store(self.folder, create=True) as store:
            for pair, made in found.items():
                store.add(made_with[pair], made)
            self.published = store.latest_number()

    def publish(self) -> None:
        """Give files that were finished since the last time their places in the film, then enter them."""
        with Store(self.folder) as store:
            query = "SELECT number, path, settings, entry FROM files WHERE number > ? ORDER BY number"
            rows = store.data.all(query, self.published)
        entries = []
        for _, path, key, text in rows:
            made = json.loads(text)
            files.write(self.out / path, functools.partial(_same, self.folder / path))
            content = made["bytes"], made["sha256"], key
            entries.append(Entry(path, *content, made["camera"], made["pass"], made["frame"], made["time"]))
        if entries:
            self.log.write(*entries)
            self.published = rows[-1][0]


def verified_entries(found: Iterable[Entry], out: Path, made_with: Fingerprints) -> list[Entry]:
    """Of each file an entry of the right settings that it agrees with."""
    keys = {pair: fingerprint(values) for pair, values in made_with.items()}
    known: dict[str, Entry] = {}
    for each in found:
        right = keys.get((each.camera, each.name)) == each.fingerprint
        if each.path not in known and right and each.whole(out):
            known[each.path] = each
    return list(known.values())


def _same(path: Path, other: Path) -> None:
    """Have the same file in another place: by a link where the disk allows it, else a copy."""
    other.parent.mkdir(parents=True, exist_ok=True)
    with contextlib.suppress(OSError):
        os.link(path, other)
        return
    shutil.copyfile(path, other)
