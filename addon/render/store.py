"""Store of an output folder: its finished files and the settings that produced them.

``store.sqlite`` records the size, the SHA-256 and the fingerprint of the settings of every finished file, and
the full settings of every fingerprint. Several renders, on one or several machines, may share a folder (see
`leases`). ``manifest.json`` has the same content for people and other programs.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .. import leases, output
from ..database import Database
from ..errors import input_error
from ..run.content import fingerprint, sha256, stamp
from ..shot import passes
from . import manifest

NAME = "store.sqlite"
_COSTS = "processor seconds"
_JOB = "farm/job.json"  # whose tasks write pictures before there is a store
_TABLES = f"""
CREATE TABLE files (number INTEGER PRIMARY KEY AUTOINCREMENT, path TEXT UNIQUE, settings TEXT, camera TEXT,
                    pass TEXT, frame INTEGER, stamp TEXT, entry TEXT);
CREATE INDEX pictures ON files (camera, pass, frame);
CREATE TABLE settings (key TEXT PRIMARY KEY, made TEXT);
CREATE TABLE notes (name TEXT PRIMARY KEY, note TEXT);
{leases.TABLES}"""


class Store:
    """The store of an output folder; each thread opens its own.

    Parameters
    ----------
    create
        Create the store if it is missing; otherwise a missing store reads as empty.

    Raises
    ------
    InputError
        The file is not a store, or the manifest next to it is not Firetwin's.
    """

    def __init__(self, out: Path, create: bool = False) -> None:
        self.out = out
        if not (out / NAME).exists():
            manifest.read(out)
        self.data = Database(out / NAME, _TABLES, create)

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.data.close()

    def add(self, settings: dict[str, Any], entries: dict[str, dict[str, Any]]) -> None:
        """Enter finished files (path -> entry with the values of `describe`), made with these `settings`."""
        key = fingerprint(settings)
        with self.data.change():
            self.data.execute("INSERT OR IGNORE INTO settings VALUES (?, ?)", key, json.dumps(settings))
            for path, entry in entries.items():
                self.data.execute(
                    "INSERT OR REPLACE INTO files (path, settings, camera, pass, frame, stamp, entry) "
                    "VALUES (?, ?, ?, ?, ?, ?, ?)",
                    *(path, key, entry.get("camera"), entry.get("pass"), entry.get("frame")),
                    *(self._stamp(path), json.dumps(entry)),
                )

    def is_intact(self, key: str, paths: Iterable[str], after: int = 0) -> bool:
        """Return whether these files are unchanged since they were made with the fingerprint `key`.

        Parameters
        ----------
        after
            Entries up to this number count as missing.
        """
        query = "SELECT number, settings, stamp, entry FROM files WHERE path = ?"
        for path in paths:
            row = self.data.fetch_one(query, path)
            if row is None or row[0] <= after or row[1] != key or not self._is_unchanged(path, *row[2:]):
                return False
        return True

    def entry(self, path: str) -> dict[str, Any]:
        """Return the entry of a finished file; empty if there is none."""
        row = self.data.fetch_one("SELECT entry FROM files WHERE path = ?", path)
        return json.loads(row[0]) if row else {}

    def inputs_of(self, path: str) -> dict[str, Any] | None:
        """Return the inputs that a finished file was made with; None for a file without an entry."""
        row = self.data.fetch_one(
            "SELECT made FROM files JOIN settings ON settings.key = files.settings WHERE path = ?", path
        )
        return json.loads(row[0]) if row else None

    def made_with_other_settings(self, keys: Iterable[str], since: int) -> list[tuple[str, int, str]]:
        """List pictures (camera, frame, pass) entered after `since` with other fingerprints than `keys`."""
        return self.data.fetch_all(
            "SELECT camera, frame, pass FROM files WHERE number > ? AND frame IS NOT NULL "
            "AND settings NOT IN (SELECT value FROM json_each(?)) ORDER BY number",
            *(since, json.dumps(list(keys))),
        )

    def pictures(self, camera: str, name: str, key: str, suffix: str) -> dict[int, str]:
        """Return hashes, by frame, of a camera's unchanged pictures in a pass made with these settings."""
        rows = self.data.fetch_all(
            "SELECT frame, path, stamp, entry FROM files WHERE camera = ? AND pass = ? AND settings = ? "
            "AND frame IS NOT NULL ORDER BY frame",
            *(camera, name, key),
        )
        return {
            frame: json.loads(entry)["sha256"]
            for frame, path, state, entry in rows
            if path.endswith(suffix) and self._is_unchanged(path, state, entry)
        }

    def differing(self, key: str, value: str, suffix: str) -> dict[str, dict[str, Any]]:
        """Return entries by path of pictures' files with a suffix whose `key` has another value or none."""
        rows = self.data.fetch_all(
            "SELECT path, entry FROM files WHERE frame IS NOT NULL AND path LIKE '%' || ? "
            "AND json_extract(entry, '$.' || ?) IS NOT ?",
            *(suffix, key, value),
        )
        return {path: json.loads(entry) for path, entry in rows}

    def latest_number(self) -> int:
        """Return the number of the latest entry; numbers increase with every entry."""
        (last,) = self.data.fetch_one("SELECT max(number) FROM files") or (None,)
        return last or 0

    def names(self) -> list[str]:
        """List the paths of all finished files, sorted."""
        return [path for (path,) in self.data.fetch_all("SELECT path FROM files ORDER BY path")]

    def note(self, name: str) -> str | None:
        """Read the note stored under a name; None if there is none."""
        row = self.data.fetch_one("SELECT note FROM notes WHERE name = ?", name)
        return row[0] if row else None

    def write_note(self, name: str, note: str) -> None:
        """Store a note under a name."""
        self.data.execute("INSERT OR REPLACE INTO notes VALUES (?, ?)", name, note)

    def add_cost(self, camera: str, seconds: dict[str, float]) -> None:
        """Note the mean processor seconds of a camera's frames in the last render, by part."""
        rounded = {name: round(value, 2) for name, value in seconds.items()}
        self.write_note(_COSTS, json.dumps(self._costs() | {camera: rounded}))

    def _costs(self) -> dict[str, Any]:
        return json.loads(self.note(_COSTS) or "{}")

    def export(self) -> None:
        """Write the manifest unless it is up to date."""
        number = str(self.latest_number())
        if self.note("exported") == number and (self.out / manifest.NAME).exists():
            return
        rows = self.data.fetch_all("SELECT path, settings, entry FROM files ORDER BY path")
        used = {key for _, key, _ in rows}
        made = self.data.fetch_all("SELECT key, made FROM settings ORDER BY key")
        settings = {key: json.loads(text) for key, text in made if key in used}
        entries = {path: json.loads(entry) | {"settings": key} for path, key, entry in rows}
        manifest.write(self.out, settings, entries, self._costs())
        self.write_note("exported", number)

    def _stamp(self, path: str) -> str | None:
        try:
            return json.dumps(stamp(self.out / path))
        except OSError:
            return None

    def _is_unchanged(self, path: str, state: str | None, entry: str) -> bool:
        """Return whether a file is unchanged, by its stamp or, if that differs (a copy), by its content."""
        now = self._stamp(path)
        if now is None or now == state:
            return now is not None
        made = json.loads(entry)
        try:
            return json.loads(now)[0] == made["bytes"] and sha256(self.out / path) == made["sha256"]
        except (OSError, KeyError):
            return False


def refuse_others(out: Path, views: Iterable[str]) -> None:
    """Refuse an output folder whose camera folders are of others, or that has links in their places.

    Raises
    ------
    InputError
        It is one, or is in the folder of a run.
    """
    output.refuse_run_folders(out / NAME)
    is_ours = any((out / each).is_file() for each in (NAME, manifest.NAME, _JOB))
    for folder in (out / passes.file_stem(view) for view in views):
        links = [each for each in (folder, *folder.glob("*")) if each.is_symlink()]
        if links:
            raise input_error(links[0], "is a link, which is not followed; choose another folder for --out")
        if folder.exists() and not is_ours:
            raise input_error(folder, "belongs to no film of Firetwin; choose another folder for --out")


def describe(path: Path) -> dict[str, Any]:
    """Compute the size and hash of a finished file."""
    return {"bytes": path.stat().st_size, "sha256": sha256(path)}
