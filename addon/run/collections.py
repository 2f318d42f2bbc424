"""Collections of runs, such as ensembles: each run has a name, and can be converted to a run folder.

A feature's ``run_collection.py`` reads one kind. It has ``sniff(path)``, ``names(path)``, the names of the
runs, and ``read(paths, options, name) -> Model``, where the paths are a collection and its terrain's rasters.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from .. import plugins
from ..errors import input_error
from .models.model import Model, Options


def sniff(path: Path) -> bool:
    """Check whether a path is a collection."""
    return _kind(path) is not None


def names(path: Path) -> list[str]:
    """Return the names of the runs of a collection.

    Raises
    ------
    InputError
        It is damaged.
    """
    kind = _kind(path)
    return kind.names(path) if kind else []


def read(paths: list[Path], options: Options, name: str) -> Model:
    """Read a run of the collection among the paths as a model.

    Raises
    ------
    InputError
        None of the paths is a collection, or it has no such run.
    """
    kind = next(filter(None, map(_kind, paths)), None)
    if kind is None:
        reason = "is not an ensemble; make one: firetwin convert IN --members --out ENSEMBLE"
        raise input_error(paths[0], reason)
    model: Model = kind.read(paths, options, name)
    return model


def _kind(path: Path) -> ModuleType | None:
    return next((each for each in plugins.of_features("run_collection") if each.sniff(path)), None)
