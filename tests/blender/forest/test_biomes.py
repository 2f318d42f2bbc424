"""Biomes and land use in Blender: their effect on the ground's material and the forest."""

import json
from dataclasses import asdict, replace

import bpy
import numpy as np
import pytest
from firetwin.scene.forest import biomes, levels, models, stand
from firetwin.scene.forest import build as forest
from firetwin.scene.terrain import build as ground
from firetwin.scene.terrain import fields, material
from firetwin.shot.shot import Shot

OTHERS = sorted(set(biomes.known()) - {"sierra_conifer"})


def of(settings, run, name, **more):
    return Shot(replace(settings, forest=replace(settings.forest, biome=name, **more)), run)


def test_the_sierra_has_the_images_and_plants_that_it_had(near_settings, run, stage):
    chosen, auto = (of(near_settings, run, name) for name in ("sierra_conifer", "auto"))
    made = fields.create_images(auto, None)
    assert set(made) == {f"Firetwin Ground {name}" for name in ("Fuel", "Fire", "Front", "Scar")}
    first, second = stand.grow(chosen), stand.grow(auto)
    assert np.array_equal(first.model, second.model)
    assert np.array_equal(first.position, second.position)
    assert first.model.max() < models.SNAGS[0]


def branches(name):
    """Choices that decide which nodes the ground of a biome has: fields, tracks, hedges, tillage."""
    land = biomes.known()[name].open_land
    return min(land.field) > 0.0, land.tracks > 0.0, land.hedge > 0.0, land.tilled > 0.0


def form(value):
    """Nested names and lengths of colours and numbers, without their values."""
    if isinstance(value, dict):
        return {key: form(each) for key, each in value.items()}
    return [form(each) for each in value] if isinstance(value, tuple) else type(value)


def colours(name):
    """Values of a biome that the nodes of its ground show."""
    found = asdict(biomes.known()[name])
    return {key: each for key, each in found.items() if key not in ("suits", "species", "plants", "season")}


@pytest.mark.parametrize("name", OTHERS)
def test_every_biome_has_its_own_trees_and_ground(name, near_settings, run, stage):
    shot = of(near_settings, run, name)
    grown = stand.grow(shot)
    assert len(grown.model) > 50
    assert set(grown.model.tolist()) <= {k for sort in biomes.choose(shot).biome.species for k in sort.models}
    assert grown.height.mean() < stand.grow(of(near_settings, run, "sierra_conifer")).height.mean()
    made = fields.create_images(shot, grown)
    assert "Firetwin Ground Cover" in made
    alike = next(each for each in OTHERS if branches(each) == branches(name))
    if name == alike:
        assert material.build(shot, stage, made).name == "Firetwin Ground"
    else:  # the same nodes with other values
        assert form(colours(name)) == form(colours(alike))


def test_trees_of_a_biome_are_drawn(near_settings, run, stage, plain_looks):
    shot = of(near_settings, run, "boreal")
    trees = forest.build(shot, stage, stand.grow(shot))[0]
    kinds = (*models.SPRUCES, *models.PINES, *models.BIRCHES, *models.LARCHES)
    drawn = np.empty(len(trees.data.vertices), np.int32)
    trees.data.attributes["model"].data.foreach_get("value", drawn)
    assert set((drawn // levels.LEVELS).tolist()) <= {*kinds}


def test_roofs_stand_on_their_outlines_as_high_as_they_say(near_settings, run, stage, tmp_path, plain_ground):
    west, south, east, north = -120.556, 38.8395, -120.555, 38.840
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    house = {
        "type": "Feature",
        "properties": {"building": "barn", "height": "9 m"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    path = tmp_path / "land.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [house]}))
    shot = Shot(replace(near_settings, terrain=replace(near_settings.terrain, land_use=path)), run)
    ground.build(shot, stage, None)
    roofs = bpy.data.objects["Firetwin Roofs"]
    points = np.array([vertex.co for vertex in roofs.data.vertices])
    roof = points[:, 2] > points[:, 2].max() - 0.01
    corners = shot.ground.point(np.array([south, north]), np.array([west, east]))
    assert np.ptp(points[:, :2], axis=0) == pytest.approx(np.ptp(corners[:, :2], axis=0), abs=0.5)
    under = shot.ground.up(*points[roof, :2].T.astype(float))
    middle = shot.ground.up(*points[roof, :2].mean(axis=0, keepdims=True).T.astype(float))[0]
    assert points[:, 2].max() == pytest.approx(max(middle + 9.0, under.max() + 1.0), abs=0.1)
    assert points[~roof, 2].max() < under.min()


def test_mapped_lakes_share_the_shader_of_water(near_settings, run, stage, tmp_path):
    """A second one fills the stack of Cycles' shaders, and the ground is black."""
    ring = [[-120.556, 38.8395], [-120.555, 38.8395], [-120.555, 38.840], [-120.556, 38.8395]]
    features = [
        {
            "type": "Feature",
            "properties": {"kind": kind},
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        }
        for kind in ("field", "bare", "water")
    ]
    path = tmp_path / "land.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    terrain = replace(near_settings.terrain, land_use=path)
    shot = Shot(replace(near_settings, terrain=terrain), run)
    maps = fields.land_use_images(shot)
    assert list(maps) == ["soft", "hard", "water"]
    built = material.build(shot, stage, fields.create_images(shot, None), maps=maps)
    trees = [
        built.node_tree,
        *(node.node_tree for node in built.node_tree.nodes if hasattr(node, "node_tree")),
    ]
    kinds = [node.bl_idname for tree in trees for node in tree.nodes]
    assert kinds.count("ShaderNodeFresnel") == 1
    assert sum("Land Use" in node.image.name for tree in trees for node in tree.nodes if images(node)) == 5


def images(node):
    return node.bl_idname == "ShaderNodeTexImage" and node.image is not None
