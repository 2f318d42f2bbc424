"""Measures how fast and in how much memory volumes are written: `volumes.py [CASE ...]`.

Every case runs in a process of its own: seconds on one and two threads and of processor time (the least of
five, from 2,880 on of two), millions of voxels a second on two threads, those of all grids counted, and how
far memory grew beyond the arrays that were handed over. Cases are named KIND-SIDE:

    boxes    dense arrays of three fields, SIDE x SIDE x 64 voxels (32 from 2,880 on), a third of them smoke
    sight    the same, before a camera that sees a tenth of the smoke
    levels   a plume on SIDE x SIDE x 50 terrain-following levels (20 from 2,880 on), voxels of 100 m
    leaves   wisps of smoke in opposite corners of 60 x 60 x 10 km on SIDE x SIDE x 3 levels, voxels of 10 m
    nothing  the same without the wisps
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import geo, lod, set_threads, volume
from numpy.typing import NDArray

SIDES = (144, 720, 2880)
KINDS = ("boxes", "sight", "levels", "leaves", "nothing")
ORIGIN = (38.9, -120.55)
TOP = 10_000.0  # m
Field = NDArray[np.float32]
Write = Callable[[Path], volume.Frame]


def main() -> None:
    """Print a line for each case."""
    cases = sys.argv[1:] or [f"{kind}-{side}" for kind in KINDS for side in SIDES]
    if len(cases) == 1:
        print(measure(cases[0]))
        return
    for case in cases:
        subprocess.run([sys.executable, __file__, case], check=False)


def measure(case: str) -> str:
    """One case's line."""
    kind, side = case.split("-")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "volume.vdb")
        write = {"boxes": boxes, "sight": sight, "levels": levels, "leaves": leaves, "nothing": nothing}[
            kind
        ](int(side))
        Path("/proc/self/clear_refs").write_text("5")  # forgets the peak
        before = memory("VmRSS")
        seconds, work = {}, {}
        for threads in (1, 2):
            set_threads(threads)
            runs = []
            for _ in range(5 if int(side) < 2880 else 2):
                begun, worked = time.perf_counter(), time.process_time()
                frame = write(path)
                runs.append((time.perf_counter() - begun, time.process_time() - worked))
            seconds[threads], work[threads] = np.min(runs, axis=0)
        grown = memory("VmHWM") - before
        return (
            f"{case:13}{frame.active_voxels / 1e6:7.2f} Mvoxel, in all grids {frame.voxels / 1e6:7.2f}, "
            f"{frame.bytes / 1e6:6.1f} MB: {seconds[1]:7.3f} s, on two threads {seconds[2]:7.3f} s "
            f"(processor {work[2]:7.3f} s), {frame.voxels / seconds[2] / 1e6:6.1f} Mvoxel/s, "
            f"+ {grown / 1e6:6.0f} MB over {before / 1e6:.0f} MB"
        )


def memory(what: str) -> int:
    """A line of this process's status, bytes."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(what + ":"):
            return 1024 * int(line.split()[1])
    raise KeyError(what)


def fields(side: int) -> dict[str, Field]:
    """Three fields (side, side, 64) of smoke with an uneven edge, 0 outside of it."""
    x, y, z = (np.arange(n, dtype=np.float32) for n in (side, side, 64 if side < 2880 else 32))
    x, y = x[:, None, None], y[None, :, None]
    rough = np.sin(0.37 * x + 0.11 * y) * np.sin(0.29 * y + 0.21 * z) + np.sin(0.91 * x - 0.53 * z) * np.sin(
        0.7 * y
    )
    rough *= 0.2
    distance = np.abs(np.hypot(x / side - 0.5, y / side - 0.5) - 0.3)
    inside = (0.12 - distance) / 0.12 + rough
    smoke = inside > 0.0
    return {
        "density": np.where(smoke, 1e-1 * inside, 0.0),
        "temperature": np.where(smoke, 285.0 + 40.0 * inside * inside, 0.0),
        "tint": np.where(smoke, np.clip(0.5 + rough, 0.0, 1.0), 0.0),
    }


def boxes(side: int, **more: Any) -> Write:
    grids = fields(side)
    return lambda path: volume.write(path, grids, 20.0, **more)


def sight(side: int) -> Write:
    rotation = np.column_stack([[1, 0, 0], [0, 0, 1], [0, -1, 0]]).astype(float)  # looks north
    edge = 20.0 * side
    view = lod.Sight([(0.5 * edge, 0.5 * edge, 300.0)], rotation, np.tan((0.3, 0.2)), sun=(0.0, 0.6, 0.8))
    return boxes(side, sight=view)


def terrain(side: int, count: int) -> tuple[dict[str, Any], NDArray[np.float64]]:
    """All that `write_levels` asks for but the smoke, 60 km wide, and sigma of the levels."""
    half = 0.5 * (side - 1)
    latitude = ORIGIN[0] + (np.arange(side) - half) * (60.0 / 111.0 / side)
    longitude = ORIGIN[1] + (np.arange(side) - half) * (60.0 / 86.6 / side)
    ground = 1200 + 400 * np.sin(latitude * 40)[:, None] * np.cos(longitude * 40)
    sigma = np.linspace(0.0, 1.0, count) ** 1.5
    low = (ground + 20.0).astype(np.float32)
    height = np.empty((count, side, side), np.float32)
    for level, part in zip(height, sigma, strict=True):
        level[:] = low + part * (TOP - low)
    frame = geo.LocalFrame(*ORIGIN, 0.0)
    model = {"frame": frame, "latitude": latitude, "longitude": longitude, "ground": ground, "height": height}
    return model, sigma


def levels(side: int) -> Write:
    model, sigma = terrain(side, 50 if side < 2880 else 20)
    x = np.linspace(-1.0, 1.0, side)
    plume = np.exp(-((x / 0.15) ** 2))[:, None] * np.exp(-(((x - 0.1) / 0.3) ** 2))
    smoke = np.empty_like(model["height"])
    for level, part in zip(smoke, sigma, strict=True):
        level[:] = 3e-5 * plume * (1.0 - part) ** 2 - 1e-6
    return lambda path: volume.write_levels(path, smoke=smoke, voxel_size=100.0, **model)


def leaves(side: int, dense: float = 1e-5) -> Write:
    model, _ = terrain(side, 3)
    smoke = np.zeros_like(model["height"])
    smoke[0, 1, 1] = smoke[2, -2, -2] = dense
    return lambda path: volume.write_levels(path, smoke=smoke, voxel_size=10.0, grids=["dilution"], **model)


def nothing(side: int) -> Write:
    return leaves(side, 0.0)


if __name__ == "__main__":
    main()
