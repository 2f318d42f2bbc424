"""Cycles' kernels for NVIDIA cards: machine code that Blender ships, or that `make` translates beforehand.

Blender ships machine code (cubin) for some architectures. For a card of another architecture the driver
compiles 12 to 25 MB of intermediate code (PTX) on one thread when the kernels are first loaded. OptiX loads
these kernels before its own (`OptiXDevice::load_kernels` in Cycles), so it waits just as long.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from .. import files
from ..errors import Error, writing
from .cards import Card

LOWER_MINOR = (5, 2)
"""First version of Blender that also loads machine code of a lower minor version of the same major version
("Reduce number of cuda compute capabilities", 2026-05-13)."""
PACKAGE = "nvidia-cuda-nvcc-cu12"
"""Package of the Python package index that contains `ptxas`, NVIDIA's assembler."""


def folder() -> Path:
    """Return the folder of Cycles' kernels of this Blender."""
    import bpy

    return Path(bpy.utils.system_resource("SCRIPTS", path="addons_core")) / "cycles" / "lib"


def find(card: Card, kernels: Path, blender: tuple[int, ...]) -> Path | None:
    """Find the machine code that Blender loads for a card; None if the driver would compile it.

    Parameters
    ----------
    kernels
        Folder of Cycles' kernels.
    blender
        Version of Blender.
    """
    major, minor = card.capability
    minors = range(minor, -1, -1) if blender[:2] >= LOWER_MINOR else [minor]
    paths = (kernels / f"kernel_sm_{major}{each}.cubin.zst" for each in minors)
    return next((path for path in paths if path.is_file()), None)


def make(architecture: str, kernels: Path) -> Path:
    """Assemble Cycles' PTX into machine code (cubin), and put it where Cycles looks for it.

    It needs no GPU. The kernels of Blender 4.5 for sm_90 took 12.6 processor minutes and 5.4 GB of memory;
    the file has 4.2 MB.

    Parameters
    ----------
    architecture
        Such as ``sm_90``.
    kernels
        Folder of Cycles' kernels, which must be writable.

    Returns
    -------
    The file of machine code.

    Raises
    ------
    Error
        The kernels exist already, `ptxas` or the intermediate code is missing, or the translation failed.
    """
    import zstandard  # of bpy and Blender

    path = kernels / f"kernel_{architecture}.cubin.zst"
    if path.exists():
        raise Error(f"{path} exists already; remove it to make it again")
    number = int(architecture.removeprefix("sm_"))
    ptx_files = {int(re.sub(r"\D", "", each.name)): each for each in kernels.glob("kernel_compute_*.ptx.zst")}
    if not (not_newer := [each for each in ptx_files if each <= number]):
        raise Error(f"{kernels} has no intermediate code (kernel_compute_*.ptx.zst) for {architecture}")
    newest = ptx_files[max(not_newer)]
    command = [_find_ptxas(), f"-arch={architecture}", "-O3", "--split-compile=0", "-o"]
    with tempfile.TemporaryDirectory(prefix="firetwin-kernels-") as place:
        text, code = Path(place, "kernel.ptx"), Path(place, "kernel.cubin")
        text.write_bytes(zstandard.ZstdDecompressor().decompressobj().decompress(newest.read_bytes()))
        done = subprocess.run([*command, str(code), str(text)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            reason = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
            raise Error(f"ptxas could not translate {newest.name} for {architecture}: {reason}")
        packed = zstandard.ZstdCompressor(level=19).compress(code.read_bytes())
        with writing(path):
            files.write(path, lambda part: part.write_bytes(packed))
    return path


def _find_ptxas() -> str:
    """Find `ptxas` in the Python package `PACKAGE`, or on the search path.

    Raises
    ------
    Error
        It is missing.
    """
    spec = find_spec("nvidia")
    for place in spec.submodule_search_locations or () if spec else ():
        found = Path(place, "cuda_nvcc", "bin", "ptxas.exe" if sys.platform == "win32" else "ptxas")
        if found.is_file():
            if not os.access(found, os.X_OK):
                found.chmod(found.stat().st_mode | 0o111)
            return str(found)
    if on_path := shutil.which("ptxas"):
        return on_path
    raise Error(f"ptxas is missing; install it with: {sys.executable} -m pip install {PACKAGE}")
