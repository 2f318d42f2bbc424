import shutil
from dataclasses import replace

import bpy
import numpy as np
import pytest
from firetwin.run import burning, frame
from firetwin.run import opening as runs
from firetwin.scene.terrain import build as ground_build
from firetwin.scene.terrain import fields
from firetwin.shot.fire.fire import Fire
from firetwin.shot.shot import Shot
from mathutils.bvhtree import BVHTree


def _vectors(mesh, name):
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes[name].data.foreach_get("vector", found)
    return found.reshape(-1, 3)


def _vertices(mesh):
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


@pytest.fixture
def plain(shot, stage):
    return shot.ground, ground_build.build(shot, stage, None).data


def _pixels(name):
    """A field as its image has it, (ny, nx)."""
    holder, channel = fields.NAMES[name]
    image = bpy.data.images[holder]
    found = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(found)
    return found.reshape(image.size[1], image.size[0], 4)[..., channel]


def test_vertices_are_the_local_frame_of_the_fuel_grid(plain_looks, plain, run):
    ground, mesh = plain
    wanted = frame.local_frame(run).forward_grid(run.fuel_latitude, run.fuel_longitude, run.fuel_elevation)
    place = _vectors(mesh, fields.GRID)
    row, column = (place[:, 1 - k] * ground.shape[k] - 0.5 - ground.fields.margin for k in (0, 1))
    inside = (np.abs(row - 59.5) < 59.9) & (np.abs(column - 59.5) < 59.9)
    i, j = (np.round(v[inside]).astype(int) for v in (row, column))
    assert len(i) > 200
    assert np.abs(row[inside] - i).max() < 1e-3
    assert _vertices(mesh)[inside] == pytest.approx(wanted[i, j], abs=3e-3)


def test_images_carry_the_runs_fields_and_are_saved(plain, run, tmp_path):
    ground, _mesh = plain
    margin = ground.fields.margin
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "ground.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "ground.blend"))

    def grid(name):
        return _pixels(name)[margin : margin + 120, margin : margin + 120]

    assert grid("canopy_fuel") == pytest.approx(run.canopy_fuel, abs=1e-5)
    known = run.fuel_arrival_time()
    burned = (grid("burned") > 0.99) & ~np.isnan(known)
    assert grid("burn_time")[burned] == pytest.approx(known[burned], abs=0.1)
    assert burned.sum() > 0.5 * np.sum(~np.isnan(known))


def test_the_apron_reaches_its_width_and_continues_the_edge(plain_looks, plain, settings):
    ground, mesh = plain
    places = _vertices(mesh)
    assert np.abs(places[:, :2]).max() == pytest.approx(settings.terrain.apron, rel=0.05)
    height, margin = ground.fields.elevation, ground.fields.margin
    for k in range(4):
        step = np.abs(np.diff(np.rot90(height, k), axis=0))
        assert step[margin - 1, margin:-margin].max() < 3.0 * step[margin:-margin].max()


@pytest.mark.parametrize("error", [0.25, 2.0])
def test_the_mesh_is_as_near_to_the_ground_as_cameras_can_tell(near_settings, run, stage, plain_looks, error):
    """In pixels, at places that are seen; between those that the mesh is compared with, a little more."""
    changed = replace(near_settings, terrain=replace(near_settings.terrain, error=error))
    shot = Shot(changed, run)
    mesh = ground_build.build(shot, stage, None).data
    tree = BVHTree.FromPolygons(
        _vertices(mesh).tolist(), [list(polygon.vertices) for polygon in mesh.polygons]
    )
    rng = np.random.default_rng(0)
    place = np.column_stack([rng.uniform(-4000.0, 4000.0, (3000, 2)), np.zeros(3000)])
    place[:, 2] = shot.ground.up(place[:, 0], place[:, 1])
    place = place[shot.visibility.visible_mask(place, 0.0)]
    assert len(place) > 100
    drawn = np.array([tree.ray_cast((x, y, 9000.0), (0.0, 0.0, -1.0))[0][2] for x, y, _ in place])
    (view,) = shot.paths
    pixel = 2.0 * view.half[0] / shot.settings.render.resolution[0] * shot.visibility.distance(place)
    off = np.abs(drawn - place[:, 2]) / pixel
    assert np.percentile(off, 99) < error
    assert off.max() < 1.6 * error


