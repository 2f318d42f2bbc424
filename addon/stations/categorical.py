"""Columns of words, such as kinds of resources, as numbers that searches compare at once."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Categorical:
    """A column of words: the different ones, and the index (n,) of each row's."""

    words: tuple[str, ...]
    index: NDArray[np.int64]

    @classmethod
    def from_values(cls, values: Iterable[str]) -> Categorical:
        """Words of a column."""
        number: dict[str, int] = {}
        index = np.array([number.setdefault(value, len(number)) for value in values], np.int64)
        return cls(tuple(number), index)

    def isin(self, wanted: Collection[str]) -> NDArray[np.bool_]:
        """Which rows (n,) have one of these words, in any case of letters."""
        low = {word.lower() for word in wanted}
        return np.array([word.lower() in low for word in self.words] or [False])[self.index]
