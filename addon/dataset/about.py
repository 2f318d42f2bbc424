"""Facts about a complete data set: ``dataset.json``, written when its production begins."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from .. import output
from ..errors import input_error
from ..files import read_json

NAME = "dataset.json"


@dataclass(frozen=True)
class About:
    """Facts about a data set.

    Attributes
    ----------
    title
        Name of the data set.
    count
        Number of samples of the plan; 0: unknown.
    seed
        Seed of all draws.
    split_by
        Kind of the groups that are never in two splits: "place", "run" or "camera"; "" without splits.
    licence
        SPDX identifier of the licence of the data set; "" if its owner has not chosen one.
    units
        Unit of each drawn value, by name.
    """

    title: str = "Firetwin samples"
    count: int = 0
    seed: int = 0
    split_by: str = ""
    licence: str = ""
    units: Mapping[str, str] = field(default_factory=dict)


def write(folder: Path, about: About, overwrite: bool = False) -> Path:
    """Write the facts; equal facts give equal bytes."""
    output.write_text(folder / NAME, json.dumps(asdict(about), indent=1) + "\n", overwrite)
    return folder / NAME


def read(folder: Path) -> About:
    """Read the facts of a data set; defaults if the file is missing.

    Raises
    ------
    InputError
        The file is damaged.
    """
    path = folder / NAME
    if not path.is_file():
        return About()
    try:
        content: dict[str, Any] = read_json(path)
        known = {each.name: content[each.name] for each in fields(About) if each.name in content}
    except (OSError, ValueError, TypeError):
        raise input_error(path, "is damaged; delete it and resume the data set") from None
    return About(**known)
