import shutil
from dataclasses import replace

import numpy as np
import pytest
from firetwin.run import frame
from firetwin.scene import build
from firetwin.scene.ground import build as ground_build
from firetwin.scene.ground import grid_mesh
from firetwin.shot import burning
from firetwin.shot.fire import Fire
from firetwin.shot.shot import Shot
from firetwin_core import run as runs


def _values(mesh, name):
    found = np.empty(len(mesh.vertices), np.float32)
    mesh.attributes[name].data.foreach_get("value", found)
    return found


def _vertices(mesh):
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def _polygons(mesh: grid_mesh.GridMesh):
    return np.split(mesh.loops, mesh.starts[1:])


@pytest.fixture
def plain(shot, stage):
    return shot.ground, ground_build.build(shot, stage, None).data


def test_vertices_are_the_local_frame_of_the_fuel_grid(plain, run):
    _ground, mesh = plain
    wanted = frame.local_frame(run).forward_grid(run.fuel_latitude, run.fuel_longitude, run.fuel_elevation)
    found = _vertices(mesh).astype(np.float64)
    order = {tuple(np.round(point[:2]).astype(int)): point for point in found}
    assert len(order) == len(found)
    for point in wanted[::7, ::7].reshape(-1, 3):
        match = order[tuple(np.round(point[:2].astype(np.float32)).astype(int))]
        assert match == pytest.approx(point, abs=2e-3)


def test_attributes_carry_the_runs_fields(plain, run):
    ground, mesh = plain
    margin, columns = ground.fields.margin, ground.shape[1]
    inside = slice(margin, margin + 120)

    def grid(name):
        return _values(mesh, name).reshape(-1, columns)[inside, inside]

    assert grid("canopy_fuel") == pytest.approx(run.canopy_fuel, abs=1e-5)
    assert grid("surface_fuel") == pytest.approx(run.surface_fuel, abs=1e-5)
    assert grid("elevation") == pytest.approx(run.fuel_elevation, abs=1e-3)
    arrival, known = grid("arrival_time"), run.fuel_arrival_time()
    never = np.isnan(known)
    assert np.all(arrival[never] == np.float32(1e9))
    burned = arrival < 1e9  # all but the islands that the fire is said to have spared
    assert arrival[burned] == pytest.approx(known[burned], abs=0.1)
    assert burned.sum() > 0.8 * (~never).sum()


def test_the_apron_reaches_its_width_and_continues_the_edge(plain, settings):
    ground, mesh = plain
    places = _vertices(mesh)
    assert np.abs(places[:, :2]).max() == pytest.approx(settings.ground.apron, rel=0.05)
    height, margin = ground.fields.elevation, ground.fields.margin
    for k in range(4):
        step = np.abs(np.diff(np.rot90(height, k), axis=0))
        assert step[margin - 1, margin:-margin].max() < 3.0 * step[margin:-margin].max()


def test_graded_mesh_is_closed_and_covers_the_grid_once():
    level = np.random.default_rng(0).integers(0, 4, (6, 7))
    mesh = grid_mesh.graded(level)
    edges, area = set(), 0.0
    for ring in _polygons(mesh):
        x, y = mesh.column[ring], mesh.row[ring]
        size = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
        assert size > 0.0
        area += size
        for edge in zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True):
            assert edge not in edges
            edges.add(edge)
    assert area == pytest.approx(42.0)
    rim = [a for a, b in edges if (b, a) not in edges]
    assert all(mesh.row[a] in (0, 6) or mesh.column[a] in (0, 7) for a in rim)
    assert len(mesh.starts) > np.sum(4**level) - 1


def test_near_ground_is_finer_and_is_where_the_ground_says(near_settings, run, stage):
    (camera,) = near_settings.cameras
    keys = tuple(replace(key, height=60.0) for key in camera.rig.keys)
    camera = replace(camera, rig=replace(camera.rig, keys=keys))
    near_shot = Shot(replace(near_settings, cameras=(camera,)), run)
    ground, mesh = near_shot.ground, ground_build.build(near_shot, stage, None).data
    places, detail = _vertices(mesh).astype(np.float64), _values(mesh, "detail")
    near = np.flatnonzero(detail > 0.99)
    assert len(near) > 1000
    some = near[:: max(len(near) // 200, 1)]
    assert ground.up(places[some, 0], places[some, 1]) == pytest.approx(places[some, 2], abs=0.02)
    lengths = [edge.vertices[:] for edge in mesh.edges if detail[edge.vertices[0]] > 0.99]
    gaps = np.linalg.norm(places[[a for a, b in lengths], :2] - places[[b for a, b in lengths], :2], axis=1)
    assert gaps.min() < near_shot.settings.ground.near_spacing


def test_ground_between_places_is_the_cores_bilinear_height(shot):
    ground = shot.ground
    points = ground.point([38.8301, 38.8555], [-120.5512, -120.5333], 12.0)
    latitude, longitude, height = ground.frame.reverse(points)
    assert latitude == pytest.approx([38.8301, 38.8555], abs=1e-9)
    row, column = ground.indices(latitude, longitude)
    assert height == pytest.approx(ground.height(row, column) + 12.0, abs=1e-6)
    assert ground.up(points[:, 0], points[:, 1]) == pytest.approx(points[:, 2] - 12.0, abs=0.05)


def test_embers_glow_only_where_the_scene_file_wants_them(settings, run, stage, scene, shoot):
    no_flames = replace(settings, fire=replace(settings.fire, flames=False))
    pictures = []
    for embers in (True, False):
        built = build.build(Shot(replace(no_flames, fire=replace(no_flames.fire, embers=embers)), run), scene)
        built.frame_set(2)
        built.render.resolution_x, built.render.resolution_y = 320, 180
        pictures.append(shoot(built, "rgb"))
    assert np.all(pictures[0] >= pictures[1] - 1e-4)
    assert np.max(pictures[0] - pictures[1]) > 0.05


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


def test_a_grid_one_cell_wide_is_drawn_one_cell_wide(narrow, near_settings, stage):
    run, size = narrow
    for apron in (0.0, 20_000.0):
        shot = Shot(replace(near_settings, ground=replace(near_settings.ground, apron=apron)), run)
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
        assert np.isin(_values(mesh, "surface_fuel"), run.surface_fuel).any()


def test_a_cell_of_a_grid_one_cell_wide_has_an_area(narrow):
    run, size = narrow
    assert burning.cell_area(run) == pytest.approx(size**2, rel=0.05)
    assert burning.model_cell_area(run) > 0.0
    assert Fire(run, -1e9, 1e9).sources(0.0).power.sum() >= 0.0
