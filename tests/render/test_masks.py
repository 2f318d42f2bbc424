"""Classes and instances of pixels: integers that agree with the built scene, at no cost to other passes."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes, owned
from firetwin.passes import masks
from firetwin.render import engine, layers, pictures
from firetwin.render.picture import Picture
from firetwin.render.sharing import open_session
from firetwin.scene import build, infrared
from firetwin.shot import passes
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.cameras.rigs.mounted import Mounted
from firetwin.shot.settings import Camera
from firetwin.shot.shot import Shot
from firetwin_core import sensor

KEY = CameraKey(0.0, 38.825, -120.56, 250.0, "point", 38.842, -120.552, 0.0)


@pytest.fixture
def shoot(near_settings, run, tmp_path):
    """Build what one of two cameras of a mount sees, with smoke before its left half, and render passes.

    Returns the scene and the EXR of each pass.
    """

    def make(*names, camera="drone"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        stage = owned.adopt(bpy.context.scene)
        settings = replace(
            near_settings,
            cameras=(Camera("drone", Drone(keys=(KEY,), vibration=0.3)), Camera("two", Mounted("drone"))),
            render=replace(near_settings.render, resolution=(96, 54), samples=1),
            smoke=replace(near_settings.smoke, draw="volume"),
        )
        shot = Shot(settings, run).for_camera(camera)
        build.build(shot, stage.scene)
        layers.build(shot.settings, stage)
        engine.apply(shot.settings, stage.scene)
        _smoke(shot, stage)
        wanted = [Picture(camera, 2, name) for name in names]
        with open_session(tmp_path, {(camera, name): {"pass": name} for name in passes.known()}) as here:
            pictures.render(shot, stage, here, wanted)
        return stage.scene, {each.name: sensor.read_image(tmp_path / each.file("exr")) for each in wanted}

    return make


def _smoke(shot, stage):
    """A box of smoke 30 m before the left half of the camera, with an optical depth of 1."""
    view = shot.paths[0]
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    box = bpy.context.object
    box.users_collection[0].objects.unlink(box)
    stage.part("Smoke").objects.link(box)
    turn = np.eye(4)
    turn[:3, :3] = view.rotation[1]
    turn[:3, 3] = view.position[1] + view.rotation[1] @ [-50.0, 0.0, -30.0]
    box.matrix_world = [list(column) for column in turn.T]
    box.scale = (100.0, 200.0, 10.0)
    material, tree = nodes.material("Firetwin Smoke")
    dark = tree.output("ShaderNodeVolumeAbsorption", {"Color": (0.0, 0.0, 0.0), "Density": 0.1})
    tree.volume(infrared.select_smoke_shader(tree, shot, stage, dark, tree.math("ADD", 0.1, 0.0)))
    box.data.materials.append(material)
    owned.mark(box)


def test_pixels_have_their_class_and_their_tree(shoot):
    scene, pixels = shoot("masks", "depth")
    kind, clear, instance, surface = np.moveaxis(pixels["masks"], -1, 0)
    right = np.s_[:, 56:]
    assert np.array_equal(np.unique(kind[:, :40]), [masks.SMOKE])
    assert masks.SMOKE not in surface  # thin smoke: the class behind it is known
    assert (surface[:, :40] != masks.SKY).any()
    assert np.array_equal(surface[right], kind[right])
    x, y = np.meshgrid((np.arange(40) + 0.5) / 48 - 1.0, (np.arange(54) + 0.5 - 27.0) / 48)
    slant = np.sqrt(1.0 + (18.0 / 28.0) ** 2 * (x**2 + y**2))
    assert clear[:, :40] == pytest.approx(np.exp(-slant), rel=0.01)
    assert np.all(clear[right] == 1.0)
    assert set(np.unique(kind[right])) <= {masks.SKY, masks.GROUND, masks.BURNED, masks.TREE, masks.FIRE}
    assert {masks.GROUND, masks.TREE} <= set(np.unique(kind[right]))
    assert np.array_equal(instance, np.rint(instance))
    sky = pixels["depth"][..., 0] > 1e9
    assert np.array_equal(kind[right] == masks.SKY, sky[right])
    assert np.all(instance[right][kind[right] == masks.TREE] > 0)
    assert np.all(instance[np.isin(kind, (masks.SKY, masks.GROUND, masks.BURNED))] == 0)
    trees = _trees()
    numbers = np.unique(instance[instance > 0]).astype(int)
    assert len(numbers) > 20
    assert set(numbers) <= set(trees)
    assert (instance[:, :40] > 0).any()  # behind the smoke
    _stand_there(scene, trees, instance[right] * (kind[right] == masks.TREE), pixels["depth"][right][..., 0])


def _trees():
    """Places of the trees of the scene by their numbers."""
    data = bpy.data.objects["Firetwin Trees"].data
    numbers = (each.value for each in data.attributes["number"].data)
    return {int(number): tuple(point.co) for number, point in zip(numbers, data.vertices, strict=True)}


def _stand_there(scene, trees, instance, depth):
    """The tree of a pixel's number is as far away as the pixel."""
    view = np.array(scene.camera.matrix_world.inverted())
    picked = instance > 0
    place = np.array([(*trees[int(number)], 1.0) for number in instance[picked]])
    far = -(place @ view.T)[:, 2]
    off = np.abs(far - depth[picked])
    assert np.percentile(off, 95) < 30.0, "m; a tree is as high"


def test_a_pass_that_nobody_asks_for_is_not_rendered_and_changes_nothing(shoot, tmp_path):
    scene, pixels = shoot("rgb")
    assert [each.name for each in scene.view_layers if each.use] == ["rgb"]
    trees = [scene.world.node_tree, *bpy.data.node_groups]
    switches = [
        node
        for tree in trees
        for node in tree.nodes
        if node.bl_idname == "ShaderNodeAttribute" and node.attribute_name == nodes.MASKS
    ]
    assert len(switches) >= 6
    for node in switches:  # as if there were no masks
        mix = node.outputs["Fac"].links[0].to_node
        node.id_data.links.new(mix.inputs[1].links[0].from_socket, mix.outputs[0].links[0].to_socket)
    layers.write_exr(scene, str(tmp_path), [Picture("drone", 2, "rgb")])
    bpy.ops.render.render(scene=scene.name)
    assert np.array_equal(sensor.read_image(tmp_path / "drone_rgb_000002.exr"), pixels["rgb"])


def test_sensors_of_one_mount_agree_to_the_pixel(shoot):
    first, second = (shoot("depth", "masks", camera=name)[1] for name in ("drone", "two"))
    assert np.array_equal(first["depth"], second["depth"])
    assert np.array_equal(first["masks"], second["masks"])


def test_a_tree_has_its_number_in_every_camera_and_part_of_a_film(near_settings, run):
    """A camera elsewhere and another part of the frames see other trees; those that both see agree."""

    def trees(*keys):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        stage = owned.adopt(bpy.context.scene)
        shot = Shot(replace(near_settings, cameras=(Camera("drone", Drone(keys=keys)),)), run)
        build.build(shot, stage.scene)
        return {tuple(np.round(place[:2], 1)): number for number, place in _trees().items()}

    here = trees(KEY)
    moved = trees(replace(KEY, latitude=KEY.latitude + 0.004))
    both = set(here) & set(moved)
    assert len(both) > 100
    assert set(here) != set(moved)
    assert [here[place] for place in both] == [moved[place] for place in both]
