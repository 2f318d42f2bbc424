"""Is a border of how the ground is drawn to be seen from above? Mean colours of both sides of each.

    python tests/benchmarks/seams.py RUN OUT [--size 640] [--samples 8] [--again] [--json]

A satellite's picture of the whole domain and of land beyond it at noon, without fire and smoke, in one scene
with two drones, so that it also shows what is drawn for them: finer ground, single trees, and where these
end. Borders are the domain's edge, distances from the drones within what they see, and the edges of what they
see, beyond which no tree is made. Compared are two bands of equal width on both sides of each, as the largest
difference of mean colour (R, G or B as it is shown) in per cent of the mean. Land is not alike everywhere, so
the same is done for borders of the same shape moved to other places, where nothing changes: half of these
differ by less than the median, and one in twenty by more than the last number. For what is drawn for the
drones the land is taken out altogether: "drawn" is the same difference with each band's colour divided by
that of a picture without the drones. Places near burned ground and lakes are left out.

With --again the pictures that are in OUT are measured.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.shot.terrain.terrain import Terrain
from firetwin_core import run as runs
from firetwin_core import sensor
from numpy.typing import NDArray

SWATH = 66_000.0  # m
BAND = 600.0  # m on each side of a border
MOVED = 200  # borders of the same shape elsewhere
FEWEST = 40  # pixels of a band, for its mean to say anything
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
focal_length = 14.0
[[cameras.keys]]
latitude = {inside[0]}
longitude = {inside[1]}
height = 2500.0
target = "point"
target_latitude = {middle[0]}
target_longitude = {middle[1]}
[[cameras]]
name = "outward"
focal_length = 14.0
[[cameras.keys]]
latitude = {outward[0]}
longitude = {outward[1]}
height = 2500.0
target = "point"
target_latitude = {outward[0]}
target_longitude = {beyond}
"""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


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
    return Shot(scene_file.read(out / "scene.toml"), run)


def draw(shot: Shot, path: Path) -> None:
    """The satellite's picture of the scene of all cameras."""
    import bpy
    from firetwin.jobs.worker_scene import build_scene

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


def domain(ground: Terrain) -> tuple[Array, Array]:
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


Border = tuple[Mask, Mask]  # the bands on both of its sides


def step(picture: Array, border: Border, plain: Array | None = None) -> float:
    """Largest difference (per cent) of mean colour between bands on both sides of a border.

    Parameters
    ----------
    plain
        The same view without what the border is of: colours count as parts of its.
    """
    low, high = (
        picture[band].mean(axis=0) / (1.0 if plain is None else plain[band].mean(axis=0))
        if band.sum() >= FEWEST
        else np.nan
        for band in border
    )
    return float(100.0 * np.max(np.abs(high - low) / (0.5 * (high + low))))


def bands(distance: Array, counts: Mask) -> Border:
    """What is within `BAND` of where a distance is 0, on both sides."""
    return tuple(counts & (side * distance > 0.0) & (side * distance < BAND) for side in (-1.0, 1.0))


def beside(seen: Mask, counts: Mask, width: int) -> Border:
    """What lies within `width` pixels of the border of an area, inside and outside of it."""
    window = (2 * width + 1, 2 * width + 1)

    def near(mask: Mask) -> Mask:
        return np.lib.stride_tricks.sliding_window_view(np.pad(mask, width), window).any((2, 3))

    return counts & seen & near(~seen), counts & ~seen & near(seen)


def moved(border: Border, counts: Mask, rng: np.random.Generator) -> Border:
    """The same border elsewhere, turned or turned over."""
    turn, over, way = rng.integers(4), rng.integers(2), rng.integers(-len(counts) // 2, len(counts) // 2, 2)
    made = []
    for band in border:
        band = np.rot90(band[::-1] if over else band, turn)
        shifted = np.zeros_like(band)
        (to, of), (to1, of1) = (_shift(int(step), len(band)) for step in way)
        shifted[to, to1] = band[of, of1]
        made.append(shifted & counts)
    return tuple(made)


def _shift(step: int, count: int) -> tuple[slice, slice]:
    """Where to and where from `count` things go that go on by `step`."""
    return slice(max(step, 0), count + min(step, 0)), slice(max(-step, 0), count - max(step, 0))


def measured(shot: Shot, picture: Array, plain: Array) -> dict[str, dict[str, float]]:
    """Each border: its difference, and the median and the 95th percentile of those moved elsewhere."""
    size = len(picture)
    ground, rng = shot.ground, np.random.default_rng(1)
    east, north = places(shot, size)
    flat = east.ravel(), north.ravel()
    burned = ground.sample((ground.burn_time < 1.0e8).astype(float), *flat).reshape(east.shape)
    water = ground.sample(ground.water, *flat).reshape(east.shape)
    counts = (burned == 0.0) & (water == 0.0)
    low, high = domain(ground)
    known = {"domain": bands(square(east, north, low, high), counts)}
    null = {"domain": [bands(_shrunk(east, north, low, high, rng), counts) for _ in range(MOVED)]}
    up = ground.up(*flat).reshape(east.shape)
    reach = shot.settings.forest.draw_distance
    radii = {"finer ground": ground.near_radius, "trees end": reach, "trees thin": 0.875 * reach}
    for view in shot.perspective_paths:
        place = np.stack([east, north, up], axis=-1)
        away = np.linalg.norm(place - view.position[0], axis=-1)
        alone = shot.for_camera(view.camera.name)
        seen = alone.visibility.visible_mask(place.reshape(-1, 3), 30.0).reshape(away.shape)
        for name, radius in radii.items():
            known[f"{view.camera.name}: {name}"] = bands(away - radius, counts & seen)
        near = counts & (away < 0.75 * reach)
        known[f"{view.camera.name}: trees beside none"] = beside(seen, near, round(BAND * size / SWATH))
    for name in known.keys() - null.keys():
        null[name] = [moved(known[name], counts, rng) for _ in range(MOVED)]
    found = {}
    for name, border in known.items():
        elsewhere = [value for other in null[name] if np.isfinite(value := step(picture, other))]
        if not elsewhere:
            continue  # too little of it is seen
        found[name] = {
            "difference": step(picture, border),
            "drawn": step(picture, border, plain) if name != "domain" else step(picture, border),
            "median elsewhere": float(np.median(elsewhere)),
            "95 % elsewhere": float(np.percentile(elsewhere, 95.0)),
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
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    shot = scene(asked.run, asked.out, asked.size, asked.samples)
    names = {"seams.png": shot, "plain.png": shot.for_camera("satellite")}
    for name, each in names.items():
        if not asked.again:
            draw(each, asked.out / name)
    pictures = [np.asarray(sensor.read_image(asked.out / name), np.float64)[..., :3] for name in names]
    found = measured(shot, *pictures)
    if asked.json:
        print(json.dumps(found))
        return
    for name, row in found.items():
        shown = "  ".join(f"{what} {value:5.2f} %" for what, value in row.items())
        print(f"{name:28} {shown}{'' if row['drawn'] < LIMIT else '  above 2 %'}")


if __name__ == "__main__":
    main()
