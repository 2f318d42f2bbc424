import bpy
from firetwin import compat


def test_eevee_is_an_engine_of_this_blender(scene):
    scene.render.engine = compat.eevee_id()
    assert scene.render.engine == compat.eevee_id()


def test_fcurves_animate_and_are_replaced(scene):
    thing = bpy.data.objects.new("thing", None)
    for value in (1.0, 2.0):
        curve = compat.new_fcurve(thing, "location", 2)
        curve.keyframe_points.insert(1.0, value)
    (found,) = compat.fcurves(thing)
    assert found.array_index == 2
    assert found.evaluate(1.0) == 2.0


def test_the_sky_has_no_sun_disc():
    world = bpy.data.worlds.new("sky")
    node = compat.node_tree(world).nodes.new("ShaderNodeTexSky")
    compat.set_sky(node, 0.5, 1.0, 2.0)
    assert not node.sun_disc
    assert abs(node.sun_elevation - 0.5) < 1e-6


def test_modifier_inputs_can_be_set(scene):
    from firetwin import nodes

    tree, given = nodes.geometry("group", {"Amount": "NodeSocketFloat"})
    offset = tree.combine(0.0, 0.0, tree.pick(given, "Amount"))
    moved = tree.output("GeometryNodeSetPosition", {"Geometry": tree.pick(given), "Offset": offset})
    tree.node("NodeGroupOutput", {"Geometry": moved})
    mesh = bpy.data.meshes.new("point")
    mesh.vertices.add(1)
    thing = bpy.data.objects.new("point", mesh)
    scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("nodes", "NODES")
    modifier.node_group = tree.node_tree
    amount = next(item for item in tree.node_tree.interface.items_tree if item.name == "Amount")
    compat.set_modifier_input(modifier, amount.identifier, 3.0)
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert evaluated.data.vertices[0].co.z == 3.0
