"""Cameras of USD stages and Alembic files: exported poses come back to 1 cm and 0.01 degrees."""

import pickle
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from firetwin import cli
from firetwin.blender import compat
from firetwin.camera_import import alembic, usd
from firetwin.errors import Error, InputError
from firetwin.export import alembic as exported
from firetwin.geometry import quaternion
from firetwin.jobs import worker
from firetwin.limits import CAMERA_FRAMES
from firetwin.progress import silent
from firetwin.shot.settings import scene_file
from firetwin.shot.source import ShotSource

FRAMES = 12
needs_alembic = pytest.mark.skipif(not bpy.app.build_options.alembic, reason="needs Blender with Alembic")


@pytest.fixture(autouse=True)
def same_process(monkeypatch):
    """Jobs run in this process; their arguments and results are pickled, as in a worker."""

    def run(work, *_, **__):
        made = pickle.loads(pickle.dumps(work))(progress=silent, tell=print)
        return pickle.loads(pickle.dumps(made))

    monkeypatch.setattr(worker, "run", run)


@pytest.fixture
def path(settings):
    """A scene file whose drone zooms out, banks, and has another sensor."""
    (drone,) = settings.cameras
    rig = replace(drone.rig, bank=1.0, focal_length=21.0, sensor_width=13.2)
    flown = replace(
        settings,
        cameras=(replace(drone, rig=rig),),
        time=replace(settings.time, frames=FRAMES, fps=23.976),
        tiles=replace(settings.tiles, geoid=-24.5),
    )
    flown.path.write_text(scene_file.text(flown))
    return flown.path


def shot(path):
    return ShotSource(str(path)).shot()


def imported(path, file, *options):
    assert cli.main(["import", str(file), "--out", str(path), "--name", "again", *options]) == 0
    return shot(path)


def check(made, shift=(0.0, 0.0, 0.0)):
    """Check that the imported path is the drone's, moved by `shift`."""
    one, two = made.paths
    assert np.linalg.norm(one.position + shift - two.position, axis=1).max() < 0.01
    turn = np.einsum("nij,nik->njk", one.rotation, two.rotation)
    assert np.degrees(np.abs(quaternion.quaternions(turn)[:, 1:]).max() * 2.0) < 0.01
    assert two.halves == pytest.approx(one.halves, rel=2e-4)
    assert two.sensor == pytest.approx(one.sensor, rel=1e-6)


def test_a_blender_without_alembic_says_so(monkeypatch):
    without = SimpleNamespace(app=SimpleNamespace(build_options=SimpleNamespace(alembic=False)))
    monkeypatch.setattr(compat, "bpy", without)
    for job in (alembic.in_blender, exported.in_blender):
        with pytest.raises(Error, match="this Blender has no Alembic"):
            job(*[None] * (job.__code__.co_argcount - 2), progress=silent, tell=print)


@needs_alembic
def test_an_alembic_file_comes_back(path, tmp_path):
    assert cli.main(["export", str(path), "--to", "alembic", "--out", str(tmp_path / "out")]) == 0
    check(imported(path, tmp_path / "out/cameras.abc"))
    made = shot(path).settings.cameras
    assert [each.name for each in made] == ["drone", "again"]
    assert len(made[1].rig.keys) <= FRAMES


STAGE = """\
#usda 1.0
(
    metersPerUnit = {unit}
    upAxis = "{axis}"
    timeCodesPerSecond = {rate}
    startTimeCode = 1
    endTimeCode = {last}
)
{place}
def Xform "Set"
{{
    def Camera "shotCam" (displayName = "Layout")
    {{
        float horizontalAperture = {aperture}
        float focalLength = {focal}
        matrix4d xformOp:transform.timeSamples = {{ {samples} }}
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }}
    def Camera "top"
    {{
        token projection = "orthographic"
    }}
}}
"""
PLACE = """\
def CesiumGeoreferencePrim "CesiumGeoreference"
{{
    double cesium:georeferenceOrigin:latitude = {}
    double cesium:georeferenceOrigin:longitude = {}
    double cesium:georeferenceOrigin:height = {}
}}
"""


