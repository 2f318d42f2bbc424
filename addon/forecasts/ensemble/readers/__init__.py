"""Readers of ensembles: each module reads the members of one fire model, recognised by names and content.

A module has ``NAME``, the format's name for people, ``sniff(paths) -> bool``, whether the files are an
ensemble of this format, and ``read(paths, options, horizon) -> MemberSet``. They are tried in the order of
``ORDER``.
"""

from __future__ import annotations

from pathlib import Path

from .... import plugins
from ....errors import InputError, input_error
from ....run.models import probability_maps
from ....run.models.model import Options
from ..member_set import MemberSet
from .files_in import files_in


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read members with the first reader that recognises the files.

    Parameters
    ----------
    paths
        Files and folders of one forecast.
    horizon
        Length of the forecast, s; 0: from the files.

    Raises
    ------
    InputError
        No reader recognises them, or a file is damaged.
    """
    modules = plugins.modules(__name__, "read").values()
    for module in modules:
        if module.sniff(paths):
            return module.read(paths, options, horizon)
    for path in files_in(paths):
        if error := probability_maps.refusal(path):
            raise error
    raise unknown(paths[0], [module.NAME for module in modules])


def unknown(path: Path, names: list[str]) -> InputError:
    """Create the error for files that no reader recognises."""
    return input_error(
        path,
        f"is not an ensemble of {', '.join(names)}; for other models list runs in ensemble.toml",
    )
