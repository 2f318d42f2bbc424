"""Make the Blender extension from addon/, data/ and wheels: ``extension.py OUT WHEELS...``.

Blender's `blender_ext.py` builds and validates the zip; it is part of the running Python's `bpy` package.
WHEELS are folders: the zip contains all their wheels, which determine its platforms, except the wheel of the
add-on.
"""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LARGEST = 40_000_000  # bytes
WINDOWS_ONLY = ("tzdata",)  # other systems have time zones


def blender_ext() -> Path:
    """Load Blender's command that manages extensions."""
    spec = importlib.util.find_spec("bpy")
    if spec is None:
        sys.exit("extension: this Python has no Blender module; use .venv/bin/python (examples/setup.sh)")
    package = Path(next(iter(spec.submodule_search_locations)))
    return next(package.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))


def platform_of(wheel: Path) -> str | None:
    """Return Blender's name for the platform of a wheel; None for all platforms."""
    tag = wheel.stem.split("-")[-1]
    if tag == "any":
        return None
    for start, end, name in (
        ("manylinux", "x86_64", "linux-x64"),
        ("linux", "x86_64", "linux-x64"),  # built on and for this machine, as in tests/system/window.sh
        ("win", "amd64", "windows-x64"),
        ("macosx", "arm64", "macos-arm64"),
    ):
        if tag.startswith(start) and tag.endswith(end):
            return name
    sys.exit(f"extension: {wheel.name} is for no system that Firetwin is made for")


def choose_wheels(folders: list[Path]) -> tuple[list[Path], str]:
    """Return the wheels of the folders that the zip contains, and their platform in Blender's words."""
    every = sorted(wheel for folder in folders for wheel in folder.glob("*.whl"))
    wheels = [wheel for wheel in every if not wheel.name.startswith("firetwin-")]
    platforms = sorted({name for name in map(platform_of, wheels) if name})
    if len(platforms) != 1:
        sys.exit(f"extension: wheels of the core for one system are needed, not for: {platforms or 'none'}")
    if not platforms[0].startswith("windows"):
        wheels = [wheel for wheel in wheels if not wheel.name.startswith(WINDOWS_ONLY)]
    return wheels, platforms[0]


def manifest(wheels: list[Path], platforms: list[str], version: str) -> str:
    """Return the manifest of addon/ with platforms and wheels filled in."""
    text = (ROOT / "addon/blender_manifest.toml").read_text(encoding="utf-8")
    if tomllib.loads(text)["version"] != version:
        sys.exit("extension: pyproject.toml and addon/blender_manifest.toml differ in version")
    names = json.dumps([f"./wheels/{wheel.name}" for wheel in wheels], indent=2)
    head, table, rest = text.partition("\n[permissions]")
    return f"{head}platforms = {json.dumps(platforms)}\nwheels = {names}\n{table}{rest}"


def stage(folder: Path, wheels: list[Path], text: str) -> None:
    """Copy the extension in Blender's layout: the add-on without its benchmarks, data/ and docs/."""
    shutil.rmtree(folder, ignore_errors=True)
    ignore = shutil.ignore_patterns("__pycache__", "*.pyc")
    shutil.copytree(ROOT / "addon", folder, ignore=shutil.ignore_patterns("__pycache__", "*.pyc", "bench"))
    shutil.copytree(ROOT / "data", folder / "data", ignore=ignore)
    for page in (ROOT / "docs").rglob("*.md"):  # the manual; addon/ui/manual_pages.py makes HTML of it
        (target := folder / page.relative_to(ROOT)).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(page, target)
    shutil.copy(ROOT / "LICENSE", folder)
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy(wheel, folder / "wheels")
    (folder / "blender_manifest.toml").write_text(text, encoding="utf-8")


def check_size(zipped: Path, largest: int = LARGEST) -> int:
    """Return the bytes of a zip; a larger one ends the program."""
    size = zipped.stat().st_size
    if size > largest:
        sys.exit(f"extension: {zipped} has {size} bytes, more than {largest}")
    return size


def list_content(zipped: Path) -> str:
    """Return a table of the content: compressed and unpacked bytes, largest first."""
    packed: Counter[str] = Counter()
    unpacked: Counter[str] = Counter()
    for entry in zipfile.ZipFile(zipped).infolist():
        name = entry.filename
        large = entry.compress_size > 100_000 or name.endswith(".whl")
        key = name if large else f"other files of {name.partition('/')[0]}/" if "/" in name else "other files"
        packed[key] += entry.compress_size
        unpacked[key] += entry.file_size
    rows = [f"{size:>12,} {unpacked[key]:>12,}  {key}" for key, size in packed.most_common()]
    return "\n".join([f"{'bytes':>12} {'unpacked':>12}  content", *rows])


def main(out: Path, folders: list[Path]) -> None:
    """Stage, build and validate the extension; print its content, and the file's name last."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    wheels, platform = choose_wheels(folders)
    suffix = "" if platform == "linux-x64" else f"-{platform}"
    stage(out / "stage", wheels, manifest(wheels, [platform], version))
    zipped = out / f"firetwin-{version}{suffix}.zip"
    command = [sys.executable, blender_ext()]
    subprocess.run(
        [*command, "build", "--source-dir", out / "stage", "--output-filepath", zipped],
        check=True,
    )
    subprocess.run([*command, "validate", zipped], check=True)
    print(list_content(zipped))
    print(f"extension: {zipped}, {check_size(zipped)} bytes")


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(folder) for folder in sys.argv[2:]])
