"""USD stages, read again by pxr: positions in Earth-centred metres, tree numbers, materials and volumes."""

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import mathutils
import numpy as np
import pytest
from firetwin.errors import Error
from firetwin.export import read_scene, scene_job, usd
from firetwin.export.places import STATION, Place
from firetwin.export.request import ExportRequest
from firetwin.export.scene_content import SmokeLayer
from firetwin.jobs import worker_scene
from firetwin.progress import no_message, silent
from firetwin.scene import build
from firetwin.shot.shot import Shot
from firetwin_core import volume

bpy.utils.expose_bundled_modules()

from firetwin.export import usd_places  # noqa: E402
from pxr import Gf, Tf, Usd, UsdGeom, UsdShade, UsdUtils, UsdValidation, UsdVol  # noqa: E402

FRAMES = (1, 2, 3)
CORNER = (900.0, -400.0, 2100.0)  # m, centre of the first voxel
VOXEL = 50.0
WITHIN = 0.01  # m


@dataclass
class Blenders:
    """The scene as Blender evaluates it: transforms of trees, their numbers, and a camera at frame 2."""

    trees: np.ndarray
    numbers: np.ndarray
    camera: np.ndarray
    lens: float
    angle: float


_made = {}


@pytest.fixture
def exported(settings, run, stage, tmp_path_factory):
    """A small scene, its content, its place, the folder of its USD stage with one voxel, and `Blenders`."""
    if not _made:
        out = tmp_path_factory.mktemp("usd")
        _made[0] = export(settings, run, stage, out)
    return _made[0]


def export(settings, run, stage, out):
    camera = replace(settings.cameras[0], name="Übersicht 1/2")
    shot = Shot(replace(settings, cameras=(camera, replace(camera, name="Übersicht 1.2"))), run)
    build.build(shot, stage.scene, ("terrain", "forest", "fire", "cameras"))
    file = out.with_name(f"{out.name}_cache") / "smoke_000002.vdb"
    file.parent.mkdir()
    write_voxel(file)
    content = read_scene.read(shot, stage, FRAMES, [SmokeLayer("smoke", {2: file})])
    request = ExportRequest(SimpleNamespace(shot=lambda: shot), "usd", out, geoid_m=-24.9)
    made = usd.write_content(content, request)
    assert made == [out / "scene.usda"]
    graph = bpy.context.evaluated_depsgraph_get()
    trees = [
        np.array(each.matrix_world)
        for each in graph.object_instances
        if each.is_instance and each.parent.original.name == "Firetwin Trees"
    ]
    planted = stage.objects_of("Forest")[0].data.attributes["number"].data
    bpy.context.scene.frame_set(2)
    camera = stage.camera("Übersicht 1/2")
    shown = Blenders(
        np.array(trees),
        np.array([each.value for each in planted]),
        np.array(camera.matrix_world),
        camera.data.lens,
        camera.data.angle_x,
    )
    return content, request.georeference, out, shown


def write_voxel(file):
    """Write a volume with one dense voxel, of a known place."""
    density = np.zeros((9, 9, 9), np.float32)
    density[3, 5, 7] = 0.02
    volume.write(file, {"density": density}, VOXEL, CORNER)


def earth(place, prim):
    """Return the Earth-centred position (3,) of a prim's origin at frame 2."""
    matrix = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(2.0)
    return place.ecef(np.array(matrix.ExtractTranslation()))[0]


def find(out, path):
    """Return a prim of the stage, which stays open with it."""
    opened = Usd.Stage.Open(str(out / "scene.usda"))
    return opened, opened.GetPrimAtPath(path)


def test_a_tree_is_where_blender_instances_it_with_its_number_in_the_masks(exported):
    _, place, out, ours = exported
    drawn = ours.trees
    stage, prim = find(out, "/World/Forest/Trees")
    trees = UsdGeom.PointInstancer(prim)
    made = np.array([np.array(each).T for each in trees.ComputeInstanceTransformsAtTime(1.0, 1.0)])
    assert made.shape == drawn.shape
    # Prototypes have no transform. Half quaternions turn a model by up to a thousandth.
    np.testing.assert_allclose(made[:, :3, :3], drawn[:, :3, :3], atol=0.03)
    apart = place.ecef(made[:, :3, 3]) - place.ecef(drawn[:, :3, 3])
    assert np.linalg.norm(apart, axis=1).max() < WITHIN
    numbers = ours.numbers
    np.testing.assert_array_equal(trees.GetIdsAttr().Get(), numbers)
    assert numbers.min() >= 1
    assert numbers.max() < 2**24
    assert stage.GetDefaultPrim().GetPath() == "/World"


