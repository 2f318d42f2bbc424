"""Does smoke move in a film as the air does in its flow? Optical flow beside the solver's wind.

    python tests/benchmarks/film_motion.py RUN --out DIR [--frames 24] [--width 320] [--samples 6] [--apart 2]

Films the head of the sample's fire and a flank in the wind with two cameras that stand still, a frame a
second, with smoke as a flow. In every fourth frame the wind of the flow is kept as it is solved, and seen
through the camera: along each line of sight the way that smoke goes in the picture until `--apart` frames
later, weighted by how much of it is seen there. Beside it stands the way that the picture itself has gone
(Lucas and Kanade 1981, "An iterative image registration technique", IJCAI), in patches of `PATCH` pixels that
smoke fills and that have enough in them to be followed. Prints their median difference in pixels and in per
cent of the median way, how much of the flow's way the pictures go, and pops: the largest change from frame to
frame over the median one. 240 frames are a film of 10 s of each camera.

DIR may be used again: what is there is not made anew. `--measure` makes nothing at all and takes the frames
that are there.
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import sys
from datetime import datetime, timedelta
from pathlib import Path

import bpy  # noqa: F401 (Blender's own libraries come first)
import numpy as np
from firetwin.bench.harness import Bench
from firetwin.bench.volume import bundled_openvdb
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import bake, flow_frames
from firetwin.smoke.baker import Baker
from firetwin_core import run
from lines_of_sight import Grid, SolvedWind, expected
from numpy.typing import NDArray
from optical import displacement, luminance

PATCH, EVERY = 24, 8  # px: side of a patch, and from one to the next
KEPT = 4  # frames from one kept wind to the next
OPAQUE = 0.7  # of the light that smoke in a patch has to stop, in the mean

SCENE = """run = "{run}"
cache = "cache"
[time]
start = 2014-09-17T16:12:00-07:00
end = 2014-09-17T{end:%H:%M:%S}-07:00
frames = {frames}
[forest]
trees = false
grass = false
[smoke]
method = "flow"
[render]
resolution = [{width}, {height}]
samples = {samples}
passes = ["rgb"]
video = true
[[cameras]]
name = "head"
[[cameras.keys]]
latitude = 38.990
longitude = -120.5505
height = 600.0
target = "head"
[[cameras]]
name = "flank"
[[cameras.keys]]
latitude = {flank[0]}
longitude = {flank[1]}
height = 700.0
target = "point"
target_latitude = {flank[2]}
target_longitude = {flank[3]}
target_height = 300.0
"""
CAMERAS = ("head", "flank")
BEGIN = datetime(2014, 9, 17, 16, 12)
FLANK = (38.94090, -120.58700, 38.92470, -120.56620)  # from 2.6 km upwind of the western flank

Array = NDArray[np.float64]


def solve(shot: Shot, out: Path) -> None:
    """Solve a shot of one camera; of every `KEPT`-th frame keep its finest wind, in cells' middles."""
    solved, (camera,) = Baker(shot).flow, shot.settings.cameras
    for frame in range(1, shot.frames.count + 1):
        place = wind(out, camera.name, frame)
        if (frame - 1) % KEPT or place.exists():
            continue
        if solved.parts[-1].moment(frame).exists():
            sys.exit(f"{out}/cache holds frame {frame} but not its wind: remove the cache")
        solved.ready(frame)
        np.savez(place, wind=solved._live.solvers[-1].velocity().astype(np.float16))
        print(f"{camera.name}: solved to frame {frame}", file=sys.stderr)
    solved.solve([shot.frames.count])


def wind(out: Path, name: str, frame: int) -> Path:
    """Where the wind of a camera's flow in a frame is kept."""
    return out / f"wind_{name}_{frame:06d}.npz"


def density(openvdb, path: Path) -> Grid:
    """A file's extinction, 1/m."""
    found = openvdb.read(str(path), "density")
    low, high = found.evalActiveVoxelBoundingBox()
    values = np.zeros([b - a + 1 for a, b in zip(low, high, strict=True)], np.float32)
    found.copyToArray(values, ijk=low)
    return Grid(values, np.array(found.transform.indexToWorld(low)), found.transform.voxelSize()[0])


