"""States of a growing run: waiting, running, stalled, ended, failed, restarted."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from statistics import median

_STALLED = 3.0  # median intervals without a new time


def state(
    arrivals: Sequence[float], now: float, period: float, *, ended: bool, failed: bool, restarted: bool
) -> str:
    """Choose the state.

    Parameters
    ----------
    arrivals
        Clock times (s) at which times of this generation were accepted, ascending.
    now
        Clock time, s.
    period
        Time between polls, s. Times that came within one poll count as one arrival.
    ended, failed
        The model's log or an option says so.
    restarted
        The model started again, and no further time has come.
    """
    if failed:
        return "failed"
    if ended:
        return "ended"
    if not arrivals:
        return "waiting"
    if restarted:
        return "restarted"
    gaps = [after - before for before, after in itertools.pairwise(arrivals)]
    gaps = [gap for gap in gaps if gap > 0.5 * period]
    if gaps and now - arrivals[-1] > _STALLED * max(median(gaps), period):
        return "stalled"
    return "running"
