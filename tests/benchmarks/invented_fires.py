"""Eight invented fires of several sizes, places and hours: cameras of `new`, and the smoke in their views.

    python tests/benchmarks/invented_fires.py OUT [--fires grass maquis] [--shift 12] [--measure]

Writes OUT/NAME/run and OUT/NAME/scene.toml, by `firetwin new`; an existing run stays. Fronts are ragged.
With --measure it solves the film's own flow (one to three minutes for a fire) and compares two shares of a
camera's front that are clear of smoke in the middle of the film: the promised share, and the transmittance
of the film's smoke along the rays to the front, which is channel `clear` of the pass `masks`. If
OUT/NAME/film has the masks of the frame that it prints, they are compared as well. All fires are invented.
"""

from __future__ import annotations

import argparse
import re
import sys
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from firetwin_core import sensor, volume

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import whole_run
from firetwin import cli
from firetwin.auto_framing import candidates, front
from firetwin.auto_framing.visible_share import Visible, some
from firetwin.run import readers
from firetwin.shot.cameras.path import Path as CameraPath
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import sources

DAY, NIGHT = ("2021-07-20T20:00:00Z", "2021-07-21T05:30:00Z")  # in California


def hills(x, y):
    """Ridges 2 km apart and 300 m high."""
    return (
        400.0 + 150.0 * np.cos(2.0 * np.pi * x / 2000.0) + 80.0 * np.cos(2.0 * np.pi * (y + 0.3 * x) / 1700.0)
    )


HOURS = tuple(600.0 * np.arange(25.0))
GRASS = {"times": tuple(60.0 * np.arange(61.0)), "lasts": 90.0}
SHRUB = {"surface": 1.4, "lasts": 180.0, "height": hills}
WOOD = {"surface": 1.0, "lasts": 400.0, "canopy": 1.2, "height": hills}

FIRES = {
    name: {"at": at, "cell": cell, "cells": cells, "speed": speed, "wind": wind, "start": start}
    | {"seed": len(name), "fine": 3}
    | GRASS
    | more
    for name, at, cell, cells, speed, wind, start, more in (
        ("grass", (38.62, -98.87), 15.0, 100, 0.6, (5.0, 2.0), "2022-08-12T19:00:00Z", {"surface": 0.4}),
        ("savanna", (-12.6, 132.5), 20.0, 90, 0.5, (-3.0, 1.0), "2022-08-20T11:00:00Z", {"surface": 0.5}),
        ("chaparral", (34.42, -118.35), 30.0, 90, 0.7, (-6.0, -5.0), DAY, SHRUB),
        ("maquis", (43.27, 6.33), 25.0, 80, 0.4, (4.0, -6.0), "2021-08-17T21:00:00Z", SHRUB),
        ("conifer", (39.1, -120.5), 30.0, 80, 0.5, (4.0, 3.0), NIGHT, WOOD),
        ("eucalypt", (-33.9, 150.3), 25.0, 80, 0.5, (5.0, -2.0), "2020-01-05T03:00:00Z", WOOD),
        (
            "boreal",
            (57.6, -111.9),
            150.0,
            100,
            0.8,
            (5.0, 1.0),
            "2021-06-30T20:00:00Z",
            WOOD | {"times": HOURS, "lasts": 900.0},
        ),
        ("burn", (45.1, -0.6), 5.0, 64, 0.1, (2.0, 0.5), "2021-04-11T13:00:00Z", {"surface": 0.6}),
    )
}
"""Arguments of `whole_run.write`; maquis, conifer and savanna burn in the dark."""


def write_scene(out: Path, name: str, shift: float = 0.0) -> Path:
    """Write a fire's run, unless it exists, its clock moved by `shift` hours, and a fitted scene file."""
    folder, scene = out / name, out / name / "scene.toml"
    if not (folder / "run").exists():
        start = datetime.fromisoformat(FIRES[name]["start"]) + timedelta(hours=shift)
        whole_run.write(folder / "run", **FIRES[name] | {"start": f"{start:%Y-%m-%dT%H:%M:%SZ}"})
    scene.unlink(missing_ok=True)
    if cli.main(["new", str(folder / "run"), "-o", str(scene)]):
        raise SystemExit(f"{name}: firetwin new has failed")
    return scene


def measure(scene: Path) -> list[tuple[str, float, float, float]]:
    """Compare clear shares: camera, promised, of the film's smoke, and of rendered masks or NaN."""
    settings = scene_file.read(scene)
    run = readers.open(settings.run)
    shot, rows = Shot(settings, run), []
    moving = front.find_front(shot)
    visible = Visible(moving)
    for camera in settings.cameras[:3]:
        shown = shot.for_camera(camera.name)
        view, source = shown.paths[0], sources.select(shown)
        near = np.inf if camera.name == "overview" else 1.005 * candidates.away(view)
        promised = visible.seen(view, near).clear
        number = len(moving.frames) // 2
        frame = int(moving.frames[number])
        source.flow.solve([frame + 1])
        here = np.flatnonzero(moving.moment == number)
        away = moving.point[here, :2] - view.target[frame, :2]
        place = moving.point[some(here[np.hypot(*away.T) <= near], 160)]
        shows = visible.over_ground(view, frame, place, True)
        smoke = _through(source.bricks(frame + 1), view, frame, place[shows]) / len(place)
        masks = _masked(scene.parent / "film" / camera.name / "masks", view, frame, place[shows]) / len(place)
        rows.append((f"{camera.name} {frame + 1}", promised, smoke, masks))
    return rows


def _through(bricks: list[volume.Bricks], view: CameraPath, frame: int, place: np.ndarray) -> float:
    """Sum the transmittance of smoke between a camera and points (n, 3)."""
    away = place - view.position[frame]
    far = np.linalg.norm(away, axis=1)
    depth = volume.optical_depth(bricks, view.position[frame], away / far[:, None], far, 0.5, 10.0)
    return float(np.exp(-depth).sum())


def _masked(folder: Path, view: CameraPath, frame: int, place: np.ndarray) -> float:
    """Sum the channel `clear` of a rendered picture of masks at points (n, 3); NaN without one."""
    files = [file for file in folder.glob("*.exr") if int(re.findall(r"\d+", file.stem)[-1]) == frame + 1]
    if not files:
        return float("nan")
    clear = sensor.read_image(files[0])[..., 1]
    local = (place - view.position[frame]) @ view.rotation[frame]
    x, y = (local[:, axis] / -local[:, 2] / view.halves[frame, axis] for axis in (0, 1))
    height, width = clear.shape
    column, row = 0.5 * (1.0 + x) * width, 0.5 * (1.0 - y) * height
    return float(
        clear[np.clip(row, 0, height - 1).astype(int), np.clip(column, 0, width - 1).astype(int)].sum()
    )


def main() -> None:
    """Write the fires, and measure them on request."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--fires", nargs="+", choices=FIRES, default=[*FIRES], metavar="NAME")
    parser.add_argument(
        "--shift", type=float, default=0.0, metavar="HOURS", help="of the clock: 12 swaps day and night"
    )
    parser.add_argument("--measure", action="store_true")
    given = parser.parse_args()
    for name in given.fires:
        scene = given.out / name / "scene.toml"
        if not (given.measure and scene.exists()):
            write_scene(given.out, name, given.shift)
        if given.measure:
            for camera, *shares in measure(scene):
                print(name, camera, *(f"{share:.2f}" for share in shares), flush=True)


if __name__ == "__main__":
    main()
