"""Node groups that people can read: inputs that are explained, and nodes that lie in order."""

import pytest
from firetwin.blender import nodes


def test_an_input_is_made_once_and_changes_the_picture(scene, plate, shoot):
    material, tree = nodes.material("test")
    twice = [tree.input("Power", 2.0, "How bright it is", "Light", most=10.0) for _ in range(2)]
    colour = tree.input("Colour", (1.0, 0.5, 0.25), "Of the light", "Light")
    tree.surface(tree.emission(colour, twice[0] * twice[1]))
    plate.materials.append(material)
    assert shoot(scene)[2, 2] == pytest.approx([4.0, 2.0, 1.0], rel=1e-5)
    group = next(node for node in material.node_tree.nodes if node.type == "GROUP")
    assert [socket.name for socket in group.inputs] == ["Power", "Colour"]
    group.inputs["Power"].default_value = 1.0
    assert shoot(scene)[2, 2] == pytest.approx([1.0, 0.5, 0.25], rel=1e-5)
