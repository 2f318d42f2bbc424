"""A model's own smoke on terrain-following levels: read, put into voxels, and as much of it."""

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening
from firetwin_core import Error, InputError, geo, lod, volume
from plumes import read
from small_run import NT, NX, NY, RUN_TOML, small_fields

ORIGIN = (38.9, -120.55)
LATITUDE = ORIGIN[0] + 0.0033 * np.arange(-15, 16)  # 366 m
LONGITUDE = ORIGIN[1] + 0.0042 * np.arange(-15, 16)  # 364 m
FRAME = geo.LocalFrame(*ORIGIN, 0.0)
SIGMA = np.array([0.0, 0.02, 0.05, 0.1, 0.18, 0.3, 0.45, 0.65, 1.0])
TOP = 6000.0


def ground():
    """(ny, nx) hills between 800 and 1600 m."""
    row, column = np.meshgrid(np.arange(len(LATITUDE)), np.arange(len(LONGITUDE)), indexing="ij")
    return (1200 + 400 * np.sin(row / 4.0) * np.cos(column / 5.0)).astype(np.float32)


def heights(first=20.0):
    """(nz, ny, nx) levels that follow the ground and flatten out towards the top."""
    low = ground() + first
    return (low + SIGMA[:, None, None] * (TOP - low)).astype(np.float32)


def place(grid_low, shape, voxel):
    """Latitude, longitude and height of voxels, each of `shape`."""
    index = np.indices(shape).reshape(3, -1).T + grid_low
    return [part.reshape(shape) for part in FRAME.reverse(np.ascontiguousarray(index * voxel, np.float64))]


def write(path, smoke, voxel=150.0, height=None, **more):
    height = heights() if height is None else height
    return volume.write_levels(path, FRAME, LATITUDE, LONGITUDE, ground(), height, smoke, voxel, **more)


def test_what_is_linear_in_height_stays_so(tmp_path):
    """Exact within half floats (2^-11) and 3e-5 although levels, ground and voxels do not fit each other."""
    path = tmp_path / "linear.vdb"
    write(path, 1e-5 * (0.2 + heights() / 10_000.0))
    dilution, low = read(path)["dilution"]
    _, _, height = place(low, dilution.shape, 150.0)
    inside = dilution > 0.0
    assert inside.sum() > 50_000
    above_lowest = height > ground().max() + 20.0
    chosen = inside & above_lowest
    assert dilution[chosen] == pytest.approx(0.2 + height[chosen] / 10_000.0, rel=2.0**-11 + 3e-5)
    assert height[inside].max() <= TOP + 0.01


def test_smoke_lies_where_the_model_has_it(tmp_path):
    """A smooth field of latitude and longitude comes back within its own curvature between columns."""
    east = np.cos((LONGITUDE - ORIGIN[1]) * 40)[None, None, :]
    north = np.cos((LATITUDE - ORIGIN[0] - 0.01) * 50)[None, :, None]
    path = tmp_path / "smooth.vdb"
    write(path, np.broadcast_to(1e-5 * (1.2 + 0.5 * east * north), heights().shape))
    dilution, low = read(path)["dilution"]
    latitude, longitude, _ = place(low, dilution.shape, 150.0)
    expected = 1.2 + 0.5 * np.cos((longitude - ORIGIN[1]) * 40) * np.cos((latitude - ORIGIN[0] - 0.01) * 50)
    inside = dilution > 0.0
    curvature = 0.5 / 8 * ((0.0042 * 40) ** 2 + (0.0033 * 50) ** 2)
    assert dilution[inside] == pytest.approx(expected[inside], abs=1.1 * curvature + 1e-3)


def test_mass_of_a_smooth_field_is_kept(tmp_path):
    """cos^2 clouds: the sum over voxels is the integral within a thousandth, of which 1e-3 is trilinear."""
    flat = np.full((len(LATITUDE), len(LONGITUDE)), 500.0, np.float32)
    level = np.linspace(520.0, 5520.0, 51)
    height = np.broadcast_to(level[:, None, None], (51, *flat.shape)).astype(np.float32)
    corner = FRAME.forward_grid(LATITUDE, LONGITUDE, np.zeros(flat.shape))
    x, y = corner[..., 0] / 4000.0, corner[..., 1] / 4000.0
    z = (level - 3000.0) / 2000.0

    def bump(t):
        return np.where(np.abs(t) < 1.0, np.cos(0.5 * np.pi * t) ** 2, 0.0)

    smoke = 2e-5 * bump(z)[:, None, None] * bump(x) * bump(y)
    exact = 2e-5 * 4000.0 * 4000.0 * 2000.0  # each bump's integral is its half-width
    for voxel, tolerance in ((200.0, 0.004), (100.0, 0.004)):
        frame = volume.write_levels(
            tmp_path / "mass.vdb", FRAME, LATITUDE, LONGITUDE, flat, height, smoke, voxel
        )
        assert frame.mass == pytest.approx(exact, rel=tolerance)


