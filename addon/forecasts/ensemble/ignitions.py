"""Ignitions of members: members whose first burned cells are far apart do not forecast one fire."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...geometry.grids import within
from ...progress import MessageCallback
from ...run.areas import cell_size
from . import write
from .manifest import MANIFEST, Manifest

ONE = 500.0
"""Distance (m) up to which first burned cells count as one ignition, at least two cells (by eye)."""


class Ignitions:
    """First burned cells of members, which are compared while the members are written.

    Attributes
    ----------
    distance
        Largest distance (m) between the first burned cells of the first member and of another, if it is above
        the limit; else 0.
    """

    def __init__(self, latitude: NDArray[np.float64], longitude: NDArray[np.float64]) -> None:
        self.cell = cell_size(latitude, longitude)
        self.distance = 0.0
        self._first: NDArray[np.bool_] | None = None
        self._near: NDArray[np.bool_] | None = None

    def watch(self, members: Iterable[write.Read]) -> Iterator[write.Read]:
        """Yield the members unchanged."""
        for member, values in members:
            if isinstance(values, np.ndarray):
                self._add(values)
            yield member, values

    def amend(self, manifest: Manifest, tell: MessageCallback) -> Manifest:
        """Return the manifest, of the kind `ignitions` if a forecast's members have other ignitions."""
        if not self.distance or manifest.kind != "forecast":
            return manifest
        tell(
            f"the members begin up to {self.distance / 1000.0:.1f} km apart: with other ignitions they do "
            f'not forecast one fire; if they do, write kind = "forecast" in {MANIFEST}'
        )
        return replace(manifest, kind="ignitions")

    def _add(self, arrival: NDArray) -> None:
        """Compare the first burned cells of a member with the first member's."""
        begin = max(float(np.min(arrival, initial=np.inf, where=~np.isnan(arrival))), 0.0)
        burned = arrival <= begin
        if not np.isfinite(begin) or not burned.any():
            return
        if self._first is None or self._near is None:
            self._first, self._near = burned, within(burned, max(ONE, 2.0 * max(self.cell)), self.cell)
        elif not (self._near & burned).any():
            apart = (_middle(burned) - _middle(self._first)) * self.cell
            self.distance = max(self.distance, float(np.hypot(*apart)))


def _middle(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the mean column and row of the cells of a mask."""
    return np.array([each.mean() for each in np.nonzero(mask)[::-1]])
