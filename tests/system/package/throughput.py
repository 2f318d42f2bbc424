"""Speed of the core inside and outside of Blender: ``throughput.py FOLDER [TIMES]`` prints a table.

FOLDER holds the unpacked wheel. One process has Blender, the other has not; each does every job TIMES times,
in turns, so that what else the machine does falls on both. The best time counts, of the clock and of all
cores together; the latter is meaningful even if other programs use the cores. Blender's threads have
worked before, so that both thread pools exist.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

ANSWER = "ANSWER "
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
    array = rng.random((160, 160, 80)).astype(np.float32)
    path = os.path.join(folder, "smoke.vdb")
    return {
        "forest, 720 x 720 cells": lambda: core.forest.trees(fuel, latitude, longitude, height, frame),
        "emitters, 144 x 144 cells": lambda: core.flux.emitters(flux, position, 0.0, 1e5),
        "array to VDB, 2 Mvoxel": lambda: core.volume.write(path, {"density": array}, 20.0),
    }


def serve(folder, place):
    """Do the jobs named on stdin, one by one, and answer with seconds."""
    sys.path.insert(0, folder)
    if place == "inside":
        import bpy

        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
        bpy.ops.object.modifier_add(type="SUBSURF")
        bpy.context.view_layer.update()
    import firetwin_core as core

    with tempfile.TemporaryDirectory() as scratch:
        calls = jobs(core, scratch)
        for line in sys.stdin:
            if line.strip() not in calls:
                print(ANSWER + json.dumps(list(calls)), flush=True)
                continue
            start, start_cores = time.perf_counter(), time.process_time()
            calls[line.strip()]()
            took = time.perf_counter() - start, time.process_time() - start_cores
            print(ANSWER + json.dumps(took), flush=True)


def ask(child, line):
    """The child's answer; what Blender prints is passed over."""
    child.stdin.write(line + "\n")
    child.stdin.flush()
    while not (answer := child.stdout.readline()).startswith(ANSWER):
        if not answer:
            sys.exit("throughput: a process ended before its time")
    return json.loads(answer.removeprefix(ANSWER))


def main(folder, times=30):
    """Print the table."""
    children = {
        place: subprocess.Popen(
            [sys.executable, __file__, folder, "--serve", place],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for place in ("outside", "inside")
    }
    names = [ask(child, "?") for child in children.values()].pop()
    print(
        f"{'':26}{'clock: outside':>16}{'inside':>11}{'cores: outside':>17}{'inside':>11}   throughput inside"
    )
    for name in names:
        best = {place: (float("inf"), float("inf")) for place in children}
        for _ in range(int(times)):
            for place, child in children.items():
                best[place] = tuple(map(min, best[place], ask(child, name)))
        columns = [f"{1e3 * best[place][kind]:8.2f} ms" for kind in (0, 1) for place in children]
        ratios = [100 * best["outside"][kind] / best["inside"][kind] for kind in (0, 1)]
        print(f"{name:26}     {'  '.join(columns)}     {ratios[0]:.0f} %, by cores {ratios[1]:.0f} %")
    for child in children.values():
        child.kill()


if __name__ == "__main__":
    if sys.argv[2:3] == ["--serve"]:
        serve(sys.argv[1], sys.argv[3])
        os._exit(0)  # Python's own end can hang with `bpy` loaded
    main(*sys.argv[1:])
