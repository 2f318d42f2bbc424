"""Flames within the field of flames: a share by distance that crowns, ground and billboards emit."""

import bpy
import numpy as np
import pytest
from firetwin.blender import nodes
from firetwin.scene import build, flame_field
from firetwin.scene.fire import build as fire
from firetwin.shot.fire import flame_map
from firetwin.shot.shot import Shot


def shares(stage, distances, reach):
    """Evaluate the shader group's arithmetic at these distances (m)."""
    tree = nodes.Tree(bpy.data.node_groups.new("probe", "ShaderNodeTree"))
    flame_field.share(tree, stage)
    flame_field.set_reach(stage, reach)
    group = bpy.data.node_groups["Firetwin Flame Field"]
    assert group.nodes["Reach"].outputs[0].default_value == reach
    (step,) = (node for node in group.nodes if node.bl_idname == "ShaderNodeMapRange")
    low, high = (step.inputs[k].links[0].from_node for k in ("From Min", "From Max"))
    low, high = (float(node.inputs[1].default_value) * reach for node in (low, high))
    if high <= low:
        return np.ones(len(distances))
    part = np.clip((distances - low) / (high - low), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)


def drawn(scene):
    """Billboards that are instanced: their places (n, 3)."""
    graph = bpy.context.evaluated_depsgraph_get()
    thing = bpy.data.objects["Firetwin Flames"].evaluated_get(graph)
    found = [i.matrix_world.translation[:] for i in graph.object_instances if i.parent == thing]
    return np.array(found).reshape(-1, 3)


@pytest.mark.parametrize("reach", [0.0, 150.0, 2000.0])
def test_surfaces_emit_what_the_field_leaves(stage, reach):
    distances = np.linspace(1.0, 4000.0, 60)
    assert shares(stage, distances, reach) == pytest.approx(
        1.0 - flame_map.weight(distances, reach), abs=1e-6
    )


def test_a_scene_without_a_field_shows_all_its_flames(close, run, stage):
    fire.build(Shot(close, run), stage)
    for name in ("Firetwin Flame Field", "Firetwin Flame Field Distance"):
        assert bpy.data.node_groups[name].nodes["Reach"].outputs[0].default_value == 0.0


def test_billboards_within_the_field_are_left_out_and_others_stay(close, run, stage, scene):
    shot = Shot(close, run)
    fire.build(shot, stage)
    camera = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location = shot.paths[0].position[0]
    scene.frame_set(1)
    before = drawn(scene)
    reach = 1.25 * float(np.median(np.linalg.norm(before - camera.location, axis=1)))
    flame_field.set_reach(stage, reach)
    after = drawn(scene)
    away = np.linalg.norm(after - camera.location, axis=1)
    assert 0 < len(after) < len(before)
    assert away.min() > 0.8 * reach - 150.0
    outside = before[np.linalg.norm(before - camera.location, axis=1) > 0.8 * reach]
    assert {tuple(place) for place in outside} <= {tuple(place) for place in after}


def test_crowns_grass_ground_and_billboards_leave_out_the_same_share(close, run, stage, scene):
    """One group serves all, and its share reaches their emission."""
    build.build(Shot(close, run), scene, ("terrain", "forest", "fire"))
    for name in ("Foliage", "Ground", "Flame"):
        tree = bpy.data.node_groups[f"Firetwin {name} Shader"]
        field = [node for node in tree.nodes if node.bl_idname == "ShaderNodeGroup"]
        field = [node for node in field if node.node_tree.name == "Firetwin Flame Field"]
        assert field, name
        reached, pending = set(), [link.to_node for node in field for link in node.outputs["Share"].links]
        while pending:
            node = pending.pop()
            if node.name not in reached:
                reached.add(node.name)
                pending += [link.to_node for socket in node.outputs for link in socket.links]
        kinds = {tree.nodes[name].bl_idname for name in reached}
        assert {"ShaderNodeEmission", "NodeGroupOutput"} <= kinds
        assert "ShaderNodeOutputAOV" in kinds, "the infrared has it too"
