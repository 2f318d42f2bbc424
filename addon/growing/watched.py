"""Watched folder: accepted times of a growing run, its newest revision, and its state."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, fields
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from .. import output
from ..errors import Error, input_error
from ..files import read_json

TIMES, STATUS, PAGE = "times.json", "status.json", "index.html"
FINAL = ("ended", "failed")
"""States in which no times follow."""


@dataclass(frozen=True)
class Accepted:
    """An accepted time.

    Attributes
    ----------
    generation
        Number of the model's start, from 1.
    revision
        Number of times of the first run that has this time.
    time
        Model time, ISO 8601 in UTC.
    seconds
        Model time, s since the start of the generation's run.
    source, index
        File of the model, and index of the time in it.
    complete
        Reason why the time counts as complete: "log", "next", "end" or "guessed".
    sha256
        Hash of the time's values.
    accepted
        Clock time at which it was accepted, ISO 8601 in UTC.
    """

    generation: int
    revision: int
    time: str
    seconds: float
    source: str
    index: int
    complete: str
    sha256: str
    accepted: str

    @property
    def moment(self) -> datetime:
        """Model time."""
        return datetime.fromisoformat(self.time)

    @property
    def clock(self) -> float:
        """Clock time at which it was accepted, s."""
        return datetime.fromisoformat(self.accepted).timestamp()

    @property
    def origin(self) -> datetime:
        """Start of the generation's run."""
        return self.moment - timedelta(seconds=self.seconds)


def is_watched(folder: Path) -> bool:
    """Return whether `firetwin watch` writes or wrote to a folder."""
    return (folder / TIMES).is_file() or (folder / STATUS).is_file()


def refuse_others(folder: Path, overwrite: bool = False) -> None:
    """Refuse a folder that `firetwin watch` did not write, or whose files were changed, and links in it.

    Raises
    ------
    InputError
        It is one.
    """
    for name in (TIMES, STATUS, PAGE):
        output.check(folder / name, overwrite)
    for path in folder.glob("generation_*"):
        refuse_link(path)
    is_empty = not folder.exists() or (folder.is_dir() and not any(folder.iterdir()))
    if not (is_empty or overwrite or (is_watched(folder))):
        raise input_error(folder, "has files, and firetwin watch did not write them; choose another folder")


def refuse_link(path: Path) -> None:
    """Refuse a folder that is a link.

    Raises
    ------
    InputError
        It is one.
    """
    if path.is_symlink():
        raise input_error(path, "is a link, which is not followed; choose another folder")


def times(folder: Path) -> list[Accepted]:
    """List the accepted times of all generations.

    Raises
    ------
    InputError
        ``times.json`` is damaged.
    """
    path = folder / TIMES
    try:
        return [_accepted(each) for each in read_json(path)]
    except FileNotFoundError:
        return []
    except (OSError, ValueError, TypeError, OverflowError) as error:
        raise input_error(path, f"cannot be read ({error}); choose another --out") from None


def _accepted(entry: Any) -> Accepted:
    """Convert an entry of ``times.json``.

    Raises
    ------
    TypeError, ValueError
        It is not one: its numbers become names of folders.
    """
    accepted = Accepted(**entry)
    for each in fields(Accepted):
        value = getattr(accepted, each.name)
        kinds: tuple[type, ...] = {"int": (int,), "float": (int, float)}.get(str(each.type), (str,))
        if not isinstance(value, kinds) or isinstance(value, bool):
            raise TypeError(f"{each.name} is {value!r}")
    if accepted.generation < 1 or accepted.revision < 1 or not math.isfinite(accepted.seconds):
        raise ValueError("a number is out of range")
    if accepted.moment.tzinfo is None or accepted.clock < 0.0:
        raise ValueError("a time has no zone")
    for moment in (accepted.moment, accepted.origin):
        moment.astimezone(UTC)
    return accepted


def last_generation(accepted: list[Accepted]) -> list[Accepted]:
    """Return the times of the last generation."""
    return [each for each in accepted if each.generation == accepted[-1].generation]


def append(folder: Path, before: list[Accepted], new: list[Accepted]) -> list[Accepted]:
    """Append accepted times, and return all.

    Raises
    ------
    InputError
        Another process wrote to the folder.
    """
    if times(folder) != before:
        reason = "changed meanwhile: another watch writes to this folder; choose another --out"
        raise input_error(folder / TIMES, reason)
    every = [*before, *new]
    text = ",\n".join(json.dumps(asdict(each)) for each in every)
    output.write_text(folder / TIMES, f"[\n{text}\n]\n", overwrite=True)
    return every


def revision_folder(folder: Path, generation: int, revision: int) -> Path:
    """Return the folder of a revision: a run of the first `revision` times."""
    return folder / f"generation_{generation}" / f"{revision:06d}"


def newest(folder: Path) -> Path | None:
    """Return the run of all accepted times of the last generation; None before the first."""
    accepted = times(folder)
    if not accepted:
        return None
    return revision_folder(folder, accepted[-1].generation, accepted[-1].revision)


def status(folder: Path) -> dict[str, Any]:
    """Read ``status.json``; empty if there is none."""
    try:
        found = read_json(folder / STATUS)
    except (OSError, ValueError, Error):
        return {}
    return found if isinstance(found, dict) else {}


def is_final(folder: Path) -> bool:
    """Return whether no further times follow: the model ended or failed."""
    return status(folder).get("state") in FINAL


def of_revision(run: Path) -> Path | None:
    """Return the watched folder of a revision; None for other runs."""
    folder = run.parent.parent
    return folder if run.parent.name.startswith("generation_") and is_watched(folder) else None
