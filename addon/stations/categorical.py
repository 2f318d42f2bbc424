"""Categorical columns, such as kinds of resources: integer codes that a search compares in one step."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Categorical:
    """A categorical column: its distinct words, and the code (n,) of each row."""

    words: tuple[str, ...]
    index: NDArray[np.int64]

    @classmethod
    def from_values(cls, values: Iterable[str]) -> Categorical:
        """Encode a column of words."""
        number: dict[str, int] = {}
        index = np.array([number.setdefault(value, len(number)) for value in values], np.int64)
        return cls(tuple(number), index)

    def isin(self, wanted: Collection[str]) -> NDArray[np.bool_]:
        """Return a mask (n,) of the rows with one of these words; letter case is ignored."""
        low = {word.lower() for word in wanted}
        return np.array([word.lower() in low for word in self.words] or [False])[self.index]
