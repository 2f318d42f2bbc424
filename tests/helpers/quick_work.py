"""Work that tests share or leave out: aprons of equal land, and waiting for the disk."""

import os

import numpy as np
import pytest
from firetwin.shot.terrain import apron

__all__ = ["no_waiting_for_the_disk", "shared_aprons"]


@pytest.fixture(autouse=True)
def no_waiting_for_the_disk(monkeypatch):
    """No test cuts the power, so files need not be on the disk."""
    monkeypatch.setattr(os, "fsync", lambda descriptor: None)


_aprons = {}


@pytest.fixture(autouse=True)
def shared_aprons(monkeypatch):
    """Shots of the same land share its apron, unless an elevation model has heights there."""
    extend = apron.extend

    def known_or_extended(fields, cell, half_width, seed, known=None):
        arrays = (np.ascontiguousarray(array).tobytes() for array in list(vars(fields).values())[:5])
        key = (*arrays, fields.elevation.shape, cell, half_width, seed)
        if known is not None:
            return extend(fields, cell, half_width, seed, known)
        if key not in _aprons:
            _aprons[key] = extend(fields, cell, half_width, seed)
        return _aprons[key]

    monkeypatch.setattr(apron, "extend", known_or_extended)
