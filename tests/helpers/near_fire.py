"""Cameras near the fire, and the sun where a test wants it."""

from dataclasses import replace
from datetime import timedelta

import pytest
from firetwin.shot import sun

__all__ = ["close", "near", "sun_at"]

FRAMES = 24


@pytest.fixture
def close(settings):
    """A camera near the front, one second in 24 frames."""
    begin = settings.time.start + timedelta(minutes=30)
    return replace(
        moved(settings, latitude=38.8395, height=150.0),
        time=replace(settings.time, start=begin, end=begin + timedelta(seconds=1), frames=FRAMES),
    )


def moved(settings, **place):
    """Settings whose camera stands still elsewhere."""
    camera = settings.cameras[0]
    key = replace(camera.rig.keys[0], **place)
    return replace(settings, cameras=(replace(camera, rig=replace(camera.rig, keys=(key,))),))


@pytest.fixture
def sun_at(monkeypatch):
    """Put the sun at a height (degrees) for lamps and light alike."""

    def place(height):
        monkeypatch.setattr(sun, "position", lambda run, time: (200.0, height))

    return place


@pytest.fixture
def near(settings):
    """A camera near the front of the second frame."""
    return from_height(settings, 150.0)


def from_height(settings, height):
    """Settings with one camera that high over the front of the second frame."""
    return moved(settings, latitude=38.8395, height=height)
