"""A small run, its settings and shot, and a clean Blender for every test that needs one."""

from __future__ import annotations

import functools
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

import firetwin  # noqa: E402
from firetwin.blender import compat, nodes, owned  # noqa: E402
from firetwin.render import layers  # noqa: E402
from firetwin.run import opening as runs  # noqa: E402
from firetwin.scene import build, haze  # noqa: E402
from firetwin.scene.fire import firebrand_material  # noqa: E402
from firetwin.scene.fire import material as flame_material  # noqa: E402
from firetwin.scene.forest import material as tree_material  # noqa: E402
from firetwin.scene.forest import preview  # noqa: E402
from firetwin.scene.terrain import material as ground_material  # noqa: E402
from firetwin.shot import sections  # noqa: E402
from firetwin.shot import settings as scene_settings  # noqa: E402
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone  # noqa: E402
from firetwin.shot.fire.smoke_scale import Scale  # noqa: E402
from firetwin.shot.shot import Shot  # noqa: E402
from firetwin.smoke import domains  # noqa: E402
from firetwin.smoke.flow import Flow  # noqa: E402
from firetwin_core import sensor  # noqa: E402
from made_once import made_once  # noqa: E402
from scene_text import PANEL  # noqa: E402

__all__ = [
    "built",
    "built_file",
    "factory",
    "few_cells",
    "near_settings",
    "near_shot",
    "panel",
    "plain_ground",
    "plain_looks",
    "plate",
    "run",
    "run_folder",
    "scene",
    "scene_file",
    "settings",
    "shoot",
    "shot",
    "stage",
    "vr_viewer",
    "whole_forest",
]

NY = NX = 24
FINE = 5
LATITUDE, LONGITUDE = (38.80, 38.88), (-120.60, -120.50)


def _axis(low: float, high: float, count: int) -> np.ndarray:
    edges = np.linspace(low, high, count + 1)
    return 0.5 * (edges[1:] + edges[:-1])


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    """A run of 24 x 24 cells of 370 m with fuels on 120 x 120: hills, bare rock, a round fire."""
    return made_once(tmp_path_factory, "run", write_run)


def write_run(folder):
    fy, fx = NY * FINE, NX * FINE
    y, x = np.meshgrid(np.linspace(-1, 1, fy), np.linspace(-1, 1, fx), indexing="ij")
    height = 1400 + 300 * np.sin(3 * x + 1) * np.cos(2 * y) + 60 * np.sin(11 * x) * np.sin(9 * y) + 250 * x
    canopy = np.clip(1.2 + 1.3 * np.sin(5 * x - 2 * y), 0, 2.5)
    surface = np.clip(0.8 + 0.5 * np.cos(4 * y), 0, 3)
    rock = np.hypot(x - 0.6, y + 0.6) < 0.15
    canopy[rock] = surface[rock] = 0.0
    arrival = 7200.0 * np.hypot(x, y) - 600.0
    arrival[np.hypot(x, y) > 0.6] = np.nan
    times = np.arange(11) * 360.0
    flux = np.zeros((len(times), NY, NX), np.float32)
    flux[:, 8:16, 8:16] = 5.0e4
    arrays = {
        "latitude": _axis(*LATITUDE, NY),
        "longitude": _axis(*LONGITUDE, NX),
        "elevation": height.reshape(NY, FINE, NX, FINE).mean((1, 3)),
        "fuel_latitude": _axis(*LATITUDE, fy),
        "fuel_longitude": _axis(*LONGITUDE, fx),
        "fuel_elevation": height,
        "canopy_fuel": canopy,
        "surface_fuel": surface,
        "fuel_arrival_time": arrival,
        "heat_flux": flux,
    }
    for name, array in arrays.items():
        kind = np.float64 if "itude" in name else np.float32
        np.save(folder / f"{name}.npy", array.astype(kind))
    (folder / "run.toml").write_text(
        'name = "Test"\nsynthetic = true\nstart = 2014-09-17T21:00:00Z\ninterval_s = 360.0\n'
        'vertical = "orthometric"\n[units]\nelevation = "m"\nfuel_elevation = "m"\nfuel_arrival_time = "s"\n'
        'heat_flux = "W/m2"\nsurface_fuel = "kg/m2"\ncanopy_fuel = "kg/m2"\n'
    )


@pytest.fixture(scope="session")
def run(run_folder):
    return runs.open(run_folder)


@pytest.fixture
def settings(run_folder, tmp_path):
    return small_settings(run_folder, tmp_path)


def small_settings(run_folder, folder):
    """A drone over the run's centre, three frames over an hour, flat, without a stand, with a small apron."""
    keys = (
        CameraKey(0.0, 38.825, -120.56, 400.0, "point", 38.845, -120.55, 0.0),
        CameraKey(1.0, 38.830, -120.57, 500.0, "point", 38.845, -120.55, 0.0),
    )
    return scene_settings.Settings(
        path=folder / "scene.toml",
        run=run_folder,
        cache=folder / "cache",
        time=sections.Time(
            start=datetime(2014, 9, 17, 21, 0, tzinfo=UTC),
            end=datetime(2014, 9, 17, 22, 0, tzinfo=UTC),
            frames=3,
            shutter=0.0,
        ),
        terrain=sections.TerrainSettings(near_radius=0.0, apron=20_000.0),
        forest=sections.Forest(density="paper"),
        smoke=sections.SmokeSettings(enabled=False),
        cameras=(scene_settings.Camera("drone", Drone(keys=keys)),),
        render=scene_settings.Render(resolution=(64, 36), samples=4, denoise=False),
    )


