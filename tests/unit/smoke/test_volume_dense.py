"""Dense boxes of several fields as VDB files: as OpenVDB's own module writes them, and what cameras see."""

import shutil
import subprocess
import sys

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core import InputError, lod, volume
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from hypothesis_profiles import examples
from plumes import read

NORTH = np.column_stack([[1, 0, 0], [0, 0, 1], [0, -1, 0]]).astype(float)  # looks north
SHAPES = st.tuples(*[st.integers(1, 20)] * 3)


def boxes(shape=(50, 37, 70), seed=4):
    """Fields of one box: ragged smoke, a solid block and an empty one, values at the ends of half floats."""
    random = np.random.default_rng(seed)
    density = random.random(shape, np.float32) * (random.random(shape) < 0.3)
    density[:24, 8:32] = 0.7
    density[24:40, :, 16:40] = 0.0
    temperature = (random.normal(size=shape) * 300).astype(np.float32)
    temperature[density == 0.0] = 0.0
    temperature.flat[-8:] = [65504, -65504, 6e-8, 2.9e-8, -1e-30, 6.1e-5, 2049, 1e-4]
    return {"density": density.astype(np.float32), "temperature": temperature}


def bundled_openvdb():
    """Blender's own OpenVDB module."""
    pytest.importorskip("bpy").utils.expose_bundled_modules()
    import openvdb

    return openvdb


def as_openvdb_writes(path, fields, half, tolerance=0.0):
    """Write the fields with OpenVDB's Python module."""
    openvdb = bundled_openvdb()
    grids = []
    for name, values in fields.items():
        grid = openvdb.FloatGrid()
        grid.copyFromArray(values, tolerance=tolerance)
        grid.name, grid.saveFloatAsHalf = name, half
        grids.append(grid)
    openvdb.write(str(path), grids=grids)


@pytest.mark.parametrize("half", [True, False])
@pytest.mark.parametrize("shape", [(50, 37, 70), (8, 8, 8), (1, 1, 1), (1, 150, 3), (129, 9, 130)])
def test_several_fields_are_what_openvdb_writes(tmp_path, half, shape):
    openvdb = bundled_openvdb()
    ours, theirs = tmp_path / "ours.vdb", tmp_path / "theirs.vdb"
    fields = boxes() if shape == (50, 37, 70) else {"density": boxes((160, 160, 160))["density"][: shape[0]]}
    fields = {name: np.ascontiguousarray(field[:, : shape[1], : shape[2]]) for name, field in fields.items()}
    frame = volume.write(ours, fields, 1.0, half=half)
    as_openvdb_writes(theirs, fields, half)
    fields_read, expected = read(ours), read(theirs)
    assert set(fields_read) == set(fields)
    for name in fields:
        mine, other = openvdb.read(str(ours), name), openvdb.read(str(theirs), name)
        for property in ("activeVoxelCount", "leafCount", "evalActiveVoxelBoundingBox"):
            assert getattr(mine, property)() == getattr(other, property)()
        np.testing.assert_array_equal(fields_read[name][0], expected[name][0])
    assert frame.voxels == sum(int(np.count_nonzero(field)) for field in fields.values())
    assert frame.mass == pytest.approx(fields["density"].sum(dtype=np.float64), rel=1e-12)


@settings(
    deadline=None, max_examples=examples(20), suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    arrays(np.float32, SHAPES, elements=st.floats(-100, 100, width=32), fill=st.just(0)),
    st.floats(0, 50, width=32),
)
def test_what_is_within_the_tolerance_is_left_out(tmp_path, field, tolerance):
    frame = volume.write(tmp_path / "box.vdb", {"density": field}, 2.0, half=False, tolerance=tolerance)
    kept = np.where(np.abs(field) > tolerance, field, 0)
    assert frame.active_voxels == np.count_nonzero(kept)
    assert frame.mass == pytest.approx(8 * float(kept.sum(dtype=np.float64)), rel=1e-12, abs=1e-9)
    if frame.active_voxels:
        found, low = read(tmp_path / "box.vdb")["density"]
        inside = tuple(slice(a, a + n) for a, n in zip(low, found.shape, strict=True))
        np.testing.assert_array_equal(found, kept[inside])


def test_dense_arrays_come_back(tmp_path):
    random = np.random.default_rng(1)
    dense = random.random((9, 12, 20), dtype=np.float32)
    dense[dense < 0.5] = 0.0
    path = tmp_path / "dense.vdb"
    frame = volume.write(path, {"density": dense}, 10.0, origin=(5.0, 6.0, 7.0), half=False)
    assert frame.mass == pytest.approx(dense.sum(dtype=np.float64) * 1000.0, rel=1e-6)
    assert frame.active_voxels == np.count_nonzero(dense)
    found, low = read(path)["density"]
    inside = tuple(slice(a, a + n) for a, n in zip(low, found.shape, strict=True))
    assert np.array_equal(found, dense[inside])
    assert frame.bounds[0] == pytest.approx(np.array([5.0, 6.0, 7.0]) + 10.0 * (low - 0.5))


