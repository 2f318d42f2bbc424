"""Schedulers, one per module of this folder; modules whose names begin with "_" are helpers.

Each module defines `ENGINE`, a subclass of `Engine` with the name of the module.
"""

from __future__ import annotations

import functools

from ... import plugins
from ._engine import Batch, Engine

__all__ = ["Batch", "Engine", "known"]


@functools.cache
def known() -> dict[str, type[Engine]]:
    """Return all schedulers by name."""
    return plugins.values(__name__, "ENGINE")
