"""Automatic framing in a fraction of the time: few cameras to choose from, and no smoke before them."""

import pytest
from firetwin.auto_framing import chase, coarse_smoke, flank, overview
from firetwin.smoke import coarse

__all__ = ["few_cameras", "try_few"]


def try_few(patch):
    """Try few cameras, without smoke, and preview smoke on wider cells, for as long as the patch lasts."""
    patch.setattr(coarse, "COLUMNS", (600, 1200))
    patch.setattr(overview, "_BEARINGS", overview._BEARINGS[::4])
    patch.setattr(overview, "_HEIGHTS", overview._HEIGHTS[:2])
    patch.setattr(chase, "_SIDES", chase._SIDES[:2])
    patch.setattr(chase, "_HEIGHTS", chase._HEIGHTS[:2])
    patch.setattr(flank, "_PLACES", 2)
    patch.setattr(coarse_smoke, "_draw", lambda shot, frames: {})


@pytest.fixture
def few_cameras(monkeypatch):
    """Try few cameras."""
    try_few(monkeypatch)
