"""Members of ensembles as runs of a plan: their names and folders, and their conversion (`jobs.convert`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..did_you_mean import suggestion
from ..errors import input_error
from ..jobs import convert as job
from ..output import is_plain_name
from ..progress import MessageCallback, Progress, no_message, silent
from ..run import collections
from .plan import Plan

ALL = "all"
"""Word for all members of an ensemble in a plan."""


def chosen(path: Path, wanted: Sequence[str]) -> list[str]:
    """Return the names of the wanted members of an ensemble, in the ensemble's order for `ALL`.

    Raises
    ------
    InputError
        The ensemble cannot be read.
    """
    return collections.names(path) if list(wanted) == [ALL] else list(wanted)


def fault(path: Path, wanted: Sequence[str]) -> str | None:
    """Return why a run folder and a list of members do not belong together, or None."""
    if not (path.is_dir() and collections.sniff(path)):
        return f"{path} is not an ensemble; leave out members" if wanted else None
    if not wanted:
        return f'{path} is an ensemble; choose its members: members = ["{ALL}"]'
    if list(wanted) == [ALL]:
        return None
    known = collections.names(path)
    missing = next((name for name in wanted if name not in known), None)
    if missing is None:
        return None
    hint = suggestion(missing, known) or f"; known here: {', '.join(known[:20])}"
    return f'{path} has no member "{missing}"{hint}'


def folder(path: Path, member: str) -> Path:
    """Return the folder of the run of a member, next to its ensemble.

    Raises
    ------
    InputError
        The name of the member cannot name a folder.
    """
    if not is_plain_name(member):
        raise input_error(path, f"has a member {member!r}, which cannot name a folder; rename it")
    return path.parent / f"{path.name}_members" / member


def convert(plan: Plan, progress: Progress = silent, tell: MessageCallback = no_message) -> None:
    """Convert the members of a plan that have no run yet; a stopped conversion is resumed.

    Raises
    ------
    InputError, Error
        A member cannot be converted.
    """
    for run in plan.runs:
        if run.ensemble and not run.run.exists():
            tell(f"converting member {run.member} of {run.ensemble.name} to {run.run}")
            run.run.parent.mkdir(parents=True, exist_ok=True)
            job.run([run.ensemble], run.run, progress=progress, tell=tell, member=run.member)
