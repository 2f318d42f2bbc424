"""Volume stack of Cycles: enough entries for many layers of smoke.

Cycles marches between the faces of a hull of boxes, 8 voxels wide, around the grids. Before it traces a
camera ray it traces straight up from the camera and stores 2 (2 + n) of the faces it meets, in no particular
order. The lowest of those decides whether the camera is in the smoke. n is the number of volumes that overlap
another, and at least 1. With more layers, a camera in thin smoke can be taken to be outside. Every ray then
misses its smoke up to the next box: a hole with straight edges. Volumes that overlap each other, underground,
raise n to the maximum: 64 faces.

Source: `integrator_volume_stack_init` and `Scene::get_volume_stack_size` of Cycles 4.5 to 5.2.
"""

from __future__ import annotations

import bpy

from ...blender import nodes, owned
from ...blender.mesh import create_mesh

_COUNT = 29  # plus one volume of smoke, the end marker and the world's volume: Cycles' maximum of 32
_DEPTH = -5000.0  # m


def build(collection: bpy.types.Collection, smokes: int = 1) -> None:
    """Build "Firetwin Smoke Layers": instances of a single empty volume at the same position.

    Together with the smoke volumes they fill Cycles' maximum.
    """
    material, tree = nodes.material("Firetwin Smoke Layers")
    tree.volume(tree.output("ShaderNodeVolumeAbsorption", {"Density": 0.0}))
    corners, faces = (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)],
    )
    data = create_mesh("Firetwin Smoke Layer", corners, faces, flat=True)
    data.materials.append(material)
    points = create_mesh("Firetwin Smoke Layers", [(0.0, 0.0, _DEPTH)] * (_COUNT + 1 - smokes))
    all_of_them = owned.add(collection, "Smoke Layers", points)
    all_of_them.instance_type = "VERTS"
    all_of_them.show_instancer_for_render = all_of_them.show_instancer_for_viewport = False
    owned.add(collection, "Smoke Layer", data).parent = all_of_them
