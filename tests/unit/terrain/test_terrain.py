"""The adaptive mesh of the ground, and the surface between the grid's points."""

import numpy as np
import pytest
from firetwin.shot.terrain import noise
from firetwin_core import set_threads, terrain
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

OCTAVES = ((210.0, 1.0), (52.0, 0.3))


def grid(height, step=20.0):
    """Points (ny, nx, 3) of heights on a square grid, rows to the north."""
    rows, columns = height.shape
    x, y = np.meshgrid(np.arange(columns) * step, np.arange(rows) * step)
    return np.stack([x, y, height], axis=-1).astype(np.float32)


def drawn(place, row, column, triangle, at_row, at_column):
    """Heights of a mesh, whose vertices are points of a grid, at many places; each is in some triangle."""
    z = place[row.astype(int), column.astype(int), 2].astype(float)
    a, b, c = (triangle[:, k, None] for k in range(3))
    u, v = ((column[k] - column[a], row[k] - row[a]) for k in (b, c))
    area = u[0] * v[1] - u[1] * v[0]
    points = []
    for y, x in zip(np.array_split(at_row, 32), np.array_split(at_column, 32), strict=True):
        x, y = x - column[a], y - row[a]
        s, t = (x * v[1] - y * v[0]) / area, (u[0] * y - u[1] * x) / area
        inside = np.argmax((s >= -1e-9) & (t >= -1e-9) & (s + t <= 1 + 1e-9), axis=0)
        s, t = (np.take_along_axis(part, inside[None], 0)[0] for part in (s, t))
        assert np.all(np.minimum(np.minimum(s, t), 1 - s - t) > -1e-8)
        i, j, k = triangle[inside].T
        points.append(z[i] + s * (z[j] - z[i]) + t * (z[k] - z[i]))
    return np.concatenate(points)


