"""Meshes from arrays have the data that Blender's own functions write."""

import bpy
import numpy as np
import pytest
from firetwin.blender import state
from firetwin.blender.mesh import add_attribute, create_mesh, fill_mesh

CORNERS = np.random.default_rng(1).normal(size=(3, 4, 3)).reshape(-1, 3)


@pytest.mark.parametrize("sides", [3, 4])
@pytest.mark.parametrize("flat", [True, False])
def test_faces_are_those_of_from_pydata(sides, flat):
    faces = np.arange(12).reshape(-1, sides)
    expected = bpy.data.meshes.new("expected")
    expected.from_pydata(CORNERS.tolist(), [], faces.tolist(), shade_flat=flat)
    assert state.digest_mesh(create_mesh("made", CORNERS, faces, flat=flat)) == state.digest_mesh(expected)


def test_points_and_edges_are_those_of_from_pydata():
    for edges in ([], [(0, 1), (1, 2)]):
        expected = bpy.data.meshes.new("expected")
        expected.from_pydata(CORNERS.tolist(), edges, [], shade_flat=False)
        assert state.digest_mesh(create_mesh("made", CORNERS, edges=edges)) == state.digest_mesh(expected)


def test_nothing_is_an_empty_mesh():
    data = create_mesh("nothing", np.empty((0, 3)), np.empty((0, 3), int), material_index=[])
    assert not len(data.vertices)
    assert not len(data.polygons)


def test_attributes_and_materials_belong_to_their_elements():
    data = bpy.data.meshes.new("filled")
    fill_mesh(data, CORNERS, np.arange(12).reshape(-1, 3), material_index=[1, 0, 2, 0])
    assert [face.material_index for face in data.polygons] == [1, 0, 2, 0]
    for kind, width, domain, count in (
        ("INT", 1, "POINT", 12),
        ("FLOAT", 1, "FACE", 4),
        ("FLOAT_VECTOR", 3, "POINT", 12),
        ("FLOAT_COLOR", 4, "CORNER", 12),
    ):
        values = np.arange(count * width).reshape(count, width)
        add_attribute(data, kind, kind, values, domain)
        written = data.attributes[kind]
        assert (written.data_type, written.domain, len(written.data)) == (kind, domain, count)
        key = {1: "value", 3: "vector", 4: "color"}[width]
        found = [getattr(each, key) for each in written.data]
        assert np.array_equal(np.reshape(found, (count, width)), values)