def stage(shot, unit=1.0, axis="Z", place="", rate=24000 / 1001, to_stage=None):
    """Write a stage with the path of the drone, in this unit and with this axis up."""
    view = shot.paths[0]
    poses = np.tile(np.eye(4), (FRAMES, 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = view.rotation, view.position
    poses = (np.eye(4) if to_stage is None else to_stage) @ poses
    if axis == "Y":
        poses = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]) @ poses
    poses[:, :3, 3] /= unit
    poses[:, :3, :3] *= 3.0  # a scaled camera
    samples = ", ".join(
        f"{frame}: ({', '.join(str(tuple(row)) for row in pose.T.tolist())})"
        for frame, pose in enumerate(poses, 1)
    )
    tenths = 0.01 / unit  # of a unit in a mm
    return STAGE.format(
        unit=unit, axis=axis, place=place, rate=rate, last=FRAMES, samples=samples,
        aperture=13.2 * tenths, focal=13.2 * tenths / (2.0 * view.halves[0, 0]),
    )  # fmt: skip


@pytest.mark.parametrize(("unit", "axis"), [(1.0, "Z"), (0.01, "Y")])
def test_a_stage_without_a_place_has_the_axes_of_the_scene(path, tmp_path, capsys, unit, axis):
    (tmp_path / "move.usda").write_text(stage(shot(path), unit, axis))
    check(imported(path, tmp_path / "move.usda"))
    told = capsys.readouterr().err
    assert "omitted cameras that are not perspective: top" in told
    assert "is not georeferenced" in told


def test_a_stage_elsewhere_on_the_earth_is_placed(path, tmp_path):
    """A stage whose origin is 8 km away and 100 m lower, from which east, north and up are turned."""
    from firetwin.camera_import import placing

    here = shot(path)
    frame = here.local_frame
    origin = (frame.latitude + 0.05, frame.longitude - 0.08, frame.height - 100.0 - 24.5)
    to_stage = np.linalg.inv(placing.scene_from(here, origin, -24.5))
    assert np.linalg.norm(to_stage[:2, 3]) > 8000.0
    (tmp_path / "move.usda").write_text(stage(here, place=PLACE.format(*origin), to_stage=to_stage))
    check(imported(path, tmp_path / "move.usda"))


def test_the_time_codes_of_another_rate(path, tmp_path):
    """Frame 12 of a stage with twice the rate is frame 6 of the film."""
    (tmp_path / "move.usda").write_text(stage(shot(path), rate=48000 / 1001))
    one, two = imported(path, tmp_path / "move.usda").paths
    assert two.position[[0, 5]] == pytest.approx(one.position[[1, 11]], abs=0.01)
    assert two.position[6:] == pytest.approx(np.tile(one.position[11], (6, 1)), abs=0.01)


@needs_alembic
def test_damaged_files_are_explained(tmp_path):
    for name, text, read in (
        ("a.usda", "#usda 1.0\ndef (", usd.in_blender),
        ("a.usdc", "PXR-USDC" + "x" * 100, usd.in_blender),
        ("b.usda", "#usda 1.0\n(metersPerUnit = 0)", usd.in_blender),
        ("c.usda", '#usda 1.0\ndef Camera "a" {\nfloat focalLength = 0\n}', usd.in_blender),
        ("a.abc", "no archive", alembic.in_blender),
    ):
        (tmp_path / name).write_text(text)
        options = {"rate": (24, 1)} if name.endswith("abc") else {}
        with pytest.raises(InputError, match=name.replace(".", r"\.")):
            read(tmp_path / name, progress=silent, tell=print, **options)


def test_a_move_has_a_largest_number_of_frames(tmp_path):
    last = CAMERA_FRAMES + 2
    text = f'#usda 1.0\ndef Camera "a" {{\nfloat focalLength.timeSamples = {{ 1: 1, {last}: 2 }}\n}}'
    (tmp_path / "long.usda").write_text(text)
    with pytest.raises(InputError, match="more than 100,000 frames"):
        usd.in_blender(tmp_path / "long.usda", progress=silent, tell=print)