def rough(rows, columns, seed, roughness):
    """Hills, cliffs and spikes."""
    y, x = np.mgrid[:rows, :columns]
    rng = np.random.default_rng(seed)
    height = 300.0 * noise.fractal(x, y, 40.0, 5, seed, roughness)
    height[:, columns // 2 :] += 80.0
    height[rng.integers(0, rows, 3), rng.integers(0, columns, 3)] += rng.uniform(-90, 90, 3)
    return height


def closed(row, column, triangle, rows, columns):
    """Check that triangles cover a grid once, without cracks and T-junctions, and face up."""
    a, b, c = (np.stack([column[triangle[:, k]], row[triangle[:, k]]]) for k in range(3))
    area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    assert area.min() > 0.0
    assert area.sum() == pytest.approx((rows - 1) * (columns - 1), rel=1e-12)
    edges = [tuple(edge) for t in triangle.tolist() for edge in zip(t, t[1:] + t[:1], strict=True)]
    assert len(set(edges)) == len(edges)
    rim = {edge for edge in edges if edge[::-1] not in set(edges)}
    ends = np.array(sorted(rim))
    sides = [(axis, side) for axis, last in ((row, rows - 1), (column, columns - 1)) for side in (0, last)]
    at = np.any([(axis[ends] == side).all(axis=1) for axis, side in sides], axis=0)
    assert at.all()
    lengths = np.abs(row[ends[:, 0]] - row[ends[:, 1]]) + np.abs(column[ends[:, 0]] - column[ends[:, 1]])
    assert lengths.sum() == pytest.approx(2 * (rows - 1 + columns - 1))
    assert len(set(zip(row, column, strict=True))) == len(row)


@settings(deadline=None, max_examples=examples(15))
@given(st.integers(2, 20), st.integers(2, 20), st.integers(0, 99), st.floats(0.2, 0.8), st.floats(0.0, 60.0))
def test_the_mesh_is_nowhere_farther_off_than_its_tolerance(rows, columns, seed, roughness, most):
    place = grid(rough(rows, columns, seed, roughness))
    tolerance = np.random.default_rng(seed).uniform(0.2 * most, most, (rows, columns)).astype(np.float32)
    row, column, triangle = terrain.mesh(place, tolerance)
    closed(row, column, triangle, rows, columns)
    y, x = (v.ravel() for v in np.mgrid[:rows, :columns])
    off = np.abs(drawn(place, row, column, triangle, y, x) - place[y, x, 2])
    assert np.all(off <= tolerance[y, x] + 1e-3)


def test_the_rim_of_a_grid_whose_rows_are_curved_is_followed_as_well():
    height = 0.0 * np.mgrid[:65, :65][0]
    height[0, 1::2] = height[-1, 1::2] = 9.0
    place = grid(height)
    place[..., 1] += 1e-6 * (place[..., 0] - 640.0) ** 2
    row, _column, _triangle = terrain.mesh(place, np.ones(height.shape))
    assert np.sum(row == 0.0) == np.sum(row == 64.0) == 65


def test_level_ground_takes_few_triangles_and_a_hill_takes_them_where_it_is():
    height = np.zeros((129, 129))
    tolerance = np.full(height.shape, 0.5)
    assert len(terrain.mesh(grid(height), tolerance)[2]) == 2
    height[20:30, 20:30] = 40.0
    row, column, triangle = terrain.mesh(grid(height), tolerance)
    assert 20 < len(triangle) < 1500
    assert np.sum((row > 64) & (column > 64)) < 20


def test_any_number_of_threads_makes_the_same_mesh():
    place, meshes = grid(rough(200, 150, 3, 0.5)), []
    for threads in (1, 2, 0):
        set_threads(threads)
        meshes.append(terrain.mesh(place, np.full((200, 150), 8.0)))
    set_threads(0)
    for other in meshes[1:]:
        for mine, its in zip(meshes[0], other, strict=True):
            np.testing.assert_array_equal(mine, its)


def test_triangles_of_the_margin_stay_small():
    place, tolerance = grid(np.zeros((70, 60))), np.ones((70, 60))
    row, column, triangle = terrain.mesh(place, tolerance, margin=10, max_span=4)
    closed(row, column, triangle, 70, 60)
    wide = np.maximum(np.ptp(row[triangle], axis=1), np.ptp(column[triangle], axis=1))
    low = np.minimum(row[triangle].min(axis=1), column[triangle].min(axis=1))
    assert wide[low < 10].max() <= 4.0
    assert wide.max() > 4.0


def surface(rows, columns, seed=0):
    rng = np.random.default_rng(seed)
    height = rough(rows, columns, seed, 0.5)
    steep, dry = rng.uniform(0, 1, (2, rows, columns)).astype(np.float32)
    return height, terrain.Surface(height, steep, dry, (20.0, 20.0), OCTAVES, 7.0, 0.25, 2.4, 0.55, 91)


def test_near_an_eye_the_mesh_follows_the_surface_between_grid_points():
    rows, columns, halvings = 14, 18, 3
    height, near = surface(rows, columns)
    place, eye = grid(height), np.array([[300.0, 240.0, 500.0]])
    fine = np.zeros((rows - 1, columns - 1), np.uint8)
    fine[8:12, 10:15] = halvings
    for most in (0.3, 2.0):
        row, column, triangle = terrain.mesh(
            place, np.full((rows, columns), most), fine, near, eye, radius=1e4
        )
        closed(row, column, triangle, rows, columns)
        steps = 2**halvings
        y, x = np.meshgrid(np.arange(8 * steps, 12 * steps + 1), np.arange(10 * steps, 15 * steps + 1))
        y, x = (v.ravel() / steps for v in (y, x))

        def true(r, c):
            i, j = np.minimum(r.astype(int), rows - 2), np.minimum(c.astype(int), columns - 2)
            v, u = r - i, c - j
            flat = (height[i, j] * (1 - u) + height[i, j + 1] * u) * (1 - v)
            flat += (height[i + 1, j] * (1 - u) + height[i + 1, j + 1] * u) * v
            return flat + near.detail(r, c)

        scale = 2**halvings
        whole = np.zeros(((rows - 1) * scale + 1, (columns - 1) * scale + 1, 3))
        used = (row * scale).astype(int), (column * scale).astype(int)
        whole[(*used, 2)] = true(row, column)
        off = drawn(whole, row * scale, column * scale, triangle, y * scale, x * scale) - true(y, x)
        assert np.abs(off).max() <= most + 1e-3
        assert np.abs(off).max() > 0.3 * most


def gradient_noise(x, y, seed):
    """Perlin's noise (2002) in NumPy: slopes of length 1 on a lattice, turned by MurmurHash3's finaliser."""
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = x - column, y - row
    corners = []
    for dy in (0, 1):
        for dx in (0, 1):
            h = (column + dx).astype(np.uint32) * np.uint32(0x9E3779B1)
            h ^= (row + dy).astype(np.uint32) * np.uint32(0x85EBCA77)
            h ^= np.uint32((seed * 0x27D4EB2F + 0x165667B1) & 0xFFFFFFFF)
            h = (h ^ (h >> np.uint32(16))) * np.uint32(0x85EBCA6B)
            h = (h ^ (h >> np.uint32(13))) * np.uint32(0xC2B2AE35)
            angle = (h ^ (h >> np.uint32(16))) * (2 * np.pi / 2**32)
            corners.append(np.cos(angle) * (u - dx) + np.sin(angle) * (v - dy))
    u, v = (w**3 * (w * (6 * w - 15) + 10) for w in (u, v))
    low, high = (corners[k] + u * (corners[k + 1] - corners[k]) for k in (0, 2))
    return 1.41 * (low + v * (high - low))


def test_noise_at_a_place_does_not_hang_on_the_place_before():
    rng = np.random.default_rng(4)
    x, y = (v.ravel() for v in np.meshgrid(np.linspace(-3.0, 9.0, 150), np.linspace(5.0, -2.0, 90)))
    in_rows = terrain.perlin(x, y, 12)
    assert in_rows == pytest.approx(gradient_noise(x, y, 12), abs=1e-12)
    mixed = rng.permutation(len(x))
    assert np.array_equal(terrain.perlin(x[mixed], y[mixed], 12), in_rows[mixed])
    assert not np.array_equal(terrain.perlin(x, y, 13), in_rows)
    assert np.array_equal(terrain.perlin(np.arange(5.0), np.arange(5.0), 12), np.zeros(5))


def test_values_between_points_are_bilinear_and_go_on_beyond_the_ends():
    rng = np.random.default_rng(5)
    a, b, c, d = rng.normal(size=4)
    row, column = rng.uniform(-3.0, 12.0, (2, 500))
    known = a + b * np.arange(8)[:, None] + c * np.arange(6) + d * np.arange(8)[:, None] * np.arange(6)
    wanted = a + b * row + c * column + d * row * column
    assert terrain.bilinear(known, row, column) == pytest.approx(wanted, abs=1e-9)
    inner, last = np.array([2.5, 6.999]), np.array([4.25, 0.0])
    bent = rng.normal(size=(8, 6))
    i, j = inner.astype(int), last.astype(int)
    low = bent[i, j] * (1 - (last - j)) + bent[i, j + 1] * (last - j)
    high = bent[i + 1, j] * (1 - (last - j)) + bent[i + 1, j + 1] * (last - j)
    assert np.array_equal(terrain.bilinear(bent, inner, last), low * (1 - (inner - i)) + high * (inner - i))
    assert np.array_equal(terrain.bilinear([[3.0]], [0.0, 2.0], [1.0, 0.5]), [3.0, 3.0])
    assert np.isnan(terrain.bilinear(bent, [np.nan], [1.0])).all()
    with pytest.raises(ValueError, match="field"):
        terrain.bilinear(np.empty((0, 3)), [0.0], [0.0])


def test_bilinear_takes_bands_and_crossings_of_rows_and_columns():
    rng = np.random.default_rng(6)
    field = rng.normal(size=(7, 5, 3)).astype(np.float32)
    row, column = rng.uniform(-1.0, 8.0, 11), rng.uniform(-1.0, 6.0, 13)
    found = terrain.bilinear(field, row[:, None], column)
    assert found.shape == (11, 13, 3)
    rows, columns = (each.ravel() for each in np.meshgrid(row, column, indexing="ij"))
    for band in range(3):
        alone = terrain.bilinear(field[..., band].astype(np.float64), rows, columns)
        assert np.array_equal(found[..., band].ravel(), alone)
    assert terrain.bilinear(field, 2.0, 3.0) == pytest.approx(field[2, 3], abs=0)
    with pytest.raises(ValueError, match="field"):
        terrain.bilinear(np.zeros(3), [0.0], [0.0])


def test_noise_in_space_is_gradient_noise():
    rng = np.random.default_rng(7)
    place = rng.uniform(-40.0, 40.0, (20000, 3))
    found = terrain.perlin_in_space(place)
    assert np.array_equal(terrain.perlin_in_space(np.floor(place)), np.zeros(len(place)))
    assert 0.8 < np.abs(found).max() <= 1.1
    assert abs(found.mean()) < 0.01
    step = 1e-6 * rng.normal(size=place.shape)
    assert np.abs(terrain.perlin_in_space(place + step) - found).max() < 1e-4


def test_uniform_numbers_depend_on_places_and_seed_alone():
    x, y = np.arange(-300, 300), np.arange(500)[:, None]
    found = terrain.uniform(x, y, 5)
    assert found.shape == (500, 600)
    assert 0.0 <= found.min() < 1e-4 < 1.0 - 1e-4 < found.max() < 1.0
    assert np.histogram(found, 10)[0] == pytest.approx(30000, rel=0.03)
    assert np.array_equal(terrain.uniform(x[7], y[9], 5), found[9, 7:8])
    assert not np.array_equal(terrain.uniform(x, y, 6), found)


def test_the_surface_is_smooth_with_ridges_of_gradient_noise():
    rows, columns = 12, 15
    height, _ = surface(rows, columns, 5)
    rng = np.random.default_rng(1)
    row, column = rng.uniform(1, rows - 2, 500), rng.uniform(1, columns - 2, 500)
    level = np.zeros((rows, columns))
    plain = terrain.Surface(height, level, level, (20.0, 20.0), OCTAVES, 7.0, 0.25, 2.4, 0.55, 91)
    i, j = row.astype(int), column.astype(int)
    v, u = row - i, column - j

    def weights(t):
        return np.stack([-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2])

    patch = np.array([[height[i + a, j + b] for b in range(-1, 3)] for a in range(-1, 3)])
    smooth = 0.25 * np.einsum("an,bn,abn->n", weights(v), weights(u), patch)
    flat = (height[i, j] * (1 - u) + height[i, j + 1] * u) * (1 - v)
    flat += (height[i + 1, j] * (1 - u) + height[i + 1, j + 1] * u) * v
    assert plain.detail(row, column) == pytest.approx(smooth - flat, abs=1e-9)
    wet = terrain.Surface(level, level, level + 1.0, (20.0, 20.0), OCTAVES, 7.0, 0.25, 2.4, 0.55, 91)
    waves = sum(
        weight * (1 - 2.4 * np.abs(gradient_noise(column * 20 / size, row * 20 / size, 91 + k)))
        for k, (size, weight) in enumerate(OCTAVES)
    )
    assert wet.detail(row, column) == pytest.approx(7.0 * 0.25 * (waves - 0.55), abs=1e-9)


def test_a_patch_counts_in_place_of_the_surface_by_its_share():
    rows, columns, parts = 9, 11, 4
    height, own = surface(rows, columns, 3)
    steep, dry = np.ones((2, rows, columns), np.float32)
    rng = np.random.default_rng(7)
    offset = rng.uniform(-9.0, 9.0, (3 * parts + 1, 4 * parts + 1)).astype(np.float32)
    share = rng.uniform(0.0, 1.0, offset.shape).astype(np.float32)
    share[:5] = 1.0

    def made(patch):
        return terrain.Surface(height, steep, dry, (20.0, 20.0), OCTAVES, 7.0, 0.25, 2.4, 0.55, 91, patch)

    own, near = made(None), made((2, 5, parts, offset, share))
    row, column = rng.uniform(0, rows - 1, 2000), rng.uniform(0, columns - 1, 2000)
    y, x = (row - 2) * parts, (column - 5) * parts
    inside = (y >= 0) & (x >= 0) & (y <= 3 * parts) & (x <= 4 * parts)
    assert 100 < inside.sum() < 1000
    i, j = np.minimum(y[inside].astype(int), 3 * parts - 1), np.minimum(x[inside].astype(int), 4 * parts - 1)
    v, u = y[inside] - i, x[inside] - j

    def between(field):
        low = field[i, j] * (1 - u) + field[i, j + 1] * u
        return low * (1 - v) + (field[i + 1, j] * (1 - u) + field[i + 1, j + 1] * u) * v

    wanted = own.detail(row, column)
    wanted[inside] += between(share) * (between(offset) - wanted[inside])
    assert near.detail(row, column) == pytest.approx(wanted, abs=1e-5)


@pytest.mark.parametrize(
    ("patch", "reason"),
    [
        ((0, 0, 1, np.zeros((1, 5)), np.zeros((1, 5))), "two rows and columns"),
        ((0, 0, 0, np.zeros((2, 5)), np.zeros((2, 5))), "a patch needs offsets"),
        ((0, 0, 1, np.zeros((2, 5)), np.zeros((2, 4))), "share must have shape"),
    ],
)
def test_what_is_no_patch_is_refused(patch, reason):
    field = np.zeros((4, 5))
    with pytest.raises(ValueError, match=reason):
        terrain.Surface(field, field, field, (20.0, 20.0), OCTAVES, 7.0, 0.25, 2.4, 0.55, 91, patch)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"place": np.zeros((1, 1, 3)), "tolerance": np.ones((1, 1))}, "two rows and columns"),
        ({"place": np.full((4, 4, 3), np.nan)}, "place must be finite"),
        ({"tolerance": np.full((4, 4), -1.0)}, "tolerance must be 0 or more"),
        ({"tolerance": np.full((4, 4), np.nan)}, "tolerance must be 0 or more"),
        ({"tolerance": np.zeros((3, 4))}, "tolerance must have shape"),
        ({"subdivision": np.zeros((4, 4), np.uint8)}, "subdivision must have shape"),
        ({"subdivision": np.full((3, 3), 200, np.uint8)}, "too many points"),
        ({"surface": surface(5, 4)[1]}, "surface must have the same number"),
    ],
)
def test_what_makes_no_mesh_is_refused(change, reason):
    with pytest.raises(ValueError, match=reason):
        terrain.mesh(**{"place": grid(np.zeros((4, 4))), "tolerance": np.ones((4, 4)), **change})
