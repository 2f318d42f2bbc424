"""Pack the installed compiled module into a wheel: ``pack.py STAGE PYTHON VERSION LICENSES OUT``.

Stands in for the build backend, which would need a Python of each version to run.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLATFORM = "manylinux_2_28_x86_64"  # verified by auditwheel in check.sh


def metadata(version: str) -> str:
    """Return the METADATA file, from cpp/pyproject.toml."""
    project = tomllib.loads((ROOT / "cpp/pyproject.toml").read_text(encoding="utf-8"))["project"]
    fields = [
        ("Metadata-Version", "2.4"),
        ("Name", project["name"]),
        ("Version", version),
        ("Summary", project["description"]),
        ("License-Expression", project["license"]),
        ("Requires-Python", project["requires-python"]),
        *(("Requires-Dist", dependency) for dependency in project["dependencies"]),
    ]
    return "".join(f"{name}: {value}\n" for name, value in fields)


def pack(stage: Path, python: str, version: str, licenses: Path, out: Path) -> None:
    """Write the wheel of `stage` for one Python version to the folder `out`."""
    info = stage / f"firetwin_core-{version}.dist-info"
    shutil.rmtree(info, ignore_errors=True)  # of a previous run
    shutil.copytree(licenses, info / "licenses" / "libraries")
    shutil.copy(ROOT / "LICENSE", info / "licenses")
    tag = "cp" + python.replace(".", "")
    (info / "METADATA").write_text(metadata(version))
    (info / "WHEEL").write_text(
        f"Wheel-Version: 1.0\nGenerator: firetwin\nRoot-Is-Purelib: false\nTag: {tag}-{tag}-{PLATFORM}\n"
    )
    out.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-m", "wheel", "pack", stage, "--dest-dir", out], check=True)


if __name__ == "__main__":
    _, stage, python, version, licenses, out = sys.argv
    pack(Path(stage), python, version, Path(licenses), Path(out))
