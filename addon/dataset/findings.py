"""Findings of the check of a data set: one line each, with the remedy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

RESUME = "delete {path} and resume the data set: firetwin dataset PLAN.toml --out {folder}"
REWRITE = "write the format again: firetwin dataset formats {folder} --format {name}"
_MOST = 20  # findings of a kind


@dataclass(frozen=True)
class Finding:
    """A finding.

    Attributes
    ----------
    kind
        Name of the check, such as "hashes".
    text
        Faulty file or group, fault and remedy, in one line.
    is_fault
        False: worth knowing, but the data set can be used.
    """

    kind: str
    text: str
    is_fault: bool = True


def limited(found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield at most 20 findings of each kind, then the number of others."""
    numbers: Counter[str] = Counter()
    for finding in found:
        numbers[finding.kind] += 1
        if numbers[finding.kind] <= _MOST:
            yield finding
    for kind, number in numbers.items():
        if number > _MOST:
            yield Finding(kind, f"{kind}: {number - _MOST:,} more findings of this kind")
