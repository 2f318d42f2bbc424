"""Engines: each module of this folder is one, unless its name begins with "_".

It defines `ENGINE`, a class of `Engine` whose name is the module's.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil

from ._engine import Batch, Engine

__all__ = ["Batch", "Engine", "known"]


@functools.cache
def known() -> dict[str, type[Engine]]:
    """Every engine by its name."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name[0] != "_")
    return {name: importlib.import_module(f"{__name__}.{name}").ENGINE for name in names}
