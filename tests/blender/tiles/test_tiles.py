"""Decoded content against Blender's own importer of glTF."""

from pathlib import Path

import bpy
import numpy as np
import pytest
import tile_files as made
from firetwin_core import tiles


@pytest.fixture
def imported(tmp_path):
    """Import a glb with Blender: corners of triangles (m, 3, 3), by the middle's x, with uv (m, 3, 2)."""
    import addon_utils  # which bpy brings along

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("io_scene_gltf2")

    def read(content):
        path = tmp_path / "tile.glb"
        path.write_bytes(content)
        bpy.ops.import_scene.gltf(filepath=str(path))
        corners, uv = [], []
        for each in bpy.context.scene.objects:
            if each.type != "MESH":
                continue
            mesh = each.data
            mesh.calc_loop_triangles()
            for triangle in mesh.loop_triangles:
                corners.append([each.matrix_world @ mesh.vertices[v].co for v in triangle.vertices])
                uv.append([mesh.uv_layers[0].data[loop].uv[:] for loop in triangle.loops])
        return by_middle(np.array(corners, float), np.array(uv, float))

    return read


def by_middle(corners, uv):
    """In an order that hangs on places alone: triangles by their middle's x, corners by their own."""
    triangle = np.argsort(corners[..., 0].mean(axis=1))
    corner = np.argsort(corners[triangle][..., 0], axis=1)
    return tuple(np.take_along_axis(a[triangle], corner[..., None], axis=1) for a in (corners, uv))


def decoded(content):
    tile = tiles.decode(content, np.eye(4), "tile")
    places = tile.origin + tile.position.astype(float)
    return by_middle(places[tile.triangle], tile.uv[tile.triangle].astype(float))


def same(content, imported):
    (ours, our_uv), (theirs, their_uv) = decoded(content), imported(content)
    assert ours.shape == theirs.shape
    np.testing.assert_allclose(ours, theirs, rtol=1e-6, atol=2e-5)  # m; Blender's matrices are float32
    np.testing.assert_allclose(our_uv, their_uv, atol=1e-6)


def patch(content, seed=3, **more):
    """A primitive of random triangles, interleaved or quantised as `more` has it."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(-20, 20, (60, 3)).astype(np.float32)
    uv = rng.uniform(0, 1, (60, 2)).astype(np.float32)
    triangles = np.arange(60, dtype=np.uint16).reshape(20, 3)
    return content.primitive(position, triangles, {"TEXCOORD_0": uv, **more})


def test_nodes_within_nodes(imported):
    content = made.Gltf()
    mesh, other = content.mesh(patch(content)), content.mesh(patch(content, 4))
    turn = np.array([0.1, -0.5, 0.3, 0.8])
    turn = (turn / np.linalg.norm(turn)).tolist()
    content.node(children=[1, 2], translation=[10, 20, -30], rotation=turn)
    content.node(mesh, scale=[1, 2, 0.5])
    content.node(other, matrix=[0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1])
    same(content.scene().glb(), imported)


def test_quantised_attributes(imported):
    content = made.Gltf(
        extensionsRequired=["KHR_mesh_quantization"], extensionsUsed=["KHR_mesh_quantization"]
    )
    rng = np.random.default_rng(5)
    rows = np.zeros(60, [("p", "<i2", 3), ("-", "<i2"), ("t", "<u2", 2)])
    rows["p"], rows["t"] = rng.integers(-32768, 32767, (60, 3)), rng.integers(0, 65535, (60, 2))
    view = content.view(rows.tobytes(), byteStride=rows.itemsize, target=34962)
    said = {"bufferView": view, "count": 60}
    position = content.add("accessors", {**said, "componentType": 5122, "type": "VEC3"})
    uv = content.add(
        "accessors", {**said, "componentType": 5123, "type": "VEC2", "byteOffset": 8, "normalized": True}
    )
    primitive = content.primitive(position, np.arange(60, dtype=np.uint16), {"TEXCOORD_0": uv})
    content.node(content.mesh(primitive), scale=[1e-3] * 3, translation=[1, 2, 3])
    same(content.scene().glb(), imported)


def test_instances(imported):
    extension = "EXT_mesh_gpu_instancing"
    content = made.Gltf(extensionsUsed=[extension])
    by = np.array([[0, 0, 0], [100, 0, 10], [-200, 5, 0]], np.float32)
    size = np.array([[1, 1, 1], [2, 1, 1], [1, 3, 2]], np.float32)
    attributes = {"TRANSLATION": content.accessor(by), "SCALE": content.accessor(size)}
    content.node(content.mesh(patch(content)), extensions={extension: {"attributes": attributes}})
    same(content.scene().glb(), imported)


# Blender 5.2 as a Python module comes without this library; its program has it in `lib`.
@pytest.mark.skipif(
    not any(Path(bpy.utils.resource_path("LOCAL")).parent.rglob("lib*_draco*")),
    reason="this Blender has no Draco library",
)
def test_draco(imported):
    draco = pytest.importorskip("DracoPy")
    rng = np.random.default_rng(6)
    position, uv = rng.uniform(-20, 20, (60, 3)).astype(np.float32), rng.uniform(0, 1, (60, 2))
    triangles = np.arange(60, dtype=np.uint32).reshape(20, 3)
    data = draco.encode(position, triangles, quantization_bits=18, tex_coord=uv)
    mesh = draco.decode(data)
    ids = {a["attribute_type"]: a["unique_id"] for a in mesh.attributes}
    extension = "KHR_draco_mesh_compression"
    content = made.Gltf(extensionsRequired=[extension], extensionsUsed=[extension])
    said = {"componentType": 5126, "count": len(mesh.points)}
    box = {"min": position.min(0).tolist(), "max": position.max(0).tolist()}
    attributes = {
        "POSITION": content.add("accessors", {**said, "type": "VEC3", **box}),
        "TEXCOORD_0": content.add("accessors", {**said, "type": "VEC2"}),
    }
    index = content.add("accessors", {"componentType": 5125, "count": 60, "type": "SCALAR"})
    compressed = {"bufferView": content.view(data), "attributes": {"POSITION": ids[0], "TEXCOORD_0": ids[3]}}
    content.node(
        content.mesh({"attributes": attributes, "indices": index, "extensions": {extension: compressed}})
    )
    same(content.scene().glb(), imported)
