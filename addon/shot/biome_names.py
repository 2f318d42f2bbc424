"""Names of the biomes that there are: the modules of ``scene/forest/biomes``, which are not loaded here."""

from __future__ import annotations

import ast
import functools
from pathlib import Path

_FOLDER = Path(__file__).parents[1] / "scene" / "forest" / "biomes"


@functools.cache
def names() -> dict[str, str]:
    """A few words about each, of its docstring, by name."""
    return {path.stem: _about(path) for path in sorted(_FOLDER.glob("[a-z]*.py"))}


def choices() -> dict[str, str]:
    """What the setting may be."""
    return {"auto": "by place and fuel"} | names()


def _about(path: Path) -> str:
    with path.open(encoding="utf-8") as file:
        return str(ast.literal_eval(file.readline().strip())).rstrip(".")