def test_half_grids_refuse_what_they_cannot_hold(tmp_path):
    field = np.full((2, 2, 2), 70_000.0, np.float32)
    with pytest.raises(ValueError, match="65504"):
        volume.write(tmp_path / "flux.vdb", {"heat": field}, 1.0)
    volume.write(tmp_path / "flux.vdb", {"heat": field}, 1.0, half=False)


def test_every_half_float_is_rounded_to_the_nearest(tmp_path):
    """Values on, between and half way between half floats, against NumPy's."""
    bits = np.arange(1, 0x7C00 - 1, dtype=np.uint16)
    low, high = bits.view(np.float16).astype(np.float32), (bits + 1).view(np.float16).astype(np.float32)
    middle = (low + high) / 2
    values = np.concatenate([low, middle, np.nextafter(middle, 0), np.nextafter(middle, np.float32(1e9))])
    values = np.concatenate([values, -values])
    values = np.resize(values[np.abs(values) > 2.0**-25], (8, 8 * (len(values) // 64), 8))
    volume.write(tmp_path / "half.vdb", {"any": values}, 1.0)
    found, _ = read(tmp_path / "half.vdb")["any"]
    np.testing.assert_array_equal(found, values.astype(np.float16).astype(np.float32))


def test_vdb_print_reads_several_fields(tmp_path):
    if shutil.which("vdb_print") is None:
        pytest.skip("vdb_print is not installed")
    path = tmp_path / "box.vdb"
    volume.write(path, boxes(), 10.0, metadata={"run": "a test"})
    told = subprocess.run(["vdb_print", "-l", path], capture_output=True, text=True, check=True).stdout
    assert "a test" in told
    assert "Name: density" in told
    assert "Name: temperature" in told
    assert told.count("blosc + active values") == 2
    assert told.count("is_saved_as_half_float: true") == 2


def test_what_no_camera_sees_is_left_out(tmp_path):
    """Visible blocks are complete, others are absent; the mass includes both."""
    openvdb = bundled_openvdb()
    random = np.random.default_rng(1)
    shape, voxel, origin = (150, 140, 40), 50.0, (-3000.0, -2000.0, 500.0)
    fields = {
        "density": random.random(shape, np.float32) + 0.1,
        "tint": random.random(shape, np.float32) + 0.1,
    }
    view = lod.ViewSet([(0.0, -2500.0, 1000.0)], NORTH, np.tan((0.2, 0.15)), sun=(0.6, 0.0, 0.8))
    path = tmp_path / "seen.vdb"
    frame = volume.write(path, fields, voxel, origin, half=False, views=view)
    seen = np.zeros(shape, bool)
    for corner in np.ndindex(19, 18, 5):
        middle = (8 * np.array(corner) + 3.5) * voxel + origin
        block = tuple(slice(8 * i, 8 * i + 8) for i in corner)
        seen[block] = lod.visible_mask([middle], 4 * voxel * 3**0.5 + 300.0, view, shadows=True)[0]
    assert 0.1 < seen.mean() < 0.9
    for name, field in fields.items():
        grid, found = openvdb.read(str(path), name), np.zeros(shape, np.float32)
        grid.copyToArray(found)
        np.testing.assert_array_equal(found, np.where(seen, field, 0))
        assert grid.activeVoxelCount() == seen.sum()
    density = fields["density"].astype(np.float64)
    assert frame.mass == pytest.approx(density[seen].sum() * voxel**3, rel=1e-12)
    assert frame.culled_mass == pytest.approx(density[~seen].sum() * voxel**3, rel=1e-12)


def test_what_is_not_seen_is_not_looked_at_but_for_its_mass(tmp_path):
    view = lod.ViewSet([(0.0, 0.0, 0.0)], NORTH, np.tan((0.2, 0.15)))
    behind = np.full((8, 8, 8), np.nan, np.float32)
    more = {"voxel_size": 10.0, "origin": (0.0, -5000.0, 0.0), "views": view}
    frame = volume.write(tmp_path / "behind.vdb", {"tint": behind}, **more)
    assert (frame.active_voxels, frame.mass, frame.culled_mass) == (0, 0.0, 0.0)
    with pytest.raises(ValueError, match="density"):
        volume.write(tmp_path / "behind.vdb", {"density": behind}, **more)


def test_grids_keep_within_the_blocks_of_one(tmp_path):
    """Other grids are complete in blocks with voxels or with one value, and absent elsewhere."""
    openvdb = bundled_openvdb()
    random, path = np.random.default_rng(2), tmp_path / "within.vdb"
    fields = {name: random.random((28, 20, 16), np.float32) + 0.1 for name in ("after", "smoke", "zero")}
    fields["smoke"][:] = 0.0
    fields["smoke"][8:16, :8, 8:16] = 0.5
    fields["smoke"][27, 19, 3] = 0.1
    wanted = np.zeros((28, 20, 16), bool)
    wanted[8:16, :8, 8:16] = wanted[24:, 16:, :8] = True
    volume.write(path, fields, 10.0, half=False, within="smoke")
    for name, field in fields.items():
        found = np.zeros_like(field)
        openvdb.read(str(path), name).copyToArray(found)
        np.testing.assert_array_equal(found, np.where(wanted, field, 0))
    with pytest.raises(ValueError, match='within must name one of the grids, not "haze"'):
        volume.write(path, fields, 10.0, within="haze")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 65505.0])
def test_what_cannot_be_held_is_named_with_its_place(tmp_path, value):
    fields = boxes()
    fields["temperature"][49, 36, 69] = fields["temperature"][30, 20, 10] = value
    with pytest.raises(ValueError, match=r'"temperature" holds .* at \[30, 20, 10\]'):
        volume.write(tmp_path / "bad.vdb", fields, 1.0)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tolerance": -1.0}, "tolerance"),
        ({"tolerance": np.nan}, "tolerance"),
        ({"origin": (0.0, np.inf, 0.0)}, "origin"),
        ({"voxel_size": 1e-9}, "voxel_size must be 1e-4 to 1e6 m, not 1e-09"),
        ({"voxel_size": 1e-300}, "voxel_size must be 1e-4 to 1e6 m, not 1e-300"),
        ({"voxel_size": 1e300}, "voxel_size must be 1e-4 to 1e6 m, not"),
    ],
)
def test_numbers_that_make_no_sense_are_refused(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        volume.write(tmp_path / "bad.vdb", boxes((3, 4, 5)), **({"voxel_size": 1.0} | change))


@pytest.mark.parametrize("voxel", [1e-4, 1e6])
def test_the_smallest_and_the_largest_voxels_come_back(tmp_path, voxel):
    path = tmp_path / "voxel.vdb"
    volume.write(path, {"density": np.ones((2, 2, 2), np.float32)}, voxel)
    assert bundled_openvdb().read(str(path), "density").transform.voxelSize() == pytest.approx((voxel,) * 3)


def test_files_are_the_same_on_any_number_of_threads(tmp_path, all_threads):
    files = set()
    for number in (1, 2, 4, 7):
        core.set_threads(number)
        path = tmp_path / "box.vdb"
        volume.write(path, boxes((130, 140, 60)), 20.0)
        files.add(path.read_bytes())
    assert len(files) == 1


IN_A_PROCESS = """
import re, resource, signal
import numpy as np
from firetwin_core import geo, volume
def peak():
    return int(re.search("VmHWM:\\s*(\\d+) kB", open("/proc/self/status").read())[1]) / 1024
{}
before = peak()
{}
print(peak() - before)
"""

DENSE = "field = np.random.default_rng(0).random((512, 512, 64), np.float32)"
LEVELS = """
side, count = {}
latitude, longitude = 38.9 + np.linspace(-0.27, 0.27, side), -120.55 + np.linspace(-0.35, 0.35, side)
ground = np.full((side, side), 500.0, np.float32)
level = np.linspace(520.0, 10_000.0, count, dtype=np.float32)
height = np.repeat(level, side * side).reshape(count, side, side)
smoke = np.zeros_like(height)
smoke[0, 1, 1] = smoke[-1, -2, -2] = 1e-5
grid = geo.LocalFrame(38.9, -120.55, 0.0), latitude, longitude, ground, height, smoke
"""


def grown(prepare, act):
    """MB that a process grows by."""
    if sys.platform != "linux":
        pytest.skip("memory is told elsewhere")
    program = IN_A_PROCESS.format(prepare, act)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return float(done.stdout)


def test_memory_does_not_grow_with_the_grid(tmp_path):
    """A field of 67 MB, a file of 34."""
    path = str(tmp_path / "box.vdb")
    assert grown(DENSE, f"volume.write({path!r}, {{'density': field}}, 10.0)") < 24


def test_levels_without_smoke_need_no_memory(tmp_path):
    """Two fields of 29 MB with smoke in two cells."""
    path = str(tmp_path / "levels.vdb")
    assert grown(LEVELS.format((300, 80)), f"volume.write_levels({path!r}, *grid, 200.0)") < 12


def test_air_without_smoke_needs_no_memory(tmp_path):
    """70 million leaves of 10 m voxels between two wisps, 60 km apart and 10 km up."""
    path = str(tmp_path / "wisps.vdb")
    assert grown(LEVELS.format((720, 4)), f"volume.write_levels({path!r}, *grid, 10.0)") < 40


def test_a_full_disk_is_told_and_leaves_nothing(tmp_path):
    """A file of 34 MB where only 5 fit."""
    path = str(tmp_path / "box.vdb")
    limit = "resource.setrlimit(resource.RLIMIT_FSIZE, (5 << 20, 5 << 20))"
    limit = f"signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n{limit}"
    act = f"""
for _ in range(8):
    try:
        volume.write({path!r}, {{'density': field}}, 10.0)
    except Exception as error:
        assert type(error).__name__ == "InputError" and "File too large" in str(error), error
    else:
        raise AssertionError("nothing was raised")
"""
    grown(f"{DENSE}\n{limit}", act)
    assert not list(tmp_path.iterdir())


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        volume.write(tmp_path / "none" / "box.vdb", boxes((3, 4, 5)), 1.0)
