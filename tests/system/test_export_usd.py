"""The command `firetwin export --to usd`: files of a stage with smoke, and nothing after a failure."""

import os
from pathlib import Path

import bpy
from farm_film import firetwin

bpy.utils.expose_bundled_modules()

from pxr import Usd, UsdUtils, UsdVol  # noqa: E402

SCENE = """\
run = "{run}"
[time]
start = 2014-09-17T21:30:00Z
end = 2014-09-17T21:30:20Z
frames = 3
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
density = "paper"
[smoke]
method = "flow"
cell_budget = 0.1
spin_up = 120.0
voxel_size = 150.0
[[cameras]]
name = "drone"
keys = [{{ latitude = 38.825, longitude = -120.56, height = 400.0, target = "head" }}]
"""


def warm(path):
    """Return the lowest and the highest temperature (K) of a volume."""
    import openvdb

    return openvdb.read(path, "temperature").evalMinMax()


def test_the_command_writes_a_stage_with_its_smoke_or_nothing(run_folder, tmp_path):
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(SCENE.format(run=run_folder.as_posix()))
    firetwin("export", scene, "--to", "usd", "--out", scene / "usd", status=1)
    assert os.listdir(tmp_path) == ["scene.toml"]
    printed = firetwin("export", scene, "--to", "usd", "--frames", "1-3:2", "--out", out)
    assert [Path(line).name for line in printed.splitlines()] == ["scene.usda", "georeference.json"]
    layers, files, missing = UsdUtils.ComputeAllDependencies(str(out / "scene.usda"))
    assert missing == []
    assert {Path(layer.realPath).name for layer in layers} >= {"scene.usda", "smoke.usdc", "forest.usdc"}
    names = {Path(file).name for file in files}
    assert names >= {"smoke_000001.vdb", "temperature_smoke_000003.vdb", "flame.png"}
    stage = Usd.Stage.Open(str(out / "scene.usda"))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1.0, 3.0)
    asset = UsdVol.OpenVDBAsset(stage.GetPrimAtPath("/World/Smoke/Smoke/temperature"))
    assert asset.GetFilePathAttr().GetTimeSamples() == [1.0, 3.0]
    low, high = warm(asset.GetFilePathAttr().Get(3.0).resolvedPath)
    assert 250.0 < low < high < 1500.0
    assert "temperature" in (out / "smoke" / "README.txt").read_text()
    assert sorted(each for each in os.listdir(tmp_path) if each.endswith(".part")) == []
