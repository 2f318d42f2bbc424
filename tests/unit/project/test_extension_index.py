"""The listing of the extension for Blender, made by Blender's own command from small zips."""

import hashlib
import importlib.util
import json
import subprocess
import sys
import threading
import zipfile
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from module_file import load_module

PORTABLE = Path(__file__).resolve().parents[3] / "cpp/portable"
ADDRESS = "https://example.org/download/v{version}"
PLATFORMS = {
    "linux-x64": "manylinux_2_28_x86_64",
    "macos-arm64": "macosx_11_0_arm64",
    "windows-x64": "win_amd64",
}

pytestmark = [
    pytest.mark.posix("need of index.py, which lists the zips on Linux"),
    pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="the command comes with Blender"),
]


@pytest.fixture(scope="module")
def extension():
    return load_module(PORTABLE / "extension.py")


@pytest.fixture(scope="module")
def present(extension):
    return extension.tomllib.loads((extension.ROOT / "pyproject.toml").read_text())["project"]["version"]


@pytest.fixture
def write_zip(tmp_path, extension, present):
    """Write a zip with the manifest that `extension.py` makes, and empty wheels."""

    def write(version, platform):
        wheels = [
            Path(f"firetwin_core-{version}-{python}-{python}-{PLATFORMS[platform]}.whl")
            for python in ("cp311", "cp313")
        ]
        wheels.append(Path("tqdm-4.67.1-py3-none-any.whl"))
        manifest = extension.manifest(wheels, [platform], present)
        path = tmp_path / f"firetwin-{version}-{platform}.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("blender_manifest.toml", manifest.replace(present, version))
            archive.writestr("__init__.py", f"version = {version!r}")
            for wheel in wheels:
                archive.writestr(f"wheels/{wheel}", "")
        return path

    return write


def make(out, zips, address=ADDRESS):
    command = [sys.executable, PORTABLE / "index.py", out, address, *zips]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_listing_describes_each_zip(tmp_path, write_zip, present):
    zips = [
        write_zip(version, platform) for version in ("0.0.9", present, "0.0.10") for platform in PLATFORMS
    ]
    made = make(tmp_path / "out", zips)
    assert made.returncode == 0, made.stderr
    for name, version in (("index.json", present), ("index-previous.json", "0.0.10")):
        listing = json.loads((tmp_path / "out" / name).read_text())
        assert (listing["version"], listing["blocklist"]) == ("v1", [])
        assert [entry["platforms"] for entry in listing["data"]] == [[platform] for platform in PLATFORMS]
        for entry, platform in zip(listing["data"], PLATFORMS, strict=True):
            zipped = tmp_path / f"firetwin-{version}-{platform}.zip"
            assert (entry["id"], entry["version"]) == ("firetwin", version)
            assert entry["blender_version_min"] == "4.5.0"
            assert entry["python_versions"] == ["3.11", "3.13"]
            assert entry["archive_url"] == f"https://example.org/download/v{version}/{zipped.name}"
            assert entry["archive_size"] == zipped.stat().st_size
            assert entry["archive_hash"] == "sha256:" + hashlib.sha256(zipped.read_bytes()).hexdigest()


def test_missing_platform_and_bad_zip_are_refused(tmp_path, write_zip, present):
    zips = [write_zip(present, platform) for platform in PLATFORMS]
    result = make(tmp_path / "out", zips[1:])
    assert result.returncode == 1
    assert "missing: ['linux-x64']" in result.stderr
    assert make(tmp_path / "some", zips[:1]).returncode == 1
    assert make(tmp_path / "some", ["--incomplete", *zips[:1]]).returncode == 0
    assert len(json.loads((tmp_path / "some/index.json").read_text())["data"]) == 1
    zips[0].write_bytes(b"not a zip")
    result = make(tmp_path / "out", zips)
    assert result.returncode == 1
    assert "Blender accepted 2 of 3 zips" in result.stderr
    assert not (tmp_path / "out").exists()


@pytest.fixture
def served(tmp_path):
    """Serve the folder of the zips, and return its address."""
    handler = partial(SimpleHTTPRequestHandler, directory=tmp_path)
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.mark.skipif(sys.platform != "linux", reason="installs the zip for Linux")
def test_blender_installs_either_version(tmp_path, write_zip, present, served, extension):
    zips = [write_zip(version, platform) for version in (present, "0.0.9") for platform in PLATFORMS]
    assert make(tmp_path, zips, served).returncode == 0
    for name, version in (("index.json", present), ("index-previous.json", "0.0.9")):
        local = tmp_path / Path(name).stem
        local.mkdir()
        client = [sys.executable, extension.blender_ext()]
        places = ["--local-dir", local, "--remote-url", f"{served}/{name}"]
        versions = ["--blender-version", "4.5.0", "--python-version", "3.11.0"]
        options = ["--local-cache", "0", "--temp-prefix-and-suffix", "/.tmp"]
        subprocess.run([*client, "sync", *places], check=True, capture_output=True)
        subprocess.run(
            [*client, "install", *places, *versions, *options, "firetwin"], check=True, capture_output=True
        )
        assert (local / "firetwin/__init__.py").read_text() == f"version = {version!r}"


def test_a_zip_of_a_byte_too_many_is_refused(tmp_path, extension):
    zipped = tmp_path / "firetwin.zip"
    zipped.write_bytes(bytes(1001))
    assert extension.check_size(zipped, 1001) == 1001
    with pytest.raises(SystemExit, match="1001 bytes, more than 1000"):
        extension.check_size(zipped, 1000)


def test_only_windows_needs_time_zones(tmp_path, extension):
    for platform, tag in PLATFORMS.items():
        (folder := tmp_path / platform).mkdir()
        names = [f"firetwin_core-1-cp311-cp311-{tag}", "tqdm-1-py3-none-any", "tzdata-1-py2.py3-none-any"]
        for name in [*names, "firetwin-1-py3-none-any"]:
            (folder / f"{name}.whl").touch()
        wheels, chosen = extension.choose_wheels([folder])
        assert chosen == platform
        assert [wheel.stem for wheel in wheels] == names[: 3 if platform == "windows-x64" else 2]
