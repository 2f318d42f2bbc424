"""Cameras close to the fire, and a fixed position of the sun."""

from dataclasses import replace
from datetime import timedelta

import pytest
from firetwin.run import sun

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
    """Settings whose camera stands at another place."""
    camera = settings.cameras[0]
    key = replace(camera.rig.keys[0], **place)
    return replace(settings, cameras=(replace(camera, rig=replace(camera.rig, keys=(key,))),))


@pytest.fixture
def sun_at(monkeypatch):
    """Set the sun's elevation (degrees) for both lamps and light."""

    def place(height):
        monkeypatch.setattr(sun, "position", lambda run, time: (200.0, height))

    return place


@pytest.fixture
def near(settings):
    """A camera close to the front of the second frame."""
    return from_height(settings, 150.0)


def from_height(settings, height):
    """Settings with one camera at a height over the front of the second frame."""
    return moved(settings, latitude=38.8395, height=height)
