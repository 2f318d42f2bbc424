"""What tasks have made: each attempt at a task appends to a file of its own. Needs no Blender.

``farm/entries/00012-0123456789ab.jsonl`` has one line per finished file, [path, bytes, sha256, fingerprint,
camera, pass, frame, time], between one line of how the attempt began and one of how it ended. Nobody else
writes to it. A line that is cut off counts for nothing.
"""

from __future__ import annotations

import functools
import json
import os
import socket
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from .. import leases
from ..errors import writing
from ..run.content import sha256
from .plan import place

FOLDER = "entries"
HEARTBEAT = 30.0  # s between two heartbeats of an attempt


class Entry(NamedTuple):
    """A finished file.

    Attributes
    ----------
    path
        Relative to the output folder.
    fingerprint
        Of the settings that it was made with.
    name
        Of the pass.
    time
        UTC of the frame, ISO 8601.
    """

    path: str
    bytes: int
    sha256: str
    fingerprint: str
    camera: str
    name: str
    frame: int
    time: str

    def whole(self, out: Path) -> bool:
        """Whether the file is there and has this content."""
        try:
            path = out / self.path
            return path.stat().st_size == self.bytes and sha256(path) == self.sha256
        except OSError:
            return False

    def plain(self) -> dict[str, Any]:
        """As a store has it."""
        found = self._asdict()
        del found["path"], found["fingerprint"]
        found["pass"] = found.pop("name")
        return found


@dataclass
class Attempt:
    """One run of a task's command, as its file tells.

    Attributes
    ----------
    number
        Of the task.
    began, last
        When it began and when its last heartbeat was, s since 1970.
    ended
        Its exit status; None: it runs, or was killed.
    said
        Why it failed.
    text
        Its lines that are whole.
    """

    number: int
    text: str
    last: float
    began: float = 0.0
    host: str = ""
    ended: int | None = None
    said: str = ""

    @property
    def entries(self) -> list[Entry]:
        """What it finished."""
        return [Entry(*line) for line in _lines(self.text) if isinstance(line, list)]

    @functools.cached_property
    def paths(self) -> set[str]:
        """Paths of these entries. Quick: names of cameras and passes need no escapes."""
        return {line[: line.index('"')] for line in self.text.split('\n["')[1:]}


class Log:
    """An attempt's own file while it runs."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("a", encoding="utf-8")

    def write(self, *lines: Any) -> None:
        """Append lines, and have them on the disk."""
        with writing(self.path):
            self._file.writelines(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)
            self._file.flush()
            os.fsync(self._file.fileno())

    def heartbeat(self) -> None:
        """Set the file's time of change."""
        os.utime(self.path)

    def end(self, status: int, said: str = "") -> None:
        """Write how the attempt ended."""
        self.write({"ended": status, "said": said, "at": time.time()})

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()


@contextmanager
def attempt(out: Path, number: int) -> Iterator[Log]:
    """Begin an attempt at a task."""
    log = Log(_folder(out) / f"{number:05d}-{leases.new_owner()}.jsonl")
    try:
        log.write({"began": time.time(), "host": socket.gethostname()})
        with leases.heartbeats(HEARTBEAT, log.heartbeat):
            yield log
    finally:
        log.close()


def attempts(out: Path, number: int | None = None) -> list[Attempt]:
    """All attempts, or those at one task, in the order in which they began."""
    paths = _folder(out).glob("*.jsonl" if number is None else f"{number:05d}-*.jsonl")
    return sorted((_read(path) for path in paths), key=lambda each: each.began)


def by_path(found: list[Attempt]) -> dict[str, list[Entry]]:
    """Every entry of each file: attempts that ran at once may have made it twice."""
    known: dict[str, list[Entry]] = defaultdict(list)
    for each in found:
        for entry in each.entries:
            known[entry.path].append(entry)
    return known


def _read(path: Path) -> Attempt:
    text = path.read_text(encoding="utf-8")
    whole = text[: text.rfind("\n") + 1]
    made = Attempt(int(path.name.partition("-")[0]), whole, path.stat().st_mtime)
    first, last = _value(whole.partition("\n")[0]), _value(whole[:-1].rpartition("\n")[2])
    if isinstance(first, dict) and "began" in first:
        made.began, made.host = first["began"], first["host"]
    if isinstance(last, dict) and "ended" in last:
        made.ended, made.said, made.last = last["ended"], last["said"], last["at"]
    return made


def _lines(text: str) -> list[Any]:
    """Values of the lines of a text."""
    lines = text.split("\n")[:-1]
    try:
        return list(json.loads(f"[{','.join(lines)}]"))
    except ValueError:  # a machine that fell over may leave anything
        return [value for line in lines if (value := _value(line)) is not None]


def _value(line: str) -> Any:
    try:
        return json.loads(line)
    except ValueError:
        return None


def _folder(out: Path) -> Path:
    return place(out) / FOLDER
