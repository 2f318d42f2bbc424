import bpy
from firetwin.blender import compat


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
