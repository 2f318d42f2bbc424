"""Model log: times that WRF reports as written in ``rsl.error.0000``, and its end.

Phrases: WRF, share/mediation_wrfmain.F and frame/module_io_quilt.F ("Timing for Writing"), main/wrf.F
("SUCCESS COMPLETE WRF"), frame/module_wrf_error.F ("FATAL CALLED FROM FILE").
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import Error, refuse_odd

NAME = "rsl.error.0000"
_WRITTEN = re.compile(r"Timing for Writing (\S+) for domain")
_SUCCESS = "SUCCESS COMPLETE WRF"
_FAILURES = ("FATAL CALLED FROM FILE", "forrtl: severe", "Segmentation fault", "SIGSEGV", "SIGTERM")
_MOST = 1 << 26  # bytes of a log that are read, from its end


@dataclass(frozen=True)
class ModelLog:
    """Content of a log: times written by file name, success, and the line of a failure."""

    written: dict[str, int] = field(default_factory=dict)
    succeeded: bool = False
    failure: str = ""


def read(folder: Path) -> ModelLog:
    """Read the log in a folder; a missing or unreadable log is empty."""
    try:
        refuse_odd(folder / NAME)
        with (folder / NAME).open("rb") as file:
            size = file.seek(0, 2)
            file.seek(max(0, size - _MOST))
            text = file.read().decode("utf-8", "replace")
    except (OSError, Error):
        return ModelLog()
    written = Counter(Path(name).name for name in _WRITTEN.findall(text))
    lines = text.splitlines()
    failed = next((" ".join(line.split()) for line in lines if any(mark in line for mark in _FAILURES)), "")
    return ModelLog(dict(written), _SUCCESS in text, failed[:200])
