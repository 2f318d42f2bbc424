"""How much of the burning front has smoke within 100 m above it.

    python tests/benchmarks/smoke_roots.py SCENE.toml [--frame 1] [--volumes DIR] [--seen] [--json]

Takes the volumes of a frame in DIR, or makes them there (a folder that is removed, unless it is given). Of
each place that burns, `HEIGHTS` above the ground are looked at: it has smoke where extinction reaches `SEEN`
somewhere. Prints the share by number of places and by their heat. Solved smoke's volumes hold its extinction;
puffs' hold mass, from which `EXTINCTION` makes it. With `--seen` only places count that the cameras see:
volumes that a shot has baked hold what is seen alone.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from dataclasses import replace
from pathlib import Path

import bpy  # noqa: F401 (Blender's own libraries come first)
import numpy as np
from firetwin.bench.harness import Bench
from firetwin.bench.volume import bundled_openvdb
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke.baker import Baker
from firetwin_core import run, volume
from numpy.typing import NDArray

HEIGHTS = np.arange(10.0, 101.0, 10.0)  # m
SEEN = 1e-3  # 1/m: 100 m of it stop a tenth of the light
EXTINCTION = (
    4000.0  # m2/kg of fresh smoke (Reid et al. 2005, Atmos. Chem. Phys. 5: 3.8 to 4.7 m2/g dry, mid-visible)
)

Array = NDArray[np.float64]


def extinction(path: Path) -> tuple[NDArray[np.float32], Array, float]:
    """A volume's extinction (nx, ny, nz) in 1/m, the middle of its first voxel and their edge, m."""
    openvdb = bundled_openvdb(Bench())
    grids, _ = openvdb.readAll(str(path))
    names = {grid.name for grid in grids}
    name, unit = ("dilution", volume.FRESH_SMOKE * EXTINCTION) if "dilution" in names else ("density", 1.0)
    grid = openvdb.read(str(path), name)
    low, high = grid.evalActiveVoxelBoundingBox()
    values = np.zeros([b - a + 1 for a, b in zip(low, high, strict=True)], np.float32)
    grid.copyToArray(values, ijk=low)
    return (
        values * np.float32(unit),
        np.array(grid.transform.indexToWorld(low)),
        grid.transform.voxelSize()[0],
    )


def thickest(place: Array, volumes: list[Path]) -> Array:
    """The most extinction (n,) in the air over places (n, 3) on the ground, volumes added up."""
    points = place[:, None] + HEIGHTS[:, None] * np.array([0.0, 0.0, 1.0])
    total = np.zeros(points.shape[:2])
    for path in volumes:
        values, low, voxel = extinction(path)
        index = np.round((points - low) / voxel).astype(np.int64)
        inside = np.all((index >= 0) & (index < values.shape), axis=-1)
        found = values[tuple(np.moveaxis(np.clip(index, 0, np.array(values.shape) - 1), -1, 0))]
        total += np.where(inside, found, 0.0)
    return total.max(axis=1)


def shares(shot: Shot, frame: int, folder: Path, seen: bool) -> dict[str, float]:
    """All numbers."""
    if not list(folder.glob(f"*_{frame:06d}.vdb")):
        Baker(shot).write(folder / f"smoke_{frame:06d}.vdb", frame)
    volumes = sorted(folder.glob(f"*_{frame:06d}.vdb"))
    burning = shot.fire.sources(float(shot.frames.times[frame - 1]))
    place = burning.position.copy()
    place[:, 2] = shot.bare_ground.up(place[:, 0], place[:, 1])
    if seen:
        there = shot.sights.seen(place, np.full(len(place), 1.0), pixel=np.inf)
        place, burning = place[there], burning.take(np.flatnonzero(there))
    thick = thickest(place, volumes)
    rooted = thick > SEEN
    return {
        "places": len(place),
        "share_of_places": float(rooted.mean()),
        "share_of_heat": float(burning.power[rooted].sum() / burning.power.sum()),
        "median_extinction_per_m": float(np.median(thick)),
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--frame", type=int, default=1)
    parser.add_argument("--volumes", type=Path)
    parser.add_argument("--seen", action="store_true")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    settings = scene_file.read(given.scene)
    settings = replace(settings, smoke=replace(settings.smoke, complete=True))  # also what no camera sees
    shot = Shot(settings, run.open(settings.run))
    with tempfile.TemporaryDirectory() as scratch:
        found = shares(shot, given.frame, given.volumes or Path(scratch), given.seen)
    if given.json:
        print(json.dumps(found))
        return
    for name, value in found.items():
        print(f"{name:26} {value:10.4g}")


if __name__ == "__main__":
    main()