def test_what_no_camera_sees_is_coarse(near_settings, run, stage, plain_looks):
    shot = Shot(near_settings, run)
    mesh = ground_build.build(shot, stage, None).data
    centre = np.array([polygon.center for polygon in mesh.polygons])
    size = np.sqrt([polygon.area for polygon in mesh.polygons])
    inside = np.abs(centre[:, :2]).max(axis=1) < 4000.0
    seen = shot.visibility.visible_mask(centre, 300.0, margin=300.0, shadows=True)
    assert np.median(size[inside & ~seen]) > 2.0 * np.median(size[inside & seen])


def test_ground_between_places_is_the_cores_bilinear_height(shot):
    ground = shot.ground
    points = ground.point([38.8301, 38.8555], [-120.5512, -120.5333], 12.0)
    latitude, longitude, height = ground.frame.reverse(points)
    assert latitude == pytest.approx([38.8301, 38.8555], abs=1e-9)
    row, column = ground.indices(latitude, longitude)
    assert height == pytest.approx(ground.height(row, column) + 12.0, abs=1e-6)
    assert ground.up(points[:, 0], points[:, 1]) == pytest.approx(points[:, 2] - 12.0, abs=0.05)


def test_level_ground_without_fuel_is_a_lake(near_settings, run_folder, tmp_path):
    folder = tmp_path / "lake"
    shutil.copytree(run_folder, folder)
    lake = np.zeros(np.load(folder / "fuel_elevation.npy").shape, bool)
    lake[70:90, 30:60] = True
    for name, value in {"fuel_elevation": 1380.0, "canopy_fuel": 0.0, "surface_fuel": 0.0}.items():
        field = np.load(folder / f"{name}.npy")
        field[lake] = value
        np.save(folder / f"{name}.npy", field)
    ground = Shot(near_settings, runs.open(folder)).ground
    margin = ground.fields.margin
    found = ground.water[margin:-margin, margin:-margin] == 1.0
    assert np.array_equal(found, lake)  # and not the bare rock, which slopes
    row, column = np.meshgrid(np.linspace(72, 87, 40), np.linspace(32, 57, 40), indexing="ij")
    assert ground.height(row + margin, column + margin, 1.0) == pytest.approx(1380.0, abs=1e-9)


@pytest.fixture(params=["one row", "one column", "one cell", "one cell of many"])
def narrow(request, run_folder, tmp_path):
    """The run cut to a fuel grid that is one cell wide or high (or both), and the size of its cells (m)."""
    folder = tmp_path / "narrow"
    shutil.copytree(run_folder, folder)
    fine, coarse = slice(40, 80), slice(8, 16)
    one, few = (slice(60, 61), slice(12, 13)), (fine, coarse)
    rows, columns = {"one row": (one, few), "one column": (few, one)}.get(request.param, (one, one))
    model = (coarse, coarse) if request.param == "one cell of many" else (rows[1], columns[1])
    for path in folder.glob("*.npy"):
        field = np.load(path)
        parts = (rows[0], columns[0]) if "fuel" in path.stem else model
        axis = {"latitude": parts[:1], "longitude": parts[1:]}.get(path.stem.removeprefix("fuel_"))
        np.save(path, field[(..., *(axis or parts))])
    size = {"one cell": 100.0, "one cell of many": 370.0}.get(request.param, 74.0)
    return runs.open(folder), size


def test_a_grid_one_cell_wide_is_drawn_one_cell_wide(narrow, near_settings, stage, plain_looks):
    run, size = narrow
    for apron in (0.0, 20_000.0):
        shot = Shot(replace(near_settings, terrain=replace(near_settings.terrain, apron=apron)), run)
        ground = shot.ground
        assert min(ground.cell) == pytest.approx(size, rel=0.05)
        assert max(ground.cell) == pytest.approx(size, rel=0.05)
        mesh = ground_build.build(shot, stage, None).data
        places = _vertices(mesh)
        assert np.isfinite(places).all()
        wide = np.ptp(places[:, :2], axis=0)
        cells = np.maximum(np.array(run.surface_fuel.shape[::-1]) - 1, 1)
        expected = cells * np.array(ground.cell[::-1]) if apron == 0.0 else 2.0 * apron
        assert wide == pytest.approx(expected, rel=0.1)
        assert np.isin(_pixels("canopy_fuel"), run.canopy_fuel).any()


def test_a_cell_of_a_grid_one_cell_wide_has_an_area(narrow):
    run, size = narrow
    assert burning.cell_area(run) == pytest.approx(size**2, rel=0.05)
    assert burning.model_cell_area(run) > 0.0
    assert Fire(run, -1e9, 1e9).sources(0.0).power.sum() >= 0.0
