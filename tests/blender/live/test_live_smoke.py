"""Live smoke: the optical depth of the smoke from each direction, in pictures that depend on time alone."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.blender import owned
from firetwin.scene.live import smoke, smoke_grid

EDGES = np.linspace(-400.0, 400.0, 17)


@pytest.fixture
def grid():
    """Even slabs and cells of 50 m about the origin."""
    return smoke_grid.SmokeGrid((EDGES,) * 3, (EDGES,) * 3)


def slabs(opacity, light=0.5):
    return smoke_grid.Slabs(np.full((*opacity.shape, 3), light, np.float32), opacity.astype(np.float32))


@pytest.fixture
def baked(grid):
    """Smoke at two moments: four cells of one slab of each axis, thicker at the second moment."""
    opacity = np.zeros((16, 16, 16))
    opacity[8, 5:7, 5:7] = 0.5
    pair = [slabs(opacity), slabs(opacity * 1.5)]
    shadow = np.stack([np.ones((4, 4)), np.full((4, 4), 0.2)]).astype(np.float32)
    low = np.array([-400.0, -400.0])
    return smoke.Smoke(grid, np.array([100.0, 200.0]), [pair] * 3, shadow, low, -low)


@pytest.mark.parametrize("direction", [(0, 0, 1), (1, 0, 0), (1, 1, 0), (1, 2, 3), (3, 1, -1)])
def test_sheets_of_all_axes_have_the_depth_of_the_ray(stage, baked, direction):
    """A ray of length s meets s |cos t| / d sheets of an axis; the shader raises their clearness."""
    smoke.build(stage, stage.part("Live"), baked)
    way = np.array(direction) / np.linalg.norm(direction)
    k, s, d = 0.01, 300.0, 25.0
    depths = [
        s
        * abs(way[axis])
        / d
        * k
        * d
        * exponent(bpy.data.node_groups[f"Firetwin Live Smoke {name} Shader"], way)
        for axis, name in enumerate("XYZ")
    ]
    assert sum(depths) == pytest.approx(k * s, rel=1e-4)


def exponent(group, incoming):
    """Value of the power to which the material raises the clearness of a slab, for a direction of view."""
    power = next(node for node in group.nodes if node.type == "MATH" and node.operation == "POWER")
    return value(power.inputs[1], incoming)


def value(socket, incoming):
    """Value of a socket of Math nodes."""
    if not socket.is_linked:
        return socket.default_value
    link = socket.links[0]
    node = link.from_node
    if node.type == "SEPXYZ":
        return incoming["XYZ".index(link.from_socket.name)]
    if node.type == "GROUP_INPUT":
        return 1.0
    first, second = (value(each, incoming) for each in node.inputs[:2])
    return {
        "ABSOLUTE": lambda: abs(first),
        "ADD": lambda: first + second,
        "MULTIPLY": lambda: first * second,
        "DIVIDE": lambda: first / second,
        "MAXIMUM": lambda: max(first, second),
    }[node.operation]()


def test_sheets_exist_only_where_smoke_ever_is(stage, baked):
    made = smoke.build(stage, stage.part("Live"), baked)
    assert [obj.name for obj in made] == [f"Firetwin Live Smoke {axis} 08" for axis in "XYZ"]
    for obj in made:
        assert len(obj.data.polygons) == 1
        bounds = np.array([obj.matrix_basis @ v.co for v in obj.data.vertices])
        axis = "XYZ".index(obj.name[-4])
        np.testing.assert_allclose(np.sort(np.ptp(bounds, axis=0)), [0.0, 200.0, 200.0], atol=1e-3)
        assert np.ptp(bounds[:, axis]) == pytest.approx(0.0, abs=1e-3)
        assert bounds[0, axis] == pytest.approx(25.0)


@pytest.mark.parametrize(("row", "column", "quads"), [(5, 5, 1), (4, 5, 2), (5, 7, 2), (7, 4, 4)])
def test_sheets_end_where_the_picture_has_faded(stage, baked, row, column, quads):
    """A cell at the side of a quad of 4 x 4 cells fades into its neighbour, so that has a quad too."""
    opacity = np.zeros((16, 16, 16))
    opacity[8, row, column] = 0.5
    made = smoke.build(stage, stage.part("Live"), replace(baked, slabs=[[slabs(opacity)] * 2] * 3))
    assert [len(obj.data.polygons) for obj in made] == [quads] * 3


def test_sheets_that_cross_have_the_same_light():
    """Light that is linear along each axis has its value at each place of a sheet."""
    cells = (np.linspace(0.0, 80.0, 9), np.linspace(-60.0, 0.0, 7), np.linspace(10.0, 50.0, 5))
    edges = ([10.0, 25.0, 70.0], [-50.0, -30.0, -5.0], [16.0, 20.0, 42.0])
    uneven = smoke_grid.SmokeGrid(tuple(np.array(each) for each in edges), cells)
    x, y, z = np.meshgrid(*(0.5 * (each[1:] + each[:-1]) for each in cells), indexing="ij")
    field = np.repeat((x + 2.0 * y + 3.0 * z)[..., None], 3, axis=-1)
    for axis in range(3):
        places = [0.5 * (each[1:] + each[:-1]) for each in cells]
        places[axis] = 0.5 * (uneven.slabs[axis][1:] + uneven.slabs[axis][:-1])
        x, y, z = np.meshgrid(*places, indexing="ij")
        expected = (x + 2.0 * y + 3.0 * z).transpose(axis, *smoke_grid.plane(axis))
        np.testing.assert_allclose(smoke_grid.on_sheets(uneven, axis, field)[..., 1], expected, rtol=1e-5)


def test_clear_cells_have_the_light_of_smoke_nearby():
    """Two cells of smoke: light is their own there, theirs nearby, and their mean far away."""
    seen = np.zeros((30, 9, 9, 4), np.float32)
    seen[4, 4, 4] = [0.2, 0.2, 0.2, 0.5]
    seen[25, 4, 4] = [0.4, 0.4, 0.4, 0.5]
    light = smoke_grid._filled(seen)[:, 4, 4, 0]
    np.testing.assert_allclose(light[[4, 6, 15, 23, 25]], [0.4, 0.4, 0.6, 0.8, 0.8], rtol=0.02)


def test_a_sheet_reads_its_own_row_of_the_picture(stage, baked):
    """Rows of a picture are sheets, columns are moments; opacity is in its alpha."""
    (obj, *_) = smoke.build(stage, stage.part("Live"), baked)
    sheet = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.attributes["sheet"].data.foreach_get("vector", sheet)
    u, v = sheet.reshape(-1, 3)[:, :2].T
    image = bpy.data.images["Firetwin Live Smoke X"]
    assert tuple(image.size) == (2 * 16, 16 * 16)
    alpha = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(alpha)
    alpha = alpha.reshape(16 * 16, 2 * 16, 4)[..., 3]
    rows = slice(round(v.min() * 256) + 1, round(v.max() * 256) - 1)
    for moment, expected in ((0, 0.5), (1, 0.75)):
        columns = slice(round((u.min() + moment) * 16) + 1, round((u.max() + moment) * 16) - 1)
        np.testing.assert_allclose(alpha[rows, columns], expected, atol=0.003)
        alpha[rows, columns] = 0.0
    assert alpha.max() == 0.0


def test_the_shadow_has_a_column_for_each_moment(stage, baked):
    shade = smoke.shade(baked)
    image = next(node.image for node in shade.group.nodes if node.type == "TEX_IMAGE")
    pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(pixels)
    red = pixels.reshape(4, 8, 4)[..., 0]
    np.testing.assert_allclose(red[:, :4], 1.0)
    np.testing.assert_allclose(red[:, 4:], 0.2, atol=0.003)
    assert owned.is_ours(shade.group)


def test_smoke_that_is_not_solved_is_told(shot, stage):
    """The small shot has no smoke at all."""
    assert smoke.bake(shot, stage, lambda *_: None, pytest.fail) is None
