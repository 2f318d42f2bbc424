"""Notebooks of examples/notebooks: their cells, and a run of them as a program."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"


def read(name: str) -> dict[str, Any]:
    """Read a notebook."""
    return json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))


def code(name: str) -> list[str]:
    """Return the code of each cell."""
    return ["".join(cell["source"]) for cell in read(name)["cells"] if cell["cell_type"] == "code"]


def run(name: str, folder: Path, check: str) -> str:
    """Run all cells, then `check`, in one process without a display; return what they print."""
    script = folder / f"{name}.py"
    script.write_text("\n\n".join([*code(name), check]), encoding="utf-8")
    environment = os.environ | {"MPLBACKEND": "agg", "TMPDIR": str(folder)}
    done = subprocess.run(
        [sys.executable, script], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
