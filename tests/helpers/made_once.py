"""Folders that tests share: made once in a test run, by the first of its processes that needs them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from firetwin import unfinished


def made_once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder of all worker processes, filled by `make`. Tests only read it; they change copies."""
    base = factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent
    folder, marker = base / name, base / f"{name}.made"
    lock = base / f"{name}.lock"
    lock.mkdir(exist_ok=True)
    with unfinished.locked(lock, wait=True):
        if not marker.exists():
            shutil.rmtree(folder, ignore_errors=True)  # of an attempt that failed
            folder.mkdir()
            make(folder)
            marker.touch()
    return folder
