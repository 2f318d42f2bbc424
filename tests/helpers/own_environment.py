"""Virtual environments in `build` for packages that tests run and Firetwin does not need."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

BUILD = Path(__file__).parents[2] / "build"


def installed(name: str, package: str) -> Path:
    """The environment's folder of programs; skips the test where the package cannot be installed.

    Parameters
    ----------
    name
        Of the environment.
    package
        With its version.
    """
    place = BUILD / name
    done = place / f"{package}.done"
    if not done.exists():
        made = [sys.executable, "-m", "venv", place]
        got = [place / "bin" / "pip", "install", "-q", package]
        for each in (made, got):
            ended = subprocess.run(each, capture_output=True, text=True)
            if ended.returncode:
                pytest.skip(f"{package} cannot be installed here: {ended.stderr.strip()[-300:]}")
        done.touch()
    return place / "bin"
