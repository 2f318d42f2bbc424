"""Formats of `firetwin export`: modules of this package with `write`, and the fields of their `Format`."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .. import plugins

if TYPE_CHECKING:
    from .request import ExportRequest


@dataclass(frozen=True)
class Format:
    """An export format.

    Attributes
    ----------
    title
        Name for menus.
    help
        Content of the files, in one line.
    has_smoke
        True if the format has smoke volumes, which can be omitted.
    """

    title: str
    help: str
    has_smoke: bool = False


@functools.cache
def known() -> dict[str, Format]:
    """List the formats, in order, without their imports."""
    found = plugins.declared(Path(__file__).parent, "FORMAT")
    return {name: Format(**each) for name, each in found.items()}


def writer(name: str) -> Callable[[ExportRequest], list[Path]]:
    """Return the function that writes a format into the folder of a request, and lists the main files.

    A format without `write` has `write_content`, which a worker process with Blender calls.
    """
    from . import scene_job

    return getattr(plugins.module(__package__, name), "write", scene_job.run)