def compared(shot: Shot, name: str, out: Path, apart: int, count: int) -> tuple[Array, Array]:
    """Ways (n, 2) of all patches in a camera's first pictures, as they have them and as the flow has."""
    shot = shot.of(name)
    (view,) = shot.paths
    resolution = shot.settings.render.resolution
    openvdb, baker = bundled_openvdb(Bench()), Baker(shot)
    layers, folder = flow_frames.layers(shot, baker.flow), bake.folder(shot)
    half = PATCH // 2
    columns, rows = (np.arange(half, side - half, EVERY) for side in resolution)
    centre = np.stack(np.meshgrid(columns, rows), -1).reshape(-1, 2).astype(float)
    inner = np.stack(np.meshgrid(*[np.linspace(-half + 4, half - 4, 3)] * 2), -1).reshape(-1, 2)
    found = [], []
    for frame in range(1, count + 1 - apart, KEPT):
        with np.load(wind(out, name, frame)) as kept:
            winds = SolvedWind(layers[-1].part, kept["wind"].astype(np.float32))
        grids = [density(openvdb, layer.file(folder, frame)) for layer in layers]
        pixels = (centre[:, None] + inner).reshape(-1, 2)
        seconds = apart * shot.frames.step
        way, light = expected(view, grids, winds, pixels, resolution, seconds)
        light = light.reshape(len(centre), -1)
        way = (way.reshape(len(centre), -1, 2) * light[..., None]).sum(1) / light.sum(1)[:, None].clip(1e-9)
        smoky = light.mean(1) > OPAQUE
        first, second = (luminance(picture(out, name, at)) for at in (frame, frame + apart))
        seen, trusted = displacement(first, second, centre[smoky].astype(int), PATCH)
        found[0].append(seen[trusted])
        found[1].append(way[smoky][trusted])
    return np.concatenate(found[0]), np.concatenate(found[1])


def picture(out: Path, name: str, frame: int) -> Path:
    """A rendered frame."""
    return out / "film" / name / "rgb" / f"{name}_rgb_{frame:06d}.png"


def pops(out: Path, name: str, count: int) -> dict[str, float]:
    """Mean change of brightness from frame to frame: the median, and the largest over it."""
    pictures = [luminance(picture(out, name, frame)) for frame in range(1, count + 1)]
    change = [float(np.abs(b - a).mean()) for a, b in itertools.pairwise(pictures)]
    return {"median_change": float(np.median(change)), "largest_over_median": max(change) / np.median(change)}


def summary(seen: Array, way: Array) -> dict[str, float]:
    """How well ways (n, 2) agree."""
    off, long = np.linalg.norm(seen - way, axis=1), np.linalg.norm(way, axis=1)
    return {
        "patches": len(off),
        "median_way_px": float(np.median(long)),
        "median_error_px": float(np.median(off)),
        "median_error_percent": float(100.0 * np.median(off) / np.median(long)),
        "median_seen_px": [float(v) for v in np.median(seen, axis=0)],
        "median_flow_px": [float(v) for v in np.median(way, axis=0)],
        "seen_over_flow": float(np.sum(seen * way) / np.sum(way * way)),
    }


def write(scene: Path, wanted: argparse.Namespace) -> None:
    """Write the scene file of the films."""
    text = SCENE.format(
        run=wanted.run.resolve(),
        frames=wanted.frames,
        end=BEGIN + timedelta(seconds=wanted.frames - 1),
        width=wanted.width,
        height=round(wanted.width * 9 / 32) * 2,
        samples=wanted.samples,
        flank=FLANK,
    )
    scene.write_text(text, encoding="utf-8")


def main() -> None:
    """Solve, render, measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--width", type=int, default=320, help="of the pictures, pixels")
    parser.add_argument("--samples", type=int, default=6)
    parser.add_argument("--apart", type=int, default=2, help="frames from one to the other of a comparison")
    parser.add_argument("--measure", action="store_true")
    wanted = parser.parse_args()
    wanted.out.mkdir(parents=True, exist_ok=True)
    scene = wanted.out / "motion.toml"
    if not wanted.measure:
        write(scene, wanted)
    settings = scene_file.read(scene)
    shot = Shot(settings, run.open(settings.run))
    if not wanted.measure:
        for name in CAMERAS:
            solve(shot.of(name), wanted.out)
        film = [sys.executable, "-m", "firetwin", "render", scene, "--out", wanted.out / "film", "--resume"]
        subprocess.run(film, check=True, stdout=sys.stderr)
    report = {}
    for camera in CAMERAS:
        every = range(1, shot.frames.count + 1)
        there = next((n - 1 for n in every if not picture(wanted.out, camera, n).exists()), len(every))
        if there <= max(wanted.apart, 1):
            print(f"{camera}: too few pictures in {wanted.out}", file=sys.stderr)
            continue
        report[camera] = {"frames": there} | summary(*compared(shot, camera, wanted.out, wanted.apart, there))
        report[camera] |= pops(wanted.out, camera, there)
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
