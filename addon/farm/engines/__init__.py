"""Schedulers, one per module of this folder; modules whose names begin with "_" are helpers.

Each module defines `ENGINE`, a subclass of `Engine` with the name of the module.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil

from ._engine import Batch, Engine

__all__ = ["Batch", "Engine", "known"]


@functools.cache
def known() -> dict[str, type[Engine]]:
    """Return all schedulers by name."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name[0] != "_")
    return {name: importlib.import_module(f"{__name__}.{name}").ENGINE for name in names}
