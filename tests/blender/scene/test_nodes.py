import pytest
from firetwin.blender import compat, nodes, owned


def test_sockets_are_found_by_name_and_missing_ones_named():
    tree = nodes.material("test")[1]
    mix = tree.node("ShaderNodeMix", {"Factor": 0.25}, data_type="RGBA")
    assert compat.find_socket(mix.inputs, 0).default_value == 0.25
    with pytest.raises(KeyError, match="no socket 'Nonsense'; there are: Color, Strength"):
        tree.node("ShaderNodeEmission", {"Nonsense": 1.0})


def test_a_material_is_ours_and_has_a_colour_in_the_solid_view():
    material, _tree = nodes.material("test", (0.1, 0.2, 0.3))
    assert owned.is_ours(material)
    assert material.diffuse_color[:] == pytest.approx((0.1, 0.2, 0.3, 1.0))
