"""Names of the biomes: the modules of ``scene/forest/biomes``, which are not imported here."""

from __future__ import annotations

import ast
import functools
from pathlib import Path

_FOLDER = Path(__file__).parents[2] / "scene" / "forest" / "biomes"


@functools.cache
def names() -> dict[str, str]:
    """Short description of each biome, from its docstring, by name."""
    return {path.stem: _about(path) for path in sorted(_FOLDER.glob("[a-z]*.py"))}


def choices() -> dict[str, str]:
    """Choices of the setting, by name."""
    return {"auto": "by place and fuel"} | names()


def _about(path: Path) -> str:
    with path.open(encoding="utf-8") as file:
        return str(ast.literal_eval(file.readline().strip())).rstrip(".")
