"""A shot on tiles made of its ground, prepared within the process of a test."""

import re
import shutil
from dataclasses import replace

import pytest
from decoding import decode_here, decoded_here
from firetwin.blender import nodes
from firetwin.jobs.tiles import make, selection
from firetwin.scene.terrain import material
from firetwin.shot.shot import Shot
from firetwin.shot.terrain import tile_heights
from made_once import made_once
from small_scene import small_settings

__all__ = ["decoded_here", "plain_tiles", "prepared_tiles", "tiled"]

FEW = 400  # points of heights of tiles


@pytest.fixture
def plain_tiles(monkeypatch):
    """Tiles get a material of one colour: the ground's own is slow to make."""

    def build(shot, stage, images, photos=(), maps=None, skin="", globe=None):
        made, tree = nodes.material(skin or "Firetwin Ground")
        colour = tree.input(material.TILE_COLOUR, (1.0, 1.0, 1.0), "Colour")
        tree.surface(tree.output("ShaderNodeBsdfDiffuse", {"Color": colour}))
        return made

    monkeypatch.setattr(material, "build", build)


@pytest.fixture(scope="session")
def prepared_tiles(factory, run_folder, run, tmp_path_factory):
    """A folder with `set`, a tileset made of the ground of the small run, and `cache`, its prepared tiles."""

    def write(folder):
        with pytest.MonkeyPatch.context() as patch:
            decode_here(patch)
            patch.setattr(tile_heights, "_MOST", FEW)
            shot = Shot(small_settings(run_folder, folder), run)
            make.run(shot, make.TilesRequest(folder / "set", credit="Somebody", geoid=-24.9))
            told = selection.make(on_tiles(shot, folder, folder / "cache"))
        assert told[0] == "credits of tiles, which pictures show: Somebody"
        assert re.fullmatch(r"the tiles' ground is 0\.0 m above .* 90 % of places\)", told[1])

    return made_once(tmp_path_factory, "prepared_tiles", write)


def on_tiles(shot, folder, cache):
    """Make a shot on the tileset `set` of a folder."""
    sources = (str(folder / "set"),)
    tiles = replace(shot.settings.tiles, sources=sources, max_screen_space_error=2.0, geoid=-24.9)
    return shot.with_settings(replace(shot.settings, tiles=tiles, cache=cache))


@pytest.fixture
def tiled(shot, tmp_path, prepared_tiles, decoded_here, monkeypatch):
    """A shot on prepared tiles of its ground, with a cache of its own."""
    monkeypatch.setattr(tile_heights, "_MOST", FEW)
    shutil.copytree(prepared_tiles / "cache", tmp_path / "cache")
    return on_tiles(shot, prepared_tiles, tmp_path / "cache")