def test_no_smoke_under_the_ground_or_over_the_top(tmp_path):
    path = tmp_path / "all.vdb"
    write(path, np.full(heights().shape, 1e-5, np.float32))
    grids = read(path)
    dilution, low = grids["dilution"]
    latitude, longitude, height = place(low, dilution.shape, 150.0)
    row = (latitude - LATITUDE[0]) / 0.0033
    column = (longitude - LONGITUDE[0]) / 0.0042
    within = (row > 0) & (row < 30) & (column > 0) & (column < 30)
    i, j = np.clip(row.astype(int), 0, 29), np.clip(column.astype(int), 0, 29)
    p, q = row - i, column - j
    floor = ground().astype(np.float64)
    floor = (1 - p) * ((1 - q) * floor[i, j] + q * floor[i, j + 1]) + p * (
        (1 - q) * floor[i + 1, j] + q * floor[i + 1, j + 1]
    )
    sure = within & (np.abs(height - floor) > 0.1) & (np.abs(height - TOP) > 0.1)
    expected = within & (height > floor) & (height < TOP)
    assert np.array_equal((dilution > 0.0)[sure], expected[sure])
    assert np.all(grids["density"][0][expected & sure] == 1.0)
    kelvin = grids["temperature"][0][expected & sure]
    assert kelvin == pytest.approx(288.15 - 0.0065 * height[expected & sure], abs=0.2)


def test_every_grid_has_its_unit(tmp_path):
    path = tmp_path / "lit.vdb"
    smoke = np.full(heights().shape, 1e-6, np.float32)
    kelvin = np.full(heights().shape, 333.0, np.float32)
    lit = {"flame_position": [[0.0, 0.0, 1500.0]], "flame_power": [1.0e9]}
    frame = write(path, smoke, temperature=kelvin, metadata={"source": "model"}, **lit)
    grids = read(path)
    assert set(grids) == {"density", "dilution", "shade", "size", "temperature", "glow", "flame"}
    assert grids["temperature"][0].max() == pytest.approx(333.0, abs=0.2)
    assert grids["size"][0].max() == pytest.approx(0.364, abs=0.002)
    assert grids["glow"][0].max() > 0.1
    assert frame.voxels > 6 * frame.active_voxels


def test_flames_make_glow_that_falls_off(tmp_path):
    path = tmp_path / "lit.vdb"
    flame = np.array([[0.0, 0.0, 1500.0]])
    smoke = np.full(heights().shape, 1e-6, np.float32)
    write(path, smoke, 100.0, flame_position=flame, flame_power=[1.0e9])
    grids = read(path)
    glow, low = grids["glow"]
    voxel = np.argwhere(glow > 0.0)
    distance = np.linalg.norm((voxel + low) * 100.0 - flame, axis=1)
    expected = np.exp(-distance / 1100.0) / (1.0 + (distance / 250.0) ** 2)
    far = distance > 700.0  # nearer, the nodes are too far apart to follow the peak
    assert glow[tuple(voxel[far].T)] == pytest.approx(expected[far], abs=0.02)
    assert 0.3 < glow.max() <= 1.0
    with pytest.raises(Error, match="too small"):
        write(path, 0.0 * smoke, 1e-4, flame_position=[[1.0e6, 0.0, 0.0]], flame_power=[1.0e9])


