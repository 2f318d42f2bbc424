"""World-space normals, against planes whose slope is known."""

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes, owned
from firetwin.render import engine, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin_core import sensor


@pytest.fixture
def render(settings, shot, stage, tmp_path):
    """A plane that rises to the north by the given slope, from straight above; smoke and flames before it."""

    def shoot(slope):
        ground = stage.part("Terrain")
        corners = [(-500, -500), (500, -500), (500, 500), (-500, 500)]
        mesh = bpy.data.meshes.new("Plane")
        mesh.from_pydata([(x, y, slope * y) for x, y in corners], [], [(0, 1, 2, 3)])
        material, tree = nodes.material("Plane")
        shader = tree.output("ShaderNodeBsdfDiffuse", {"Color": (0.2, 0.3, 0.1)})
        tree.surface(nodes.thermal_switch(tree, shader, tree.math("ADD", 300.0, 0.0)))
        mesh.materials.append(material)
        owned.add(ground, "Plane", mesh)
        card = bpy.data.meshes.new("Card")
        card.from_pydata([(0, -500, 600), (500, -500, 600), (500, 500, 700)], [], [(0, 1, 2)])
        owned.add(stage.part("Fire"), "Card", card)
        data = bpy.data.cameras.new("Camera")
        data.clip_end, data.lens = 1e5, 28.0
        camera = owned.add(stage.part("Cameras"), "Camera drone", data, "camera drone")
        camera.location = (0.0, 0.0, 1000.0)
        layers.build(settings, stage)
        engine.apply(settings, stage.scene)
        picture = Picture("drone", 1, "normal")
        with open_session(tmp_path, {("drone", "normal"): {}}) as here:
            pictures.render(shot, stage, here, [picture])
        return np.asarray(sensor.read_image(tmp_path / picture.file("exr")))

    return shoot


@pytest.mark.parametrize("slope", [0.0, 0.5, -1.0])
def test_a_plane_faces_the_way_it_must(render, slope):
    normal = render(slope)
    assert normal.shape[2] == 3
    assert normal.dtype == np.float32
    expected = np.array([0.0, -slope, 1.0]) / np.hypot(slope, 1.0)
    middle = normal[12:24, 24:40]  # the card would be in its right half
    np.testing.assert_allclose(middle, np.broadcast_to(expected, middle.shape), atol=1e-6)


def test_the_sky_faces_nowhere(render):
    assert (render(0.0)[0, 0] == 0.0).all()
