"""State of a growing run as ``status.json`` and as a page that browsers reload."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from .. import output
from ..html_text import quote
from ..progress import duration
from . import watched
from .watched import Accepted

_ROWS = 20  # times on the page
_COMPLETE = {
    "log": "named in the model's log",
    "next": "a later time exists",
    "end": "the model ended",
    "guessed": "guessed complete",
}


@dataclass(frozen=True)
class Status:
    """State of a watch.

    Attributes
    ----------
    state
        As `states.state`.
    message
        Sentence on the last event, or "".
    source
        Watched file or folder of the model.
    generation, times
        Number of the model's start, and accepted times of it.
    issued
        Start of the run, ISO 8601; "" before the first time.
    newest, accepted
        Newest model time, and clock time at which it was accepted; "" before the first.
    pending
        Listed times that are not known to be complete.
    updated
        Clock time of this status.
    every
        Time between polls, s.
    """

    state: str
    message: str
    source: str
    generation: int
    times: int
    issued: str
    newest: str
    accepted: str
    pending: int
    updated: str
    every: float


def create(
    state: str, message: str, source: Path, accepted: list[Accepted], pending: int, every: float
) -> Status:
    """Create a status from the accepted times of the last generation."""
    last = accepted[-1] if accepted else None
    return Status(
        state=state,
        message=message,
        source=str(source),
        generation=last.generation if last else 0,
        times=len(accepted),
        issued=accepted[0].origin.isoformat() if accepted else "",
        newest=last.time if last else "",
        accepted=last.accepted if last else "",
        pending=pending,
        updated=datetime.now(UTC).isoformat(timespec="seconds"),
        every=every,
    )


def write(folder: Path, status: Status, accepted: list[Accepted]) -> None:
    """Replace ``status.json`` and the page, which `watched.refuse_others` checks when the watch begins."""
    text = json.dumps(asdict(status), indent=1) + "\n"
    output.write_text(folder / watched.STATUS, text, overwrite=True)
    output.write_text(folder / watched.PAGE, page(status, accepted), overwrite=True)


def describe(status: Status) -> str:
    """Describe a status in one line."""
    if not status.newest:
        return f"{status.state}: no complete time yet"
    again = f", start {status.generation} of the model" if status.generation > 1 else ""
    noun = "time" if status.times == 1 else "times"
    return f"{status.state}: {status.times} {noun} up to {_clock(status.newest)}{again}"


def page(status: Status, accepted: list[Accepted]) -> str:
    """Format the page: state, issue time, and newest time with its age."""
    now = datetime.fromisoformat(status.updated)
    rows = [("State", status.state), ("Model output", status.source)]
    if status.newest:
        age = duration((now - datetime.fromisoformat(status.accepted)).total_seconds())
        rows += [
            ("Start of the run", _clock(status.issued)),
            ("Newest model time", _clock(status.newest)),
            ("Accepted", f"{_clock(status.accepted)}, {age} before this page"),
            ("Times", str(status.times)),
        ]
    if status.generation > 1:
        rows.append(("Starts of the model", f"{status.generation}; earlier runs stay"))
    if status.pending:
        rows.append(("Incomplete times", str(status.pending)))
    if status.message:
        rows.append(("Message", status.message))
    rows.append(("Page written", _clock(status.updated)))
    facts = "".join(f"<tr><th>{quote(name)}</th><td>{quote(text)}</td></tr>" for name, text in rows)
    listed = "".join(
        f"<tr><td>{quote(_clock(each.time))}</td><td>{quote(each.source)}</td>"
        f"<td>{quote(_COMPLETE.get(each.complete, each.complete))}</td></tr>"
        for each in reversed(accepted[-_ROWS:])
    )
    title = f"{status.state}: {Path(status.source).name}"
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="refresh" content="{max(5, round(status.every))}"><title>{quote(title)}</title>'
        "<style>body{font:16px sans-serif;margin:2em;max-width:60em}th,td{text-align:left;"
        "padding:.2em 1em .2em 0;vertical-align:top}table{margin-bottom:2em}</style></head>"
        f"<body><h1>{quote(title)}</h1><table>{facts}</table>"
        f"<h2>Newest times</h2><table><tr><th>Model time</th><th>File</th><th>Complete</th></tr>{listed}"
        "</table></body></html>\n"
    )


def _clock(iso: str) -> str:
    moment = datetime.fromisoformat(iso).astimezone(UTC)
    return f"{moment:%Y-%m-%d %H:%M:%S} UTC"