def test_culled_smoke_is_counted_and_the_rest_stays(tmp_path):
    smoke = np.full(heights().shape, 1e-6, np.float32)
    whole = write(tmp_path / "whole.vdb", smoke)
    north = np.column_stack([[1, 0, 0], [0, 0, 1], [0, -1, 0]]).astype(float)
    view = lod.ViewSet([(2000.0, -9000.0, 1500.0)], north, np.tan((0.15, 0.1)), sun=(0.0, 0.6, 0.8))
    part = write(tmp_path / "part.vdb", smoke, views=view)
    assert 0.05 * whole.active_voxels < part.active_voxels < 0.8 * whole.active_voxels
    assert part.mass + part.culled_mass == pytest.approx(whole.mass, rel=1e-9)
    assert part.bytes < whole.bytes
    everything, some = read(tmp_path / "whole.vdb"), read(tmp_path / "part.vdb")
    there = some["dilution"][0] > 0.0
    for name, (values, low) in some.items():
        full, corner = everything[name]
        same = full[tuple(slice(o, o + n) for o, n in zip(low - corner, values.shape, strict=True))]
        assert np.array_equal(values[there], same[there])


def test_only_requested_grids_are_written(tmp_path):
    path, smoke = tmp_path / "some.vdb", np.full(heights().shape, 1e-6, np.float32)
    lit = {"flame_position": [[0.0, 0.0, 1500.0]], "flame_power": [1.0e9]}
    frame = write(path, smoke, grids=["dilution", "glow"], **lit)
    assert set(read(path)) == {"dilution", "glow"}
    assert frame.voxels == 2 * frame.active_voxels
    write(path, smoke, grids=["dilution", "glow"])
    assert set(read(path)) == {"dilution"}
    with pytest.raises(ValueError, match="choose from density"):
        write(path, smoke, grids=["smoke"])


def test_gaps_and_negative_smoke_count_as_none(tmp_path):
    smoke = np.full(heights().shape, 1e-5, np.float32)
    smoke[:, :20] = -1.0
    smoke[:, 20:25] = np.nan
    frame = write(tmp_path / "gaps.vdb", smoke)
    assert frame.bounds[0, 1] > FRAME.forward([LATITUDE[24]], [ORIGIN[1]], [0.0])[0, 1] - 600.0
    nothing = write(tmp_path / "none.vdb", np.zeros(heights().shape, np.float32))
    assert (nothing.active_voxels, nothing.mass) == (0, 0.0)


def test_axes_may_descend_and_count_past_180(tmp_path):
    smoke = np.random.default_rng(3).uniform(0, 1e-5, heights().shape).astype(np.float32)
    first = write(tmp_path / "a.vdb", smoke)
    turned = volume.write_levels(
        tmp_path / "b.vdb",
        FRAME,
        LATITUDE[::-1],
        LONGITUDE + 360.0,
        ground()[::-1],
        heights()[:, ::-1],
        smoke[:, ::-1],
        150.0,
    )
    assert turned.mass == pytest.approx(first.mass, rel=1e-9)
    assert turned.active_voxels == first.active_voxels


@pytest.mark.parametrize("level", [0.0, np.nan, 7000.0])
def test_heights_must_ascend(tmp_path, level):
    height = heights()
    height[3, 2, 1] = level
    with pytest.raises(Error, match="ascend"):
        write(tmp_path / "bad.vdb", np.zeros_like(height), height=height)


@pytest.mark.parametrize("voxel", [1e-4, 1e-2, 0.2])
def test_voxels_far_too_small_are_refused(tmp_path, voxel):
    with pytest.raises(Error, match="too small for smoke of this extent; use larger voxels"):
        write(tmp_path / "small.vdb", np.full(heights().shape, 1e-5, np.float32), voxel)
    with pytest.raises(ValueError, match="voxel_size must be"):
        write(tmp_path / "small.vdb", np.zeros(heights().shape, np.float32), 1e-9 * voxel)


def test_a_cloud_lies_where_its_cells_are(tmp_path):
    """Smoke at single nodes on steep ground, also on the edges: nothing of the cells round them is lost."""
    for level, row, column in [(0, 0, 0), (8, 30, 30), (4, 15, 15), (0, 30, 7), (8, 3, 0)]:
        smoke = np.zeros(heights().shape, np.float32)
        smoke[level, row, column] = 1e-3
        path = tmp_path / "cloud.vdb"
        frame = write(path, smoke, 100.0, grids=["dilution"])
        # Again under a veil that is just above the threshold, so that all leaves are checked.
        veil = np.where(smoke > 0, smoke, 3e-8).astype(np.float32)
        everywhere = write(tmp_path / "veil.vdb", veil, 100.0, grids=["dilution"])
        assert everywhere.active_voxels > frame.active_voxels > 0
        cloud, low = read(path)["dilution"]
        whole, corner = read(tmp_path / "veil.vdb")["dilution"]
        wide = np.zeros_like(whole)
        offset = low - corner
        wide[tuple(slice(o, o + n) for o, n in zip(offset, cloud.shape, strict=True))] = cloud
        assert wide[whole > 0.05] == pytest.approx(whole[whole > 0.05], abs=0.01, rel=2e-3)


