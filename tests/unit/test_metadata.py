"""Metadata of the project: one version, one licence, one title."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_one_version():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    manifest = tomllib.loads((ROOT / "addon/blender_manifest.toml").read_text())
    assert manifest["version"] == version
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"\n## {version} - " in (ROOT / "CHANGELOG.md").read_text()


def test_licence_text_is_where_people_and_reuse_expect_it():
    assert (ROOT / "LICENSE").read_bytes() == (ROOT / "LICENSES/GPL-3.0-or-later.txt").read_bytes()
