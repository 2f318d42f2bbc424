import bpy
import pytest
from firetwin.blender import nodes
from firetwin.render.light_only import light_only


@pytest.fixture
def switches(scene):
    """Data shaders' sockets of a material that all three kinds of view layers render."""
    _, tree = nodes.material("Rock")
    shader = nodes.thermal_switch(tree, tree.emission((1.0, 0.5, 0.0)), tree.attribute("kelvin"))
    tree.surface(tree.mix_shader(0.5, nodes.mask_switch(tree, shader, 1.0), tree.emission((1.0, 1.0, 1.0))))
    mixed = [node for node in tree.node_tree.nodes if node.bl_idname == "ShaderNodeMixShader"]
    assert len(mixed) == 3
    return [node.inputs[2] for node in mixed]


def _linked(sockets):
    return [socket.links[0].from_node.bl_idname if socket.is_linked else "" for socket in sockets]


def test_a_picture_of_light_has_no_data_shaders(switches):
    before = _linked(switches)
    with light_only(["rgb"]):
        assert sorted(_linked(switches)) == ["", "", "ShaderNodeEmission"]
    assert _linked(switches) == before


@pytest.mark.parametrize("names", [["thermal"], ["masks"], ["rgb", "thermal"]])
def test_data_layers_keep_their_shaders(switches, names):
    with light_only(names):
        assert "" not in _linked(switches)


def test_an_error_restores_the_shaders(switches):
    before = _linked(switches)
    with pytest.raises(ZeroDivisionError), light_only(["rgb"]):
        raise ZeroDivisionError
    assert _linked(switches) == before


def _infrared_inputs():
    """Third channels of the AOV of surfaces, which record infrared radiance."""
    outputs = [
        node
        for tree in bpy.data.node_groups
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeOutputAOV" and node.aov_name == nodes.SURFACE
    ]
    return [node.inputs["Color"].links[0].from_node.inputs["Z"] for node in outputs]


def test_infrared_radiance_is_cut_from_a_picture_that_no_pass_needs_it_in(switches):
    (channel,) = _infrared_inputs()
    with light_only(["rgb"], infrared=False):
        assert not channel.is_linked
        assert channel.default_value == 0.0
    assert _linked([channel]) == ["ShaderNodeAttribute"]
    with light_only(["rgb"]):
        assert channel.is_linked
