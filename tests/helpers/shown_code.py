"""Code blocks of the pages, and the marks above them.

``<!-- not checked: REASON -->`` excludes a block from all checks. ``<!-- not run: REASON -->`` excludes it
from running, ``<!-- not run (WORD, WORD): REASON -->`` only its lines with one of these words.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
RUN = (
    "stations.md",
    "brief.md",
    "citing.md",
    "tiles.md",
    "delivery.md",
    "forecasts.md",
    "datasets.md",
    "export.md",
    "farm.md",
    "pipelines.md",
    "api.md",
    "install.md",
    "walk.md",
)
"""Pages whose commands and Python `tests/system/test_documented_commands.py` runs."""
_BLOCK = re.compile(
    r"(?:^<!-- (not checked|not run|run by)(?: \(([^)]+)\))?:? (.+?) -->\n)?^```([^\n]*)\n(.*?)^```",
    re.M | re.S,
)
PROGRAM = re.compile(r"(?:\.venv/bin/|firetwin/bin/|films/bin/)?firetwin ")


@dataclass(frozen=True)
class Block:
    """Code block of a page: its mark ("not checked", "not run", "run by" or ""), and its language."""

    mark: str
    words: tuple[str, ...]
    reason: str
    kind: str
    code: str

    @property
    def is_code(self) -> bool:
        """True for commands and Python."""
        return self.is_shell or self.kind == "python"

    @property
    def is_shell(self) -> bool:
        """True for commands."""
        return self.kind in ("", "sh")

    def lines(self) -> Iterator[str]:
        """Return the lines that a test runs."""
        if self.mark in ("not checked", "run by") or (self.mark == "not run" and not self.words):
            return
        yield from (
            line for line in self.code.splitlines() if line and not any(word in line for word in self.words)
        )


def blocks(text: str) -> list[Block]:
    """Find the code blocks of a page."""
    return [
        Block(mark, tuple(filter(None, words.split(", "))), reason, kind.strip(), code)
        for mark, words, reason, kind, code in _BLOCK.findall(text)
    ]