def test_files_are_the_same_on_any_number_of_threads(tmp_path, all_threads):
    smoke = np.random.default_rng(8).uniform(-1e-5, 1e-5, heights().shape).astype(np.float32)
    files = set()
    for number in (1, 2, 5):
        core.set_threads(number)
        frame = write(tmp_path / "levels.vdb", smoke)
        files.add((frame.mass, (tmp_path / "levels.vdb").read_bytes()))
    assert len(files) == 1


def test_shapes_must_fit(tmp_path):
    with pytest.raises(ValueError, match="smoke must have shape"):
        write(tmp_path / "bad.vdb", np.zeros((9, 3, 3), np.float32))


# The run that holds such fields.

LEVELS = (NT, 6, NY, NX)


def with_levels(folder, **fields):
    """A small run with fields on levels."""
    folder.mkdir()
    (folder / "run.toml").write_text(RUN_TOML)
    for name, values in (small_fields() | fields).items():
        np.save(folder / f"{name}.npy", values)
    return folder


def test_a_run_reads_fields_on_levels(tmp_path):
    rng = np.random.default_rng(0)
    smoke = rng.random(LEVELS).astype(np.float32)
    smoke[0, 1, 2, 3] = -9999.0
    height = np.sort(rng.random(LEVELS[1:]), axis=0).astype(np.float32)
    opened = opening.open(with_levels(tmp_path / "run", smoke_3d=smoke, height_3d=height))
    assert opened.has("smoke_3d")
    assert not opened.has("temperature_3d")
    smoke[0, 1, 2, 3] = np.nan
    for index in range(NT):
        np.testing.assert_array_equal(opened.smoke_3d(index), smoke[index])
        np.testing.assert_array_equal(opened.height_3d(index), height)
    np.testing.assert_allclose(opened.smoke_3d_at(75.0), 0.75 * smoke[1] + 0.25 * smoke[2], atol=1e-7)
    np.testing.assert_array_equal(opened.smoke_3d_at(120.0), smoke[2])
    np.testing.assert_array_equal(opened.height_3d_at(75.0), height)
    with pytest.raises(IndexError):
        opened.smoke_3d(NT)
    with pytest.raises(ValueError, match="outside"):
        opened.smoke_3d_at(121.0)
    with pytest.raises(Error, match="no temperature_3d"):
        opened.temperature_3d(0)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"smoke_3d": LEVELS}, "heights of the levels"),
        ({"smoke_3d": LEVELS, "height_3d": (5, NY, NX)}, "6 levels where height_3d has 5"),
        ({"smoke_3d": LEVELS[1:], "height_3d": LEVELS}, "expected shape"),
        ({"smoke_3d": (NT, 6, NX, NY), "height_3d": LEVELS}, "fit the times and the axes"),
        ({"smoke_3d": (NT + 1, 6, NY, NX), "height_3d": LEVELS}, "expected shape"),
        ({"smoke_3d": (NT, 1, NY, NX), "height_3d": (1, NY, NX)}, "two levels or more"),
        ({"height_3d": (6,)}, "expected shape"),
    ],
)
def test_fields_that_do_not_fit_are_named(tmp_path, fields, message):
    arrays = {name: np.ones(shape, np.float32) for name, shape in fields.items()}
    with pytest.raises(InputError, match=message):
        opening.open(with_levels(tmp_path / "run", **arrays))


def test_fields_on_levels_are_npy_only(tmp_path):
    folder = with_levels(tmp_path / "run")
    (folder / "smoke_3d").mkdir()
    with pytest.raises(InputError, match=r"numpy\.save"):
        opening.open(folder)
    (folder / "smoke_3d").rmdir()
    with (folder / "smoke_3d.npy").open("wb") as file:  # a header that lies
        np.lib.format.write_array_header_1_0(
            file, {"descr": "<f4", "fortran_order": False, "shape": (NT, 10**9, NY, NX)}
        )
    with pytest.raises(InputError, match="copy or save"):
        opening.open(folder)
