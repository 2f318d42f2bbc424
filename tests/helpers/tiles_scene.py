"""A shot on tiles made of its ground, prepared within the process of a test."""

import re
from dataclasses import replace

import pytest
from firetwin.blender import nodes
from firetwin.jobs.tiles import decode, make, selection
from firetwin.scene.terrain import material

__all__ = ["decoded_here", "plain_tiles", "tiled"]


@pytest.fixture
def plain_tiles(monkeypatch):
    """Tiles get a material of one colour: the ground's own is slow to make."""

    def build(shot, stage, images, photos=(), maps=None, skin="", globe=None):
        made, tree = nodes.material(skin or "Firetwin Ground")
        colour = tree.input(material.TILE_COLOUR, (1.0, 1.0, 1.0), "Colour")
        tree.surface(tree.output("ShaderNodeBsdfDiffuse", {"Color": colour}))
        return made

    monkeypatch.setattr(material, "build", build)


@pytest.fixture
def decoded_here(monkeypatch):
    """Decode within this process."""

    def here(contents, progress):
        return decode.in_process(contents, progress, print)

    monkeypatch.setattr(decode, "_limit", lambda memory: None)
    monkeypatch.setattr(decode, "run", here)


@pytest.fixture
def tiled(shot, tmp_path, decoded_here):
    """A shot on tiles made of its ground in `tmp_path`/set, prepared within this process."""
    make.run(shot, make.TilesRequest(tmp_path / "set", credit="Somebody", geoid=-24.9))
    known = replace(
        shot.settings.tiles, sources=(str(tmp_path / "set"),), max_screen_space_error=2.0, geoid=-24.9
    )
    found = shot.with_settings(replace(shot.settings, tiles=known, cache=tmp_path / "cache"))
    told = selection.make(found)
    assert told[0] == "credits of tiles, which pictures show: Somebody"
    assert re.fullmatch(r"the tiles' ground is 0\.0 m above .* 90 % of places\)", told[1])
    return found
