"""Which tests tests/quick.sh runs after a change."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests"))

import touched  # noqa: E402


def near(changed):
    every = {test: touched.distance(test, ROOT / changed) for test in touched.tests()}
    return {
        test.relative_to(ROOT / "tests").as_posix(): far for test, far in every.items() if far is not None
    }


@pytest.mark.parametrize(
    ("changed", "test", "distance"),
    [
        ("tests/unit/run/test_geo.py", "unit/run/test_geo.py", 0),
        ("addon/render/store.py", "unit/render/test_store.py", 1),
        ("addon/smoke/domains.py", "blender/smoke/test_smoke_flow.py", 2),
        ("addon/shot/cameras/track_csv.py", "unit/cameras/test_track.py", 3),  # by the module that imports it
        ("tests/helpers/plumes.py", "unit/smoke/test_volume_dense.py", 1),
        ("tests/helpers/small_run.py", "unit/terrain/test_elevation.py", 1),
        ("tests/unit/conftest.py", "unit/run/test_geo.py", 3),
        ("cpp/flow/solver.cpp", "unit/smoke/test_flow.py", 2),
        ("cpp/base/noise.hpp", "unit/terrain/test_terrain.py", 2),  # terrain includes it
        ("cpp/bindings/flow_detail.cpp", "unit/smoke/test_flow_detail.py", 1),
        ("examples/king_fire.toml", "unit/settings/test_scene_file.py", 1),
    ],
)
def test_what_is_near(changed, test, distance):
    assert near(changed)[test] == distance


def test_what_is_far_is_left_out():
    assert "unit/run/test_geo.py" not in near("addon/smoke/domains.py")
    assert near("vcpkg" + ".json") == {}


def test_most_modules_have_a_test_of_their_name_or_one_that_imports_them():
    modules = [path for path in (ROOT / "addon").rglob("*.py") if path.name != "__init__.py"]
    alone = [
        path for path in modules if all(touched.distance(test, path) is None for test in touched.tests())
    ]
    assert [path.name for path in alone] == ["__main__.py"]


def test_what_takes_too_long_is_left_out_and_said(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(touched, "SECONDS", tmp_path / "seconds.json")
    monkeypatch.setattr(touched, "MOST", 11.0)
    changed = ROOT / "addon/smoke/domains.py"
    assert len(list(touched.nearest([changed]))) == 2  # of 5 s, which nobody has measured
    assert "more test files are near" in capsys.readouterr().err
    test = ROOT / "tests/unit/run/test_geo.py"
    monkeypatch.setattr(touched, "MOST", 0.0)
    assert list(touched.nearest([test])) == [test]  # changed itself: always
