"""Acceptance of model times: which times of a growing run are complete."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path


@dataclass(frozen=True)
class Listed:
    """A time that a model's files list: the time, its file, and its index in the file."""

    moment: datetime
    path: Path
    index: int


def reasons(
    listed: list[Listed], logged: Mapping[str, int], stable: Collection[str], ended: bool
) -> list[str]:
    """Return for each time why it is complete; "" from the first time on that is not known to be.

    Parameters
    ----------
    listed
        Ascending times.
    logged
        Number of times that the model's log reports as written, by file name.
    stable
        Paths whose size and modification time did not change between two polls.
    ended
        The model has ended.
    """
    reasons: list[str] = []
    for k, each in enumerate(listed):
        if logged.get(each.path.name, 0) > each.index:
            reason = "log"
        elif k < len(listed) - 1:
            reason = "next"
        elif ended:
            reason = "end"
        else:
            reason = "guessed" if str(each.path) in stable else ""
        if not reason:
            break
        reasons.append(reason)
    return reasons + [""] * (len(listed) - len(reasons))
