"""Motion of smoke in a film at ten times real time: second difference over first, against memoryless noise.

Pictures of smoke alone at successive frames, before the display's gamma: the mean of |f(t + 1) - 2 f(t) +
f(t - 1)| over the mean of |f(t + 1) - f(t)|. It is 0 for even motion, below 1 for smoke whose turrets an eye
can follow, and sqrt(3) for frames without any relation to each other, as in a film of hundreds of times real
time: such smoke boils. Cases: the drone of the King Fire's sample run, and a grass fire of 500 m.
"""

from __future__ import annotations

import tempfile
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from firetwin.bench import march
from firetwin.bench.harness import OURS, Bench
from firetwin.bench.timing import Stopwatch, Times
from firetwin.data import sample
from firetwin.run import opening as runs
from firetwin.run.areas import metres_per_degree
from firetwin.shot import sections, settings
from firetwin.shot.cameras import pixel_rays
from firetwin.shot.cameras.rigs.drone import CameraKey, Drone
from firetwin.shot.shot import Shot
from firetwin.smoke import sources
from firetwin_core import volume
from numpy.typing import NDArray

SPEED, FPS, FRAMES = 10.0, 12, 8  # times real time
SIZE = (320, 180)
LIMIT, MEMORYLESS = 1.2, float(np.sqrt(3.0))
GRASS = datetime(2020, 7, 1, 20, 10, tzinfo=UTC)
_CELL, _CELLS, _SPREAD, _WIND = 10.0, 80, 1.0, 5.0  # m; m/s of the grass fire's head, and of its wind
_PLACE = (38.9, -121.2)

Array = NDArray[np.float64]


def run(bench: Bench) -> None:
    """Measure both fires."""
    with tempfile.TemporaryDirectory() as folder:
        for name, file in (
            ("the King Fire's drone", king(Path(folder))),
            ("a grass fire", grass(Path(folder))),
        ):
            shot = Shot(file, runs.open(file.run))
            watch = Stopwatch()
            value = ratio(pictures(shot))
            spent = watch.read()
            times = Times((spent.seconds,))
            case = f"{FRAMES} frames of {SIZE[0]} by {SIZE[1]} pixels of smoke, with its flow"
            bench.row(case, f"{OURS}, {name}", times, FRAMES, "frame", error=value, error_unit="of motion")
            quantity = f"Second difference / first of smoke, {name} at {SPEED:g} times real time"
            bench.target(quantity, value, LIMIT, "", most=True)


def ratio(frames: Array) -> float:
    """Compute the ratio of the second difference to the first of successive pictures (n, h, w)."""
    first, second = (float(np.abs(np.diff(frames, order, axis=0)).mean()) for order in (1, 2))
    return second / first


def pictures(shot: Shot) -> Array:
    """Render the green radiance (frames, h, w) of a shot's smoke alone, seen by its only camera."""
    source, (view,), light = sources.select(shot), shot.paths, march.light()
    width, height = shot.settings.render.resolution
    radiance = []
    for frame in range(1, shot.frames.count + 1):
        x, y = pixel_rays.plane(view, frame, height, width)
        local = np.stack([x, y, -np.ones_like(x)], axis=-1).reshape(-1, 3)
        toward = (local / np.linalg.norm(local, axis=1, keepdims=True)) @ view.rotation[frame - 1].T
        ends = np.full((len(toward), 1), pixel_rays.SKY, np.float32)
        lines = view.position[frame - 1], toward, ends
        marched = volume.march(source.bricks(frame), *lines, light, step=0.5, pixel=(0.0, view.pixel))
        radiance.append(np.asarray(marched, np.float64).reshape(height, width, 4)[..., 1])
    return np.array(radiance)


def king(folder: Path, speed: float = SPEED) -> settings.Settings:
    """Describe a film of the sample's head from its drone."""
    path = folder / "king"
    if not path.exists():
        sample.write(path, march.MODEL_TIMES, "npy")
    key = CameraKey(0.0, 38.9632, -120.5728, 900.0, "head", target_height=450.0)
    return _film(path, march.MOMENT, Drone(keys=(key,)), speed, 300.0)


def grass(folder: Path, speed: float = SPEED) -> settings.Settings:
    """Write a grass fire's run, and describe a film of its head from 300 m."""
    path = folder / "grass"
    if not path.exists():
        _write_grass(path)
    north, east = metres_per_degree(_PLACE[0])
    place = _PLACE[0] - 300.0 / north, _PLACE[1] + 100.0 / east
    key = CameraKey(0.0, *place, 60.0, "head", target_height=40.0)
    return _film(path, GRASS, Drone(keys=(key,)), speed, 90.0)


def _film(run: Path, start: datetime, rig: Drone, speed: float, spin_up: float) -> settings.Settings:
    span = timedelta(seconds=speed * (FRAMES - 1) / FPS)
    return settings.Settings(
        path=run.parent / "scene.toml",
        run=run,
        cache=run.parent / "cache",
        time=sections.Time(start=start, end=start + span, frames=FRAMES, fps=FPS),
        smoke=sections.SmokeSettings(spin_up=spin_up),
        cameras=(settings.Camera(rig=rig),),
        render=settings.Render(resolution=SIZE, passes=("rgb",)),
    )


def _write_grass(folder: Path) -> None:
    """Write the run of a fire on flat grass that spreads as an ellipse with the wind to the east."""
    north, east = metres_per_degree(_PLACE[0])
    metres = (np.arange(_CELLS) - 0.5 * (_CELLS - 1)) * _CELL
    x, y = np.meshgrid(metres + 0.4 * _CELLS * _CELL, metres)
    middle, long, wide = 0.4 * _SPREAD, 0.6 * _SPREAD, 0.3 * _SPREAD  # m/s
    k = long**2 - middle**2
    arrival = (np.sqrt((x * middle) ** 2 + k * (x**2 + (y * long / wide) ** 2)) - x * middle) / k
    times = np.arange(0.0, 901.0, 30.0)
    burning = (arrival <= times[:, None, None]) & (arrival > times[:, None, None] - 60.0)
    flux = np.where(burning, 100e3, 0.0).astype(np.float32)
    folder.mkdir()
    start, listed = (GRASS - timedelta(minutes=10)).isoformat(), ", ".join(map(str, times))
    lines = 'name = "Grass"', f"start = {start}", f"times_s = [{listed}]", 'vertical = "orthometric"'
    (folder / "run.toml").write_text("\n".join([*lines, "[units]", 'elevation = "m"', ""]))
    fields = {
        "latitude": _PLACE[0] + metres / north,
        "longitude": _PLACE[1] + metres / east,
        "elevation": np.zeros_like(x),
        "fuel_latitude": _PLACE[0] + metres / north,
        "fuel_longitude": _PLACE[1] + metres / east,
        "surface_fuel": np.full_like(x, 0.5),
        "canopy_fuel": np.zeros_like(x),
        "heat_flux": flux,
        "fuel_arrival_time": np.where(arrival <= times[-1], arrival, np.nan),
        "wind_east": np.full_like(flux, _WIND),
        "wind_north": np.zeros_like(flux),
    }
    for name, values in fields.items():
        np.save(folder / f"{name}.npy", values)
