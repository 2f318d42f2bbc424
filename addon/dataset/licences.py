"""Licences and credits of the sources of a data set, from the metadata of its samples.

`Truth.source` has `licences`, the SPDX identifier of the licence of each source by name, and `credits`, lines
that users of the pictures must show. `imagery` has the list of allowed licences of photographs.
"""

from __future__ import annotations

from collections.abc import Iterable

from .truth import Truth

LICENCES, CREDITS = "licences", "credits"
NOT_STATED = "not stated"


def of_samples(samples: Iterable[Truth]) -> dict[str, str]:
    """Collect the licence of each source, by name; "not stated" if a source has none."""
    found: dict[str, str] = {}
    for truth in samples:
        found |= truth.source.get(LICENCES, {})
    return {name: licence or NOT_STATED for name, licence in sorted(found.items())}


def credits_of(samples: Iterable[Truth]) -> list[str]:
    """Collect the credits of the sources, each once."""
    return sorted({line for truth in samples for line in truth.source.get(CREDITS, ())})