@pytest.fixture
def near_settings(settings):
    """The settings with a detailed terrain mesh and a stand."""
    return replace(
        settings,
        terrain=replace(settings.terrain, near_radius=1500.0),
        forest=replace(settings.forest, density="stand", budget=3000, draw_distance=1500.0),
    )


@pytest.fixture
def shot(settings, run):
    return Shot(settings, run)


@pytest.fixture
def near_shot(near_settings, run):
    return Shot(near_settings, run)


@pytest.fixture(scope="session")
def factory():
    """Blender's preferences and add-ons reset to factory settings."""
    bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture(autouse=True)
def scene(factory):
    """Blender reset to factory settings, with an empty scene."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene


@pytest.fixture
def stage(scene):
    """The scene, marked as Firetwin's."""
    return owned.adopt(scene)


@pytest.fixture(scope="session")
def built_file(factory, run_folder, run, tmp_path_factory):
    """The small shot built into a scene of Firetwin, with its view layers, as a file."""

    def make(folder):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        stage, settings = owned.adopt(bpy.context.scene), small_settings(run_folder, folder)
        build.build(Shot(settings, run), stage.scene)
        layers.build(settings, stage)
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "built.blend"))

    return made_once(tmp_path_factory, "built", make) / "built.blend"


@pytest.fixture
def built(scene, built_file):
    """Our part of that file's scene; opening it invalidates an earlier `scene`."""
    bpy.ops.wm.open_mainfile(filepath=str(built_file))
    return owned.stage(bpy.context.scene)


def _plain(name, shot, stage, images=None, *_, **__):
    """A material that shows images, if there are any, and white light in haze."""
    material, tree = nodes.material(f"Firetwin {name}")
    for image in (images or {}).values():
        tree.node("ShaderNodeTexImage", image=image)
    tree.surface(haze.apply(tree, tree.emission((1.0, 1.0, 1.0)), stage))
    return material


@pytest.fixture
def plain_ground(monkeypatch):
    """Give the ground a plain material: its nodes take longest to build."""
    _simplify_ground(monkeypatch)


@pytest.fixture
def plain_looks(monkeypatch):
    """Give ground, plants and fire plain materials."""
    simplify_looks(monkeypatch)


def _simplify_ground(patch):
    patch.setattr(ground_material, "build", functools.partial(_plain, "Ground"))


def simplify_looks(patch):
    """Give ground, plants and fire plain materials, for as long as the patch lasts."""
    _simplify_ground(patch)
    for name in ("foliage", "bark", "rock", "grass"):
        patch.setattr(tree_material, name, functools.partial(_plain, name.title()))
    patch.setattr(flame_material, "build", functools.partial(_plain, "Flames"))
    patch.setattr(firebrand_material, "build", functools.partial(_plain, "Firebrands"))


@pytest.fixture
def shoot(tmp_path):
    """Render the scene with Cycles: pixels (height, width, 3), scene-linear; of "thermal" layers kelvin."""

    def render(scene, layer: str | None = None) -> np.ndarray:
        scene.render.engine = "CYCLES"
        compat.march_through_volumes(scene.cycles)
        scene.cycles.use_denoising, scene.cycles.samples = False, 4
        if scene.render.resolution_x > 64:
            scene.render.resolution_x, scene.render.resolution_y = 64, 36
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.render.resolution_percentage = 100
        compat.still_settings(scene.render)
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        if layer is not None and layer not in scene.view_layers:
            scene.view_layers.new(layer)[nodes.THERMAL] = float(layer == "thermal")
        for view_layer in scene.view_layers:
            view_layer.use = layer is None or view_layer.name == layer
        scene.render.use_compositing = False
        scene.render.filepath = str(tmp_path / "shot.exr")
        bpy.ops.render.render(write_still=True)
        pixels = np.asarray(sensor.read_image(tmp_path / "shot.exr"))[..., :3]
        return sensor.PlanckTable().brightness_temperature(pixels) if layer == "thermal" else pixels

    return render


@pytest.fixture
def whole_forest(monkeypatch):
    """Show the full forest in the viewport, as renders draw it, at any size."""
    monkeypatch.setattr(preview, "MOST", 10**9)


@pytest.fixture
def few_cells(monkeypatch):
    """A smoke flow on few, large cells, with a nest that begins late."""
    monkeypatch.setattr(domains, "_LEVELS", (150.0, 600.0, 10))
    monkeypatch.setattr(domains, "_NEST_LEVELS", (120.0, 400.0, 11))
    monkeypatch.setattr(domains, "_NEST", 72)
    monkeypatch.setattr(domains, "_MARGIN", 2000.0)
    monkeypatch.setattr(Flow, "lead", 40.0)
    monkeypatch.setattr(domains, "_height_fraction", lambda shot: 1.0)
    monkeypatch.setattr(Shot, "scale", Scale())


@pytest.fixture
def plate(scene):
    """A plate that fills the view of a camera above it."""
    mesh = bpy.data.meshes.new("plate")
    mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("plate", mesh))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, 0, 5)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.cycles.samples = 1
    return mesh


@pytest.fixture
def panel():
    """The panel of a new file, in Blender's startup state."""
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    yield bpy.context.scene.firetwin
    if hasattr(bpy.types.Scene, "firetwin"):  # a test may have unregistered it
        firetwin.unregister()


@pytest.fixture
def vr_viewer():
    """Blender's own add-on for VR, enabled."""
    bpy.ops.preferences.addon_enable(module="viewport_vr_preview")
    yield
    bpy.ops.preferences.addon_disable(module="viewport_vr_preview")


@pytest.fixture
def scene_file(run_folder, tmp_path):
    """A scene file of the small run for the panel."""
    path = tmp_path / "scene.toml"
    path.write_text(PANEL.format(run=run_folder))
    return path
