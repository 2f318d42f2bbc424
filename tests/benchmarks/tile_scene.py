"""Time to select, fetch, decode and build a set of 3D tiles, first without and then with a cache.

    python tests/benchmarks/tile_scene.py [--tiles 300] [--side 40] [--runs 3]

The set has TILES tiles of 2 x SIDE x SIDE triangles with a JPEG picture of 256 pixels each, in a folder.
Times are medians with their range: wall-clock seconds, and CPU seconds including child processes.
The material is the terrain's, and costs the same for any number of tiles.
`tenth` and `last` are the times to fill the tenth and the last mesh, ms: means over ten tiles.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import tile_grid
from firetwin import auto_framing
from firetwin.blender import owned
from firetwin.data import sample
from firetwin.jobs.tiles import selection
from firetwin.run import readers
from firetwin.scene.tiles import build, material, mesh
from firetwin.shot.shot import Shot
from firetwin.shot.tiles import tile_cut


def shot_of(folder: Path, count: int, side: int) -> Shot:
    """Make a shot of the sample run that shows every tile of a set in `folder`."""
    sample.write(folder / "run", 3, "npy", lambda *_: None)
    shown = auto_framing.fit_folder(folder / "run", Path("run"), Path("cache")).settings
    shot = Shot(replace(shown, path=folder / "scene.toml", run=folder / "run"), readers.open(folder / "run"))
    tile_grid.write(folder / "set", shot.ground.frame, count, side)
    known = replace(
        shot.settings.tiles, sources=(str(folder / "set"),), max_screen_space_error=0.1, geoid=-24.9
    )
    return Shot(replace(shot.settings, tiles=known, cache=folder / "cache"), shot.run)


def seconds(function: Callable[[], Any]) -> tuple[float, float]:
    """Return wall-clock seconds of a call, and CPU seconds including ended child processes."""
    began, before = time.perf_counter(), _processor()
    function()
    return time.perf_counter() - began, _processor() - before


def _processor() -> float:
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def measure(folder: Path, count: int, side: int) -> dict[str, Any]:
    """Measure preparation and build, and both again with the cache."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    shot, filled = shot_of(folder, count, side), []
    _ = shot.visibility, shot.front
    fill, look, looks = mesh.fill, material.build, []

    def timed(*given: Any) -> str:
        began = time.process_time()
        shape = fill(*given)
        filled.append(1e3 * (time.process_time() - began))
        return shape

    def looked(*given: Any) -> Any:
        began = time.process_time()
        found = look(*given)
        looks.append(time.process_time() - began)
        return found

    mesh.fill, material.build = timed, looked
    stage = owned.adopt(bpy.context.scene)
    selected: dict[str, Any] = {}
    for turn in ("first", "second"):
        selected[f"{turn} prepare"] = seconds(lambda: selection.make(shot))
        cut = tile_cut.of_shot(shot)
        assert cut is not None
        selected[f"{turn} build"] = seconds(lambda cut=cut: build.build(shot, stage, cut, None))
    mesh.fill, material.build = fill, look
    selected["material"] = looks[0]
    selected["tiles"] = len(cut.tiles)
    selected["tenth"], selected["last"] = float(np.mean(filled[5:15])), float(np.mean(filled[-10:]))
    return selected


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--tiles", type=int, default=300)
    parser.add_argument("--side", type=int, default=40, help="squares of a side (40: 3,200 triangles)")
    parser.add_argument("--runs", type=int, default=3)
    given = parser.parse_args()
    runs = []
    for _ in range(given.runs):
        with tempfile.TemporaryDirectory() as folder:
            runs.append(measure(Path(folder), given.tiles, given.side))
    result: dict[str, Any] = {"tiles": runs[0]["tiles"]}
    for name in ("first prepare", "first build", "second prepare", "second build"):
        for clock, index in (("wall-clock", 0), ("CPU", 1)):
            result[f"{name}, {clock} s"] = _spread([run[name][index] for run in runs])
    result["material of the first build, CPU s"] = _spread([run["material"] for run in runs])
    for name in ("tenth", "last"):
        result[f"{name} mesh, ms"] = _spread([run[name] for run in runs])
    print(json.dumps(result, indent=1))


def _spread(values: list[float]) -> str:
    return f"{np.median(values):.3f} ({min(values):.3f} to {max(values):.3f})"


if __name__ == "__main__":
    main()
