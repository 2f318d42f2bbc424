"""Is a border of how the ground is drawn to be seen from above? Mean colours of both sides of each.

    python tests/benchmarks/seams.py RUN OUT [--size 640] [--samples 8] [--picture PNG] [--json]

A satellite's picture of the whole domain and of land beyond it at noon, without fire and smoke, in one scene
with two drones, so that it also shows what is drawn for them: finer ground, single trees, and where these
end. Each border is a distance from something: from the domain's edge, or from the drones. Compared are two
bands of equal width on both sides of it, as the largest difference of mean colour (R, G or B as it is shown)
in per cent of the mean. Land is not alike everywhere, so the same is done for borders of the same shape
moved to other places, where nothing changes: half of these differ by less than the median here. Places near
burned ground and lakes are left out.

With --picture an older OUT/seams.png is measured, or another picture of the same view.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from firetwin.shot import file
from firetwin.shot.ground import Ground
from firetwin.shot.shot import Shot
from firetwin_core import run as runs
from firetwin_core import sensor
from numpy.typing import NDArray

SWATH = 66_000.0  # m
BAND = 600.0  # m on each side of a border
MOVED = 200  # borders of the same shape elsewhere
LIMIT = 2.0  # per cent
SCENE = """\
run = "{run}"
cache = "cache"
[time]
start = 2014-09-17T12:00:00-07:00
frames = 1
[smoke]
enabled = false
[fire]
flames = false
embers = false
firebrands = 0
torches = false
[render]
resolution = [{size}, {size}]
samples = {samples}
denoise = false
passes = ["rgb"]
[[cameras]]
name = "satellite"
kind = "satellite"
swath = {swath}
[[cameras]]
name = "inside"
[[cameras.keys]]
latitude = {inside[0]}
longitude = {inside[1]}
height = 300.0
target = "point"
target_latitude = {middle[0]}
target_longitude = {middle[1]}
[[cameras]]
name = "outward"
[[cameras.keys]]
latitude = {outward[0]}
longitude = {outward[1]}
height = 300.0
target = "point"
target_latitude = {outward[0]}
target_longitude = {beyond}
"""

Array = NDArray[np.float64]


def scene(folder: Path, out: Path, size: int, samples: int) -> Shot:
    """The shot, its scene file written to `out`: drones in the south-east and 800 m from the western edge."""
    run = runs.open(folder)
    latitude, longitude = (np.sort(axis) for axis in (run.latitude, run.longitude))

    def at(north: float, east: float) -> tuple[float, float]:
        return tuple(
            float(axis[0] + part * (axis[-1] - axis[0]))
            for axis, part in ((latitude, north), (longitude, east))
        )

    text = SCENE.format(
        run=folder.resolve().as_posix(), size=size, samples=samples, swath=SWATH,
        inside=at(0.3, 0.7), middle=at(0.5, 0.5), outward=at(0.6, 0.015), beyond=at(0.6, -0.1)[1],
    )  # fmt: skip
    out.mkdir(parents=True, exist_ok=True)
    (out / "scene.toml").write_text(text, encoding="utf-8")
    return Shot(file.read(out / "scene.toml"), run)


def draw(shot: Shot, path: Path) -> None:
    """The satellite's picture of the scene of all cameras."""
    import bpy
    from firetwin.jobs.setting import build_scene

    stage = build_scene(shot, lambda *_: None, print)
    stage.scene.camera = stage.camera("satellite")
    stage.scene.render.filepath = str(path.resolve())
    stage.scene.view_layers[0].use = True
    bpy.ops.render.render(write_still=True)


def places(shot: Shot, size: int) -> tuple[Array, Array]:
    """East and north (size, size) m of the pixels' middles, the northern row first."""
    centre = shot.paths[0].position[0]
    step = (np.arange(size) + 0.5) / size * SWATH - 0.5 * SWATH
    east, north = np.meshgrid(step, -step)
    return east + centre[0], north + centre[1]


