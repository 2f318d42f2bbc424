"""Pack wheels for publishing.

``pack.py core STAGE PYTHON PORTABLE`` packs the compiled module that CMake installed in STAGE for one Python
version. It replaces the build backend, which would need a Python of each version to run.
``pack.py addon PORTABLE`` packs the package `firetwin`, addon/ and data/, which requires `firetwin-core` of
the same version. An installation from a checkout (/pyproject.toml) contains both instead.
The wheels go to PORTABLE/wheels.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import sbom
from packaging.requirements import Requirement
from pyproject_metadata import StandardMetadata

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WINDOWS = os.environ.get("FIRETWIN_SYSTEM") == "windows"
PLATFORM = "win_amd64" if WINDOWS else "manylinux_2_28_x86_64"  # verified by check.sh
COMPILER = "x86_64-w64-mingw32-g++-posix" if WINDOWS else "g++-12"


def project(folder: Path) -> StandardMetadata:
    """Return the metadata of the pyproject.toml in `folder`, with the version of the checkout."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    content = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))
    content["project"].pop("dynamic", None)
    content["project"]["version"] = version
    return StandardMetadata.from_pyproject(content, folder, metadata_version="2.4")


def finish(stage: Path, metadata: StandardMetadata, licenses: dict[str, Path], tag: str) -> Path:
    """Write the metadata of the wheel whose files are in `stage`, and return its folder.

    `licenses` are the files of licences by their names in the wheel.
    """
    info = stage / f"{metadata.name.replace('-', '_')}-{metadata.version}.dist-info"
    shutil.rmtree(info, ignore_errors=True)  # of a previous run
    for name, path in licenses.items():
        (info / "licenses" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, info / "licenses" / name)
    metadata.license_files = [Path(name) for name in sorted(licenses)]
    (info / "METADATA").write_bytes(bytes(metadata.as_rfc822()))
    pure = str(tag.startswith("py3")).lower()
    (info / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: firetwin\nRoot-Is-Purelib: {pure}\nTag: {tag}\n"
    )
    return info


def close(stage: Path, out: Path) -> None:
    """Write RECORD and the wheel."""
    out.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-m", "wheel", "pack", stage, "--dest-dir", out], check=True)


def built_in(licenses: Path) -> list[sbom.Library]:
    """Return the libraries in the module: those with a licence, the C++ library, and pybind11's headers."""
    names = {path.name for path in licenses.iterdir()}
    gcc = subprocess.run(
        [COMPILER, "-dumpfullversion"], check=True, capture_output=True, text=True
    ).stdout.strip()
    tools = dict(line.split("==") for line in (HERE / "tools.txt").read_text().split())
    own = [sbom.Library("libstdc++", gcc), sbom.Library("pybind11", tools["pybind11"])]
    return sbom.read_sources(HERE / "sources.txt", names) + own


def core(stage: Path, python: str, portable: Path) -> None:
    """Pack the compiled module of one Python version, with the licences and the list of its libraries."""
    metadata = project(ROOT / "cpp")
    libraries = portable / "licenses"
    licenses = {
        f"libraries/{path.relative_to(libraries)}": path for path in libraries.rglob("*") if path.is_file()
    }
    tag = "cp" + python.replace(".", "")
    info = finish(stage, metadata, licenses | {"LICENSE": ROOT / "LICENSE"}, f"{tag}-{tag}-{PLATFORM}")
    (info / "sboms").mkdir()
    modules = [path.name for path in stage.glob("firetwin_core.*")]
    bom = sbom.document(metadata.name, str(metadata.version), built_in(libraries), modules)
    (info / "sboms" / "libraries.cdx.json").write_text(bom, encoding="utf-8")
    close(stage, portable / "wheels")


def addon(portable: Path) -> None:
    """Pack the package `firetwin`."""
    metadata = project(ROOT)
    metadata.dependencies.append(Requirement(f"firetwin-core=={metadata.version}"))
    stage = portable / "addon"
    shutil.rmtree(stage, ignore_errors=True)
    ignore = shutil.ignore_patterns("__pycache__", "*.pyc")
    shutil.copytree(ROOT / "addon", stage / "firetwin", ignore=ignore)
    shutil.copytree(ROOT / "data", stage / "firetwin/data", ignore=ignore)
    info = finish(
        stage, metadata, {str(path): ROOT / path for path in metadata.license_files}, "py3-none-any"
    )
    commands = "".join(f"{name} = {target}\n" for name, target in metadata.scripts.items())
    (info / "entry_points.txt").write_text(f"[console_scripts]\n{commands}")
    close(stage, portable / "wheels")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["core", stage, python, portable]:
            core(Path(stage), python, Path(portable))
        case ["addon", portable]:
            addon(Path(portable))
        case _:
            sys.exit(__doc__)
