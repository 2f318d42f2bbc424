"""How fast the core is inside Blender and outside: ``throughput.py FOLDER [ROUNDS]`` prints a table.

FOLDER holds the unpacked wheel. Runs inside and outside alternate, each in a process of its own; the best
time of all rounds counts. Inside, Blender's own threads have worked before, so that both pools of threads are
there.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

SIDE = 720  # fuel cells, as in the King Fire


def jobs(core, folder):
    """Name -> work."""
    rng = np.random.default_rng(1)
    frame = core.geo.LocalFrame(38.8, -120.6, 1000.0)
    latitude, longitude = np.linspace(38.6, 39.1, SIDE), np.linspace(-120.9, -120.3, SIDE)
    fuel = rng.uniform(0, 2, (SIDE, SIDE)).astype(np.float32)
    height = rng.uniform(500, 2000, (SIDE, SIDE)).astype(np.float32)
    flux = rng.uniform(0, 1e5, (144, 144)).astype(np.float32)
    position = frame.forward_grid(latitude[::5], longitude[::5], height[::5, ::5])
    cells = 200
    arrival = np.sort(rng.uniform(0, 3600, cells))
    place = np.stack([arrival * 2, rng.uniform(-3000, 3000, cells), rng.uniform(800, 1200, cells)], axis=1)
    smoke = core.volume.puffs(3600.0, arrival, rng.uniform(1, 6, cells), place, [4.0, 3.0], 74.0**2)
    array = rng.random((160, 160, 80)).astype(np.float32)
    path = os.path.join(folder, "smoke.vdb")
    return {
        "forest, 720 x 720 cells": lambda: core.forest.trees(fuel, latitude, longitude, height, frame),
        "emitters, 144 x 144 cells": lambda: core.flux.emitters(flux, position, 0.0, 1e5),
        "array to VDB, 2 Mvoxel": lambda: core.volume.write(path, {"density": array}, 20.0),
        "smoke frame to VDB": lambda: core.volume.write_smoke(path, smoke, 50.0),
    }


def measure(folder, place):
    """Best seconds of each job in this process, as one JSON line."""
    sys.path.insert(0, folder)
    if place == "inside":
        import bpy

        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
        bpy.ops.object.modifier_add(type="SUBSURF")
        bpy.context.view_layer.update()
    import firetwin_core as core

    best = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, job in jobs(core, scratch).items():
            job()
            stop, best[name] = time.perf_counter() + 1.0, float("inf")
            while time.perf_counter() < stop:
                start = time.perf_counter()
                job()
                best[name] = min(best[name], time.perf_counter() - start)
    print("RESULT " + json.dumps(best), flush=True)


def main(folder, rounds=3):
    """Print the table."""
    best = {"inside": {}, "outside": {}}
    for _ in range(int(rounds)):
        for place, times in best.items():
            command = [sys.executable, __file__, folder, "--measure", place]
            output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            line = next(line for line in output.splitlines() if line.startswith("RESULT "))
            for name, seconds in json.loads(line.removeprefix("RESULT ")).items():
                times[name] = min(times.get(name, float("inf")), seconds)
    print(f"{'':28}{'outside':>12}{'inside':>12}{'throughput inside':>20}")
    for name, seconds in best["outside"].items():
        inside = best["inside"][name]
        print(f"{name:28}{seconds * 1e3:9.3f} ms{inside * 1e3:9.3f} ms{100 * seconds / inside:18.1f} %")


if __name__ == "__main__":
    if sys.argv[2:3] == ["--measure"]:
        measure(sys.argv[1], sys.argv[3])
        os._exit(0)  # Python's own end can hang with `bpy` loaded
    main(*sys.argv[1:])
