"""The asset library: its content, and that Blender lists it as assets."""

import bpy
import numpy as np
import pytest
from firetwin.jobs import assets as job
from firetwin.progress import no_message, silent
from firetwin.scene import assets
from firetwin.scene.forest import models
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource

KINDS = ("objects", "materials", "node_groups")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """Return the path of a library."""
    return tmp_path_factory.mktemp("library") / job.BLEND


@pytest.fixture
def few(monkeypatch):
    """Two trees and a rock, in small pictures."""
    chosen = [models.every()[k] for k in (6, 12, models.ROCKS[0])]
    monkeypatch.setattr(models, "every", lambda: chosen)
    monkeypatch.setattr(models, "trees", lambda: chosen[:2])
    monkeypatch.setattr(assets, "_PICTURE", 16)


def test_trees_materials_and_groups_are_assets_in_catalogues(settings, few, library):
    settings.path.write_text(scene_file.text(settings))
    count = job.in_blender(ShotSource(str(settings.path)), library, silent, no_message)
    assert "Studio" not in bpy.data.scenes
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(library), assets_only=True) as (there, wanted):
        for kind in KINDS:
            setattr(wanted, kind, getattr(there, kind))
    blocks = {block.name: block for kind in KINDS for block in getattr(wanted, kind)}
    assert len(blocks) == count
    known = {job.identifier(name) for name in job.CATALOGUES}
    assert {block.asset_data.catalog_id for block in blocks.values()} <= known
    assert all(block.asset_data.description for block in blocks.values())
    assert {"Young Conifer 1", "Large Conifer Snag 1", "Rock 1"} <= blocks.keys()
    assert {"Firetwin Foliage", "Firetwin Smoke Flow", "Firetwin Trees", "Firetwin Flames"} <= blocks.keys()
    camera = blocks["Firetwin Thermal Camera"].asset_data
    assert camera.catalog_id == job.identifier("Compositor")
    assert camera.description.startswith("Brightness temperature (K)")
    assert camera.description.endswith("Inputs: Low, High, Knee, Palette")
    assert {"Firetwin Thermal Blend", "Firetwin Eye Dome", "Firetwin Overlay"} <= blocks.keys()
    assert blocks["Firetwin Haze"].asset_data.description == "Inputs: Density, Tint"
    assert "Haze Tint" in blocks["Firetwin Foliage Shader"].asset_data.description
    tree = blocks["Young Conifer 1"]
    pixels = np.empty(16 * 16 * 4, np.float32)
    tree.preview.image_pixels_float.foreach_get(pixels)
    red, green, _, seen = np.moveaxis(pixels.reshape(16, 16, 4), -1, 0)
    assert 0.1 < (seen > 0.5).mean() < 0.9  # a tree amid nothing
    assert green[seen > 0.5].mean() > red[seen > 0.5].mean()  # a living one: it stands alone, and is not dead
    rock = blocks["Firetwin Rock"]
    rock.preview.image_pixels_float.foreach_get(pixels)
    assert 0.1 < (pixels[3::4] > 0.5).mean() < 0.9  # the result
    assert tree.scale.z == assets.HEIGHTS["small"]  # of a model a metre tall
