"""Room in Cycles' list of volumes for smoke that lies in many layers.

Cycles marches between the faces of a hull made of boxes, 8 voxels wide, round the grids. Before it follows a
camera's ray it goes straight up from the camera and keeps 2 (2 + n) of the faces it meets, in no order; from
the lowest of those it tells whether the camera is in the smoke. n is the number of volumes that overlap
another, and at least 1. Under more layers than that, a camera in thin smoke can be taken to be outside, and
every ray loses its smoke up to where it next enters a box: a hole with straight edges. Volumes that overlap
each other, underground, bring n to the most there is room for: 64 faces.

Source: `integrator_volume_stack_init` and `Scene::get_volume_stack_size` of Cycles 4.5 to 5.2.
"""

from __future__ import annotations

import bpy

from ...blender import nodes, owned

_COUNT = 29  # with one volume of smoke, the end mark and the world's volume, the 32 that Cycles holds
_DEPTH = -5000.0  # m


def build(collection: bpy.types.Collection, smokes: int = 1) -> None:
    """Build "Firetwin Smoke Layers", instances of one empty volume, all in one place.

    With the volumes of smoke that there are, as many as Cycles holds.
    """
    material, tree = nodes.material("Firetwin Smoke Layers")
    tree.volume(tree.output("ShaderNodeVolumeAbsorption", {"Density": 0.0}))
    mesh = bpy.data.meshes.new("Firetwin Smoke Layer")
    mesh.from_pydata(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    )
    mesh.materials.append(material)
    points = bpy.data.meshes.new("Firetwin Smoke Layers")
    points.from_pydata([(0.0, 0.0, _DEPTH)] * (_COUNT + 1 - smokes), [], [])
    all_of_them = owned.add(collection, "Smoke Layers", points)
    all_of_them.instance_type = "VERTS"
    all_of_them.show_instancer_for_render = all_of_them.show_instancer_for_viewport = False
    owned.add(collection, "Smoke Layer", mesh).parent = all_of_them
