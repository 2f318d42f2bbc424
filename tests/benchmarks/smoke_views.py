"""Numbers on smoke from above, from 40 km and from a satellite: solved as a flow, and as puffs.

    python tests/benchmarks/smoke_views.py RUN --out DIR [--width 480] [--samples 6] [--views down column]

Renders each view three times, over ground without trees or flames: with smoke as a flow, with puffs and
without any, all exposed alike. Prints what `smoke_pictures` measures, at its lower threshold, and which share
of the burning front has smoke within 100 m above it (`smoke_roots`). Clouds have a dimension of 1.35. What
lies in DIR is not made anew. A view takes 3 minutes of one processor, most of them to solve the flow.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import bpy  # noqa: F401 (Blender's own libraries come first)
import smoke_pictures
import smoke_roots
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin_core import run

SCENE = """run = "{run}"
cache = "cache"
[time]
start = 2014-09-17T{clock}:00-07:00
frames = 1
[forest]
trees = false
grass = false
understorey = 0
[fire]
flames = false
embers = false
firebrands = 0
torches = false
[smoke]
enabled = {enabled}
method = "{method}"
[light]
exposure = {exposure}
[render]
resolution = [{width}, {height}]
samples = {samples}
passes = ["rgb"]
[[cameras]]
name = "seen"
{camera}"""

KEY = "[[cameras.keys]]\nlatitude = {}\nlongitude = {}\n"
COLUMN = """focal_length = 85.0
[[cameras.keys]]
latitude = 38.72
longitude = -120.93
height = 1500.0
target = "point"
target_latitude = 38.985
target_longitude = -120.475
target_height = 1700.0
"""
SKY = 0.57  # of the rows from 40 km are above the horizon
VIEWS = {  # time of day, exposure, whether the ground is below the smoke, rows that count, camera
    "down": ("16:45", 0.5, True, 1.0, 'kind = "satellite"\nswath = 10300.0\n' + KEY.format(38.868, -120.57)),
    "column": ("16:12", 0.1, False, SKY, COLUMN),
    "satellite": ("16:12", 0.5, True, 1.0, 'kind = "satellite"\nswath = 56000.0\n'),
}
METHODS = {"flow": True, "puffs": True, "none": False}


def rendered(model: Path, out: Path, view: str, method: str, size: tuple[int, int], samples: int) -> Path:
    """A view's picture, made if it is not there."""
    clock, exposure, _, _, camera = VIEWS[view]
    name = f"{view}_{method}"
    folder = out / name
    picture = folder / "seen" / "rgb" / "seen_rgb_000001.png"
    if not picture.exists():
        text = SCENE.format(
            run=model.resolve(),
            clock=clock,
            enabled=str(METHODS[method]).lower(),
            method=method if METHODS[method] else "puffs",
            exposure=exposure,
            width=size[0],
            height=size[1],
            samples=samples,
            camera=camera,
        )
        scene = out / f"{name}.toml"
        scene.write_text(text, encoding="utf-8")
        command = [sys.executable, "-m", "firetwin", "render", scene, "--out", folder]
        subprocess.run(command, check=True, stdout=sys.stderr)
    return picture


def roots(scene: Path) -> float:
    """Share of the places that burn with smoke within 100 m above them."""
    settings = scene_file.read(scene)
    settings = replace(settings, smoke=replace(settings.smoke, complete=True))
    with tempfile.TemporaryDirectory() as folder:
        shot = Shot(settings, run.open(settings.run))
        return smoke_roots.shares(shot, 1, Path(folder), False)["share_of_places"]


def main() -> None:
    """Render, measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--width", type=int, default=480)
    parser.add_argument("--samples", type=int, default=6)
    parser.add_argument("--views", nargs="+", choices=VIEWS, default=list(VIEWS))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    size = given.width, round(given.width * 9 / 32) * 2
    print(
        "| view | smoke | dimension, blobs | by the ruler | slope | largest bump, at | front with smoke |\n"
        "|---|---|--:|--:|--:|--:|--:|"
    )
    for view in given.views:
        pictures = {each: rendered(given.run, given.out, view, each, size, given.samples) for each in METHODS}
        for method in ("flow", "puffs"):
            found = smoke_pictures.measured(pictures[method], pictures["none"], *VIEWS[view][2:4])
            low = found[f"{smoke_pictures.THRESHOLDS[0]:g}"]
            rooted = roots(given.out / f"{view}_{method}.toml")
            cells = (
                f"{low['dimension']:.2f}, {low['blobs']}",
                f"{low['ruler_dimension']:.2f}",
                f"{low['slope']:.2f}",
                f"{low['bump']:.2f}x, {low['bump_px']:.0f} px",
                f"{100 * rooted:.0f} %",
            )
            print(f"| {view} | {method} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
