"""Private output folder of a task, from which finished files are published. Runs without Blender."""

from __future__ import annotations

import functools
import json
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

from .. import files
from ..errors import writing
from ..render.fingerprint import Fingerprints
from ..render.store import Store
from ..run.content import fingerprint
from .entries import Entry, Log


class PrivateFolder:
    """Folder with a separate store on the local disk.

    Parameters
    ----------
    folder
        Folder that no other process uses.
    out
        Folder of the film.
    log
        Log of the attempt.
    """

    def __init__(self, folder: Path, out: Path, log: Log) -> None:
        self.folder, self.out, self.log = folder, out, log
        self.published = 0
        """Number of the last published entry of the store."""

    def seed(self, intact: Iterable[Entry], made_with: Fingerprints) -> None:
        """Enter the intact files of the film, so that they are not rendered again."""
        rows: dict[tuple[str, str], dict[str, dict[str, object]]] = defaultdict(dict)
        for each in intact:
            with writing(self.folder / each.path):
                _link_or_copy(self.out / each.path, self.folder / each.path)
            rows[each.camera, each.name][each.path] = each.as_row()
        with Store(self.folder, create=True) as store:
            for pair, made in rows.items():
                store.add(made_with[pair], made)
            self.published = store.latest_number()

    def publish(self) -> None:
        """Copy newly finished files into the film, then log them."""
        with Store(self.folder) as store:
            query = "SELECT number, path, settings, entry FROM files WHERE number > ? ORDER BY number"
            rows = store.data.fetch_all(query, self.published)
        entries = []
        for _, path, key, text in rows:
            files.write(self.out / path, functools.partial(_link_or_copy, self.folder / path))
            entries.append(Entry.of_row(path, key, json.loads(text)))
        if entries:
            before, self.published = self.published, rows[-1][0]
            try:
                self.log.write(*entries)
            except Exception:  # not by SIGTERM (SystemExit), after which the lines are in the log
                self.published = before
                raise


def verified_entries(found: Iterable[Entry], out: Path, made_with: Fingerprints) -> list[Entry]:
    """Select one entry per file: current settings, and the content of the file."""
    keys = {pair: fingerprint(values) for pair, values in made_with.items()}
    known: dict[str, Entry] = {}
    for each in found:
        right = keys.get((each.camera, each.name)) == each.fingerprint
        if each.path not in known and right and each.is_intact(out):
            known[each.path] = each
    return list(known.values())


def _link_or_copy(path: Path, other: Path) -> None:
    """Link or copy a file to another path, whose folder may not exist yet."""
    other.parent.mkdir(parents=True, exist_ok=True)
    files.link_or_copy(path, other)