def test_crowns_burn_and_then_turn_into_snags_at_a_few_frames(exported):
    content, _, out, _ = exported
    _stage, prim = find(out, "/World/Forest/Trees")
    trees = UsdGeom.PointInstancer(prim)
    names = [path.name for path in trees.GetPrototypesRel().GetTargets()]
    assert trees.GetProtoIndicesAttr().GetTimeSamples() == [1.0, 2.0, 3.0]
    plants = content.plants[0]
    for frame, time in zip(FRAMES, content.times, strict=True):
        snags = np.array(["snag" in names[k] for k in trees.GetProtoIndicesAttr().Get(frame)])
        burned = plants.arrival + 300.0 <= time
        np.testing.assert_array_equal(snags, burned & (plants.torched > 0.0))
        alight = [names[k].endswith("_burning") for k in trees.GetProtoIndicesAttr().Get(frame)]
        recent = (plants.arrival <= time) & (time < plants.arrival + 300.0)
        np.testing.assert_array_equal(alight, recent & (plants.torched > 0.0))
        assert frame == 3 or any(alight)
    assert snags.any()
    kinds = UsdGeom.PrimvarsAPI(prim).GetPrimvar("class").ComputeFlattened()
    assert set(kinds) <= {"large", "medium", "small"}
    np.testing.assert_allclose(
        UsdGeom.PrimvarsAPI(prim).GetPrimvar("height").Get(), [s[2] for s in trees.GetScalesAttr().Get()]
    )


def test_a_camera_is_blenders_camera(exported):
    _, place, out, ours = exported
    _stage, prim = find(out, "/World/Cameras/_bersicht_1_2")
    assert prim.GetDisplayName() == "Übersicht 1/2"
    assert np.linalg.norm(earth(place, prim) - place.ecef(ours.camera[:3, 3])[0]) < WITHIN
    camera = UsdGeom.Camera(prim)
    seen = camera.GetCamera(2.0)
    assert seen.GetFieldOfView(Gf.Camera.FOVHorizontal) == pytest.approx(np.degrees(ours.angle), rel=1e-4)
    # A tenth of a unit, which is a metre: 100 mm are 1.
    assert camera.GetFocalLengthAttr().Get(2.0) == pytest.approx(ours.lens / 100.0)
    turn = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(2.0))[:3, :3].T
    np.testing.assert_allclose(turn, ours.camera[:3, :3], atol=1e-4)


def test_a_voxel_is_where_the_smoke_was_written(exported):
    import openvdb

    _, place, out, _ = exported
    stage, prim = find(out, "/World/Smoke/Smoke")
    (target,) = UsdVol.Volume(prim).GetFieldPaths().values()
    asset = UsdVol.OpenVDBAsset(stage.GetPrimAtPath(target))
    grid = openvdb.read(asset.GetFilePathAttr().Get(2.0).resolvedPath, asset.GetFieldNameAttr().Get())
    (voxel,) = [each for each in grid.citerOnValues() if each.value > 0.0]
    assert voxel.value == pytest.approx(0.02, rel=1e-3)
    at = np.array(grid.transform.indexToWorld(voxel.min))
    wanted = np.array(CORNER) + VOXEL * np.array((3, 5, 7))
    assert np.linalg.norm(place.ecef(at)[0] - place.ecef(wanted)[0]) < WITHIN
    low, high = UsdGeom.Boundable(prim).GetExtentAttr().Get(2.0)
    assert (np.array(low) < at).all()
    assert (np.array(high) > at).all()
    assert "extinction" in (out / "smoke" / "README.txt").read_text()


@pytest.mark.posix("definitions of shaders in the USD of Blender's module")
def test_no_validator_finds_an_error(exported):
    _, _, out, _ = exported
    stage = Usd.Stage.Open(str(out / "scene.usda"))
    every = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(every) > 15
    assert [error.GetMessage() for error in UsdValidation.ValidationContext(every).Validate(stage)] == []
    assert not UsdUtils.ComputeAllDependencies(str(out / "scene.usda"))[2]  # unresolved files
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Z"
    assert stage.GetRootLayer().customLayerData["firetwin"]["synthetic"] is True
    assert {Path(layer).stem for layer in stage.GetRootLayer().subLayerPaths} == {
        *("terrain", "forest", "fire", "smoke", "cameras", "stations")
    }


