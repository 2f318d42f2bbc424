"""Compositor group Regrade against its closed form, on layers of a file as `comp` writes it."""

import bpy
import comp_film
import numpy as np
import pytest
from firetwin.blender import compat
from firetwin.render import regrade, regrade_nodes
from firetwin_core import sensor


@pytest.fixture
def film(tmp_path):
    return comp_film.write(tmp_path)


@pytest.fixture
def graded(scene, film, tmp_path):
    """Render a film through the nodes, with inputs by name."""

    def run(**inputs):
        node = regrade_nodes.add(scene, film[0])
        for name, value in inputs.items():
            compat.find_socket(node.inputs, name.replace("_", " ")).default_value = value
        tree = compat.compositor(scene)
        output = compat.exr_output(tree, "EXR", compat.find_socket(node.outputs, "Image"), False, 32)
        compat.exr_output_path(output, str(tmp_path), "made")
        compat.still_settings(scene.render)
        scene.render.filepath = str(tmp_path / "made.png")
        bpy.ops.render.render(write_still=True)
        return sensor.read_image(tmp_path / "made000001.exr")[..., :3]

    return run


def test_without_changes_the_layers_add_up_to_the_picture(graded, film):
    assert np.abs(graded() - film[1][""]).max() < 1.0e-3 * film[1][""].max()


@pytest.mark.parametrize("density", [0.0, 0.5, 2.0])
def test_grades_match_the_closed_form(graded, film, density):
    grades = {"Fire Exposure": -2.0, "Sun Exposure": 1.0, "Sky Exposure": -1.0, "Firelight Exposure": -2.0}
    tint, before, haze, air, depth = (0.9, 0.7, 0.5), 0.6, 0.3, (0.2, 0.3, 0.4), 2500.0
    more = {"Smoke Tint": (*tint, 1.0), "Smoke before Fire": before, "Smoke Density": density}
    more |= {"Smoke Exposure": 0.5}
    more |= {"Haze": haze, "Haze Colour": (*air, 1.0), "Depth": depth}
    picture = graded(**grades, **more)
    layers = film[1]
    opacity = layers["smoke.A"]
    clear = np.maximum(1.0 - opacity, regrade.LEAST)
    thinner = (1.0 - opacity) ** density
    lit = 2.0 * layers["light_sun."] + 0.5 * layers["light_sky."] + 0.25 * layers["light_fire."]
    veil = layers["A"] * (1.0 - np.exp(-haze * depth / 1000.0))
    expected = lit * clear ** (density - 1.0) * (1.0 - veil) + np.array(air) * veil * thinner
    expected += 0.25 * layers["fire."] * clear ** (before * (density - 1.0))
    limit = np.full_like(opacity, density)
    light = np.divide(1.0 - thinner, opacity, out=limit, where=opacity > regrade.THIN)
    expected += layers["smoke."] * light * np.array(tint) * 2.0**0.5
    assert np.abs(picture - expected).max() < 1.0e-4 * expected.max()
    assert np.isfinite(picture).all()
