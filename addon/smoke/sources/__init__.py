"""Smoke sources: each module of this folder defines one, unless its name begins with "_".

A module defines `SOURCE`, a subclass of `Source` with the module's name.
"""

from __future__ import annotations

import functools
from collections.abc import Collection

from ... import plugins
from ...shot.shot import Shot
from ._source import Source, VolumeLayer, allows_ray_march

__all__ = ["Source", "VolumeLayer", "choose", "find_preview", "is_integrated", "known", "select"]


@functools.cache
def known() -> dict[str, type[Source]]:
    """Load all sources, by name."""
    return plugins.values(__name__, "SOURCE")


def find_preview() -> str:
    """Return the name of the source that is a quick preview of another one."""
    return next(name for name, source in known().items() if source.preview_of)


def choose(method: str, fields: Collection[str]) -> type[Source]:
    """Select the source of a run: one whose fields the run has, else the one named `method`."""
    own = (source for source in known().values() if source.fields and set(source.fields) <= set(fields))
    return next(own, None) or known()[method]


def select(shot: Shot) -> Source:
    """Create the source of a shot's smoke."""
    return choose(shot.settings.smoke.method, shot.run.fields)(shot)


def is_integrated(shot: Shot) -> bool:
    """Return whether Cycles renders frames without smoke, which is absent or ray-marched separately."""
    return allows_ray_march(shot) and (not shot.settings.smoke.enabled or select(shot).marched)
