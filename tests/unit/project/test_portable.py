"""The scripts that build wheels: keys of prebuilt libraries, and the bill of materials."""

import json
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
from module_file import load_module

ROOT = Path(__file__).resolve().parents[3]
PORTABLE = ROOT / "cpp/portable"


@pytest.fixture(scope="module")
def sbom():
    return load_module(PORTABLE / "sbom.py")


def keys(scripts):
    """Return the key of each library."""
    command = ["bash", scripts / "libraries.sh", scripts / "nowhere", "--keys"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    return dict(line.split() for line in lines)


@pytest.mark.skipif(shutil.which("gcc-12") is None, reason="the keys contain the version of gcc-12")
def test_new_version_rebuilds_a_library_and_its_users(tmp_path):
    scripts = shutil.copytree(PORTABLE, tmp_path / "portable")
    before = keys(scripts)
    assert len(before) == len(set(before.values())) == 21
    sources = scripts / "sources.txt"
    lines = sources.read_text().splitlines()
    raised = [line[:-4] + "0000" if line.startswith("imath ") else line for line in lines]
    sources.write_text("\n".join(raised) + "\n")
    after = keys(scripts)
    assert {name for name in before if before[name] != after[name]} == {"imath", "openexr", "openimageio"}


@pytest.mark.skipif(shutil.which("gcc-12") is None, reason="the keys contain the version of gcc-12")
def test_changed_recipe_rebuilds_a_library(tmp_path):
    scripts = shutil.copytree(PORTABLE, tmp_path / "portable")
    before = keys(scripts)
    recipes = scripts / "recipes.sh"
    recipes.write_text(recipes.read_text().replace("-DFASTFLOAT_TEST=OFF", "-DFASTFLOAT_TEST=ON"))
    after = keys(scripts)
    assert {name for name in before if before[name] != after[name]} == {"fast-float"}


@pytest.mark.skipif(
    shutil.which("x86_64-w64-mingw32-g++-posix") is None, reason="the keys contain its version"
)
def test_windows_has_the_same_libraries_by_other_recipes(monkeypatch):
    linux = keys(PORTABLE)
    monkeypatch.setenv("FIRETWIN_SYSTEM", "windows")
    windows = keys(PORTABLE)
    assert windows.keys() == linux.keys()
    assert not {*windows.values()} & {*linux.values()}


def test_bill_of_materials(sbom):
    libraries = sbom.read_sources(PORTABLE / "sources.txt", {"openexr", "zlib"})
    assert [library.name for library in libraries] == ["zlib", "openexr"]
    libraries.append(sbom.Library("libstdc++", "12.2.0"))
    text = sbom.document("firetwin-core", "0.2.0", libraries, ["module.so"])
    assert text == sbom.document("firetwin-core", "0.2.0", libraries, ["module.so"])
    bom = json.loads(text)
    openexr = bom["components"][1]
    assert (openexr["name"], openexr["version"]) == ("openexr", libraries[1].version)
    assert openexr["hashes"] == [{"alg": "SHA-256", "content": libraries[1].sha256}]
    assert openexr["evidence"]["occurrences"] == [{"location": "module.so"}]
    assert "hashes" not in bom["components"][2]
    references = [component["bom-ref"] for component in bom["components"]]
    assert bom["dependencies"][0]["dependsOn"] == references


def test_bill_of_materials_follows_the_schema(sbom):
    validation = pytest.importorskip("cyclonedx.validation.json")
    schema = pytest.importorskip("cyclonedx.schema")
    libraries = sbom.read_sources(PORTABLE / "sources.txt", {"openexr", "zlib"})
    text = sbom.document(
        "firetwin-core", "0.2.0", [*libraries, sbom.Library("libstdc++", "12.2.0")], ["module.so"]
    )
    assert validation.JsonStrictValidator(schema.SchemaVersion.V1_6).validate_str(text) is None


def test_manifest_names_the_holders_of_copyright():
    manifest = tomllib.loads((ROOT / "addon/blender_manifest.toml").read_text(encoding="utf-8"))
    recipes = (PORTABLE / "recipes.sh").read_text(encoding="utf-8")
    libraries = re.findall(r"^build_([\w-]+)\(\)", recipes, re.MULTILINE)
    named = [
        re.fullmatch(r"\d{4}(?:-\d{4})? [^()]+?(?: \(([\w-]+)\))?", holder)[1]
        for holder in manifest["copyright"]
    ]
    assert {*libraries, "leaflet", "three", "pybind11"} == {*named} - {None}
