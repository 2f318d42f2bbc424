"""The other engine, in a separate process and without a display."""

from dataclasses import replace

import pytest
from firetwin.render import engine


@pytest.mark.parametrize(
    ("resolution", "tile"),
    [((640, 360), "2"), ((1920, 1080), "4"), ((3840, 2160), "8"), ((16384, 16384), "16")],
)
def test_larger_pictures_have_larger_boxes_of_smoke(settings, scene, resolution, tile):
    wanted = replace(settings.render, engine="eevee", resolution=resolution)
    engine.apply(replace(settings, render=wanted), scene)
    assert scene.eevee.volumetric_tile_size == tile