def domain(ground: Ground) -> tuple[Array, Array]:
    """Least and greatest east and north (m) of the run's grid, on its sides' middles."""
    fields = ground.fields
    inner = slice(fields.margin, -fields.margin)
    latitude, longitude = fields.latitude[inner], fields.longitude[inner]
    sides = ground.point(
        [latitude[0], latitude[-1], latitude.mean(), latitude.mean()],
        [longitude.mean(), longitude.mean(), longitude[0], longitude[-1]],
    )
    return np.array([sides[2, 0], sides[0, 1]]), np.array([sides[3, 0], sides[1, 1]])


def square(east: Array, north: Array, low: Array, high: Array) -> Array:
    """Distance (m) from a rectangle's border, above zero outside of it."""
    x = np.maximum(low[0] - east, east - high[0])
    y = np.maximum(low[1] - north, north - high[1])
    return np.where((x > 0.0) & (y > 0.0), np.hypot(x, y), np.maximum(x, y))


def step(picture: Array, distance: Array, counts: NDArray[np.bool_]) -> float:
    """Largest difference (per cent) of mean colour between bands on both sides of a border."""
    inner, outer = (
        picture[counts & (side * distance > 0.0) & (side * distance < BAND)] for side in (-1.0, 1.0)
    )
    if min(len(inner), len(outer)) < 50:
        return float("nan")
    low, high = inner.mean(axis=0), outer.mean(axis=0)
    return float(100.0 * np.max(np.abs(high - low) / (0.5 * (high + low))))


def measured(shot: Shot, picture: Array) -> dict[str, dict[str, float]]:
    """Each border: its difference, and the median and the 95th percentile of those moved elsewhere."""
    size = len(picture)
    ground, rng = shot.ground, np.random.default_rng(1)
    east, north = places(shot, size)
    flat = east.ravel(), north.ravel()
    burned = ground.sample((ground.burn_time < 1.0e8).astype(float), *flat).reshape(east.shape)
    water = ground.sample(ground.water, *flat).reshape(east.shape)
    counts = (burned == 0.0) & (water == 0.0)
    low, high = domain(ground)
    known = {"domain": square(east, north, low, high)}
    null = {"domain": [_shrunk(east, north, low, high, rng) for _ in range(MOVED)]}
    reach = shot.settings.forest.draw_distance
    radii = {
        "finer ground ends": ground.near_radius,
        "finer ground fades": 0.6 * ground.near_radius,
        "trees end": reach,
        "trees thin": 0.75 * reach,
    }
    up = ground.up(*flat).reshape(east.shape)
    for view in shot.near:
        eye = view.position[0]
        away = np.sqrt((east - eye[0]) ** 2 + (north - eye[1]) ** 2 + (up - eye[2]) ** 2)
        others = [np.hypot(east - x, north - y) for x, y in rng.uniform(low, high, (MOVED, 2))]
        for name, radius in radii.items():
            known[f"{view.camera.name}: {name}"] = away - radius
            null[f"{view.camera.name}: {name}"] = [other - radius for other in others]
    found = {}
    for name, distance in known.items():
        elsewhere = [step(picture, other, counts) for other in null[name]]
        found[name] = {
            "difference": step(picture, distance, counts),
            "median elsewhere": float(np.nanmedian(elsewhere)),
            "95 % elsewhere": float(np.nanpercentile(elsewhere, 95.0)),
        }
    return found


def _shrunk(east: Array, north: Array, low: Array, high: Array, rng: np.random.Generator) -> Array:
    """Distance from a border like the domain's, smaller and somewhere in it."""
    part = rng.uniform(0.6, 0.95)
    first = low + rng.uniform(0.0, 1.0, 2) * (1.0 - part) * (high - low)
    return square(east, north, first, first + part * (high - low))


def main() -> None:
    """Draw, measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--size", type=int, default=640)
    parser.add_argument("--samples", type=int, default=8)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    shot = scene(asked.run, asked.out, asked.size, asked.samples)
    path = asked.picture or asked.out / "seams.png"
    if not asked.picture:
        draw(shot, path)
    found = measured(shot, np.asarray(sensor.read_image(path), np.float64)[..., :3])
    if asked.json:
        print(json.dumps(found))
        return
    for name, row in found.items():
        shown = "  ".join(f"{what} {value:5.2f} %" for what, value in row.items())
        print(f"{name:28} {shown}{'' if row['difference'] < LIMIT else '  above 2 %'}")


if __name__ == "__main__":
    main()