def test_the_place_on_the_earth_is_there_in_three_forms(exported):
    _, place, out, _ = exported
    stage = Usd.Stage.Open(str(out / "scene.usda"))
    cesium, world = stage.GetPrimAtPath("/CesiumGeoreference"), stage.GetDefaultPrim()
    origin = [
        cesium.GetAttribute(f"cesium:georeferenceOrigin:{name}").Get()
        for name in ("latitude", "longitude", "height")
    ]
    assert origin == [place.latitude, place.longitude, place.height]
    reference = world.GetAttribute("omni:geospatial:wgs84:reference:referencePosition")
    assert list(reference.Get()) == origin
    (target,) = world.GetRelationship("crs:binding").GetTargets()
    assert stage.GetPrimAtPath(target).GetAttribute("crs:wkt").Get() == place.wkt


def test_a_distant_place_is_at_its_own_latitude_and_longitude(settings, run, tmp_path):
    shot = Shot(settings, run)
    frame = shot.local_frame
    town = Place("Town", STATION, "town", frame.latitude + 0.2, frame.longitude - 0.2)
    layer = usd_places.write(SimpleNamespace(rate=24.0), tmp_path, shot, [town])
    stage = Usd.Stage.Open(str(layer))
    at = UsdGeom.Xformable(stage.GetPrimAtPath("/World/Stations/Town")).GetLocalTransformation()
    latitude, longitude, height = frame.reverse(np.array([at.ExtractTranslation()]))
    np.testing.assert_allclose((latitude[0], longitude[0]), (town.latitude, town.longitude), atol=1e-8)
    assert height[0] == pytest.approx(shot.ground.height(*shot.ground.indices(latitude, longitude))[0])


def test_distant_trees_of_an_export_have_their_true_width(near_settings, run, tmp_path, monkeypatch):
    shot = Shot(replace(near_settings, forest=replace(near_settings.forest, budget=1000)), run)
    built = []
    monkeypatch.setattr(worker_scene, "build_scene", lambda *arguments: built.append(arguments[-1]))
    monkeypatch.setattr(read_scene, "read", lambda *_: None)
    monkeypatch.setattr(usd, "write_content", lambda *_: [])
    request = ExportRequest(SimpleNamespace(shot=lambda: shot), "usd", tmp_path, smoke=False)
    scene_job.in_blender(request, silent, no_message)
    assert len(built[0].width) > 100
    assert (built[0].width == 1.0).all()


def test_each_mesh_has_a_material_of_both_kinds(exported):
    _, _, out, _ = exported
    stage = Usd.Stage.Open(str(out / "scene.usda"))
    count = 0
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if prim.GetTypeName() != "Mesh":
            continue
        subsets = UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets()
        for part in [subset.GetPrim() for subset in subsets] or [prim]:
            material, _ = UsdShade.MaterialBindingAPI(part).ComputeBoundMaterial()
            assert material, part.GetPath()
            assert material.ComputeSurfaceSource()[0].GetShaderId() == "UsdPreviewSurface"
            mtlx = material.ComputeSurfaceSource("mtlx")[0]
            assert mtlx.GetShaderId() == "ND_standard_surface_surfaceshader"
            count += 1
    assert count > 5


def test_lit_flames_have_velocity_and_temperature(exported):
    content, _, out, _ = exported
    _stage, prim = find(out, "/World/Fire/Flames")
    flames = UsdGeom.PointInstancer(prim)
    lit = content.flames.lit(content.times[1])
    np.testing.assert_array_equal(flames.GetIdsAttr().Get(2.0), lit)
    assert len(lit) == len(flames.GetPositionsAttr().Get(2.0)) > 0
    speed = np.linalg.norm(np.array(flames.GetVelocitiesAttr().Get(2.0)), axis=1)
    np.testing.assert_allclose(speed, 9.0, rtol=1e-5)
    kelvin = np.array(UsdGeom.PrimvarsAPI(prim).GetPrimvar("temperature").Get(2.0))
    assert (kelvin > 800.0).all()


def test_hostile_names_become_different_identifiers():
    from firetwin.export.usd_library import Identifiers

    names = Identifiers()
    made = [names.make(name) for name in ("a b", "a_b", "", "", "9", "火", "x" * 500, '"}{/..', "a b")]
    assert len(set(made)) == len(made)
    assert all(Tf.IsValidIdentifier(name) and name.isascii() for name in made)


def test_turns_are_those_of_blender():
    turns = np.random.default_rng(3).uniform(-3.0, 3.0, (3, 20))
    for made, turn in zip(read_scene.euler_quaternions(*turns), turns.T, strict=True):
        expected = mathutils.Euler(turn).to_quaternion()
        assert abs(expected.dot(mathutils.Quaternion(made))) == pytest.approx(1.0, abs=1e-6)


def test_a_blender_without_a_usd_library_is_an_error(monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr.UsdGeom", None)
    with pytest.raises(Error, match=r"no USD library.*install"):
        usd.check_blender()
