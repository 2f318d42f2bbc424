"""Log of finished files: each attempt at a task appends to a separate log. Runs without Blender.

``farm/entries/00012-0123456789ab.jsonl`` starts with a line on the start of the attempt, has one line per
finished file, [path, bytes, sha256, fingerprint, camera, pass, frame, time, further values], and ends with a
line on the end of the attempt. No other process writes to it. Incomplete lines are ignored.
"""

from __future__ import annotations

import functools
import json
import os
import re
import socket
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from .. import files, leases
from ..errors import InputError, reading, writing
from ..limits import SETTINGS_BYTES
from ..run.content import sha256
from .plan import job_dir

FOLDER = "entries"
HEARTBEAT = 30.0  # s between two heartbeats of an attempt


class Entry(NamedTuple):
    """A finished file.

    Attributes
    ----------
    path
        Relative to the output folder.
    fingerprint
        Hash of the settings that determine the picture.
    name
        Name of the pass.
    time
        UTC of the frame, ISO 8601.
    more
        Further values of its entry in the store: credits, exposure, clock of an EXR file.
    """

    path: str
    bytes: int
    sha256: str
    fingerprint: str
    camera: str
    name: str
    frame: int
    time: str
    more: dict[str, Any]

    def is_intact(self, out: Path) -> bool:
        """Check that the file exists with this content."""
        try:
            path = out / self.path
            return path.stat().st_size == self.bytes and sha256(path) == self.sha256
        except OSError:
            return False

    def as_row(self) -> dict[str, Any]:
        """Convert to a row of a store."""
        row = self._asdict()
        del row["path"], row["fingerprint"]
        row["pass"] = row.pop("name")
        return row | row.pop("more")

    @classmethod
    def of_row(cls, path: str, fingerprint: str, row: dict[str, Any]) -> Entry:
        """Convert from a row of a store."""
        rest = dict(row)
        own = {name: rest.pop(name) for name in ("bytes", "sha256", "camera", "frame", "time")}
        return cls(path=path, fingerprint=fingerprint, name=rest.pop("pass"), more=rest, **own)


_ENTRY = str, int, str, str, str, str, int, str, dict
"""Types of an entry's values."""


@dataclass
class Attempt:
    """One run of a task's command, read from its log.

    Attributes
    ----------
    number
        Number of the task.
    began, last
        Time of its start and of its last heartbeat, s since 1970.
    host, process, scheduled
        Machine, process ID, and job of the scheduler (`scheduler_job`).
    ended
        Exit status; None while it runs, or if it was killed.
    message
        Error message of a failed attempt.
    text
        Complete lines of the log.
    """

    number: int
    text: str
    last: float
    began: float = 0.0
    host: str = ""
    process: int = 0
    scheduled: str = ""
    ended: int | None = None
    message: str = ""

    @property
    def entries(self) -> list[Entry]:
        """Finished files; lines of other versions of Firetwin are ignored."""
        lists = [line for line in _lines(self.text) if isinstance(line, list)]
        return [
            Entry(*line) for line in lists if len(line) == len(_ENTRY) and all(map(isinstance, line, _ENTRY))
        ]

    @functools.cached_property
    def paths(self) -> set[str]:
        """Paths of the entries, without JSON parsing: names of cameras and passes need no escapes."""
        return {line[: line.index('"')] for line in self.text.split('\n["')[1:]}


class Log:
    """Log of a running attempt."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("a", encoding="utf-8", newline="\n")

    def write(self, *lines: Any) -> None:
        """Append lines and flush them to the disk."""
        with writing(self.path):
            self._file.writelines(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)
            self._file.flush()
            os.fsync(self._file.fileno())

    def heartbeat(self) -> None:
        """Update the modification time of the log."""
        os.utime(self.path)

    def end(self, status: int, message: str = "") -> None:
        """Write the exit status of the attempt."""
        self.write({"ended": status, "message": message, "at": time.time()})

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def scheduler_job() -> str:
    """Return scheduler and job of this process: ``slurm 123``, ``htcondor 12.0``; empty if unknown."""
    if number := os.environ.get("SLURM_JOB_ID"):
        return f"slurm {number}"
    try:
        described = files.read_text(Path(os.environ["_CONDOR_JOB_AD"]), errors="replace", most=SETTINGS_BYTES)
        ids = [re.search(rf"(?m)^{name}\s*=\s*(\d+)", described)[1] for name in ("ClusterId", "ProcId")]  # type: ignore[index]
    except (KeyError, OSError, TypeError, InputError):
        return ""
    return f"htcondor {'.'.join(ids)}"


@contextmanager
def attempt(out: Path, number: int) -> Iterator[Log]:
    """Start an attempt at a task, with a heartbeat until it ends."""
    log = Log(_folder(out) / f"{number:05d}-{leases.new_owner()}.jsonl")
    try:
        where = {"host": socket.gethostname(), "process": os.getpid(), "scheduled": scheduler_job()}
        log.write({"began": time.time()} | where)
        with leases.heartbeats(HEARTBEAT, log.heartbeat):
            yield log
    finally:
        log.close()


def attempts(out: Path, number: int | None = None) -> list[Attempt]:
    """Read all attempts, or the attempts at one task, sorted by their start."""
    paths = _folder(out).glob("*.jsonl" if number is None else f"{number:05d}-*.jsonl")
    logs = [path for path in paths if re.match(r"\d+-", path.name)]
    return sorted(map(_read, logs), key=lambda each: each.began)


def by_path(found: list[Attempt]) -> dict[str, list[Entry]]:
    """Group entries by file: simultaneous attempts may both have rendered it."""
    known: dict[str, list[Entry]] = defaultdict(list)
    for each in found:
        for entry in each.entries:
            known[entry.path].append(entry)
    return known


def _read(path: Path) -> Attempt:
    with reading(path):
        text = files.read_text(path, errors="replace")
    whole = text[: text.rfind("\n") + 1]
    attempt = Attempt(int(path.name.partition("-")[0]), whole, path.stat().st_mtime)
    first, last = _value(whole.partition("\n")[0]), _value(whole[:-1].rpartition("\n")[2])
    if begin := _checked(first, began=(int, float), host=str, process=int, scheduled=str):
        attempt.began, attempt.host, attempt.process, attempt.scheduled = begin
    if end := _checked(last, ended=int, message=str, at=(int, float)):
        attempt.ended, attempt.message, attempt.last = end
    return attempt


def _checked(line: Any, **types: type | tuple[type, ...]) -> list[Any]:
    """Return values of a line by name; none if the line is not as this version writes it."""
    if not isinstance(line, dict) or not all(
        isinstance(line.get(name), each) for name, each in types.items()
    ):
        return []
    return [line[name] for name in types]


def _lines(text: str) -> list[Any]:
    """Parse the lines of a text."""
    lines = text.split("\n")[:-1]
    try:
        return list(json.loads(f"[{','.join(lines)}]"))
    except (ValueError, RecursionError):  # a crashed machine may leave any bytes
        return [value for line in lines if (value := _value(line)) is not None]


def _value(line: str) -> Any:
    try:
        return json.loads(line)
    except (ValueError, RecursionError):
        return None


def _folder(out: Path) -> Path:
    return job_dir(out) / FOLDER
