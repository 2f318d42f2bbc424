"""The scar's colours by intensity, fuel and age."""

from types import SimpleNamespace

import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene.band_limited_noise import Grain
from firetwin.scene.terrain import burn_scar, burning_wood

FRESH, OLD = 120.0, 20_000.0  # s


@pytest.fixture
def colour(scene, plate, shoot):
    """colour(intensity, age, ...): mean of the scar over 90 km2, as emission, or its surviving crowns."""

    def make(intensity, age, load=2.0, woody=1.0, canopy=1.0, crowns=False):
        material, tree = nodes.material("scar")
        position = tree.vector(
            "SCALE", tree.output("ShaderNodeNewGeometry", name="Position"), tree.math("ADD", 1000.0, 0.0)
        )
        constants = {
            "heat": np.log(intensity), "age": age, "load": load, "woody": woody, "canopy": canopy, "ash": 0.6,
            "residence": 120.0 if woody else 15.0, "duff": 0.0, "pixel": 0.1,
        }  # fmt: skip
        inputs = {name: tree.math("ADD", float(value), 0.0) for name, value in constants.items()}
        grain = Grain(tree, position, None)
        place = SimpleNamespace(grain=grain, position=position, scale=1.0, mixed=not woody, **inputs)
        crown = burn_scar.surviving_crowns(place)
        tree.surface(tree.emission(crown if crowns else burn_scar.scar_colour(tree, place, logs=True)))
        plate.materials.clear()
        plate.materials.append(material)
        scene.render.resolution_x = scene.render.resolution_y = 48
        return shoot(scene).mean(axis=(0, 1))

    return make


def test_char_is_black_and_neutral_and_its_ash_lightens(colour):
    fresh, old = colour(8000.0, FRESH), colour(8000.0, OLD)
    assert 0.02 < fresh.mean() < 0.06
    assert fresh[0] / fresh[2] < 1.1
    assert 1.15 * fresh.mean() < old.mean() < 0.14


def test_more_fuel_leaves_more_ash(colour):
    assert (
        colour(2000.0, OLD, load=4.0, canopy=0.0).mean()
        > 1.1 * colour(2000.0, OLD, load=0.3, canopy=0.0).mean()
    )


def test_crowns_over_a_surface_fire_are_brown_and_over_a_weak_one_green(colour):
    brown = colour(350.0, FRESH)
    assert brown[0] / brown[2] > 1.3
    assert colour(60.0, FRESH, crowns=True).mean() > 0.6
    assert colour(5000.0, FRESH, crowns=True).mean() < 0.02


def test_burned_grass_is_thin_char(colour):
    grass = colour(500.0, FRESH, load=0.3, woody=0.0, canopy=0.0)
    assert 0.02 < grass.mean() < 0.06
    assert grass[0] / grass[2] < 1.4


@pytest.fixture
def wood(scene, plate, shoot):
    """wood(age, pixel, canopy): mean glow of burning wood on a square of 100 m."""

    def make(age, pixel=0.02, canopy=1.5):
        material, tree = nodes.material("wood")
        position = tree.output("ShaderNodeTexCoord", name="Generated")
        position = tree.vector("SCALE", position, tree.math("ADD", 100.0, 0.0))
        constants = {"age": age, "pixel": pixel, "canopy": canopy, "woody": 1.0, "duff": 1.0}
        inputs = {name: tree.math("ADD", float(value), 0.0) for name, value in constants.items()}
        tree.surface(tree.emission(burning_wood.glow(tree, SimpleNamespace(position=position, **inputs))))
        plate.materials.clear()
        plate.materials.append(material)
        scene.render.resolution_x = scene.render.resolution_y = 64
        return float(shoot(scene).mean())

    return make


def test_wood_burns_on_in_forest_alone_and_fades(wood):
    fresh = wood(FRESH)
    assert 0.05 * fresh < wood(3600.0) < 0.7 * fresh
    assert wood(FRESH, canopy=0.0) == 0.0


def test_pieces_smaller_than_pixels_are_as_bright_together(wood):
    assert wood(FRESH, pixel=1.0) == pytest.approx(wood(FRESH, pixel=0.15), rel=0.5)
