"""The gallery's fires: invented land and weather, spread by a fire model, converted as anyone's output is.

    python tests/benchmarks/gallery_fires.py --runs DIR [--fires grass shrub]

Writes DIR/NAME, each a run; what is there is kept. All fires and all land are invented, wherever they lie,
and their runs say so. A fire takes 1 to 60 seconds.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firetwin.data.fractal import fractal
from gallery_land import BARE, ROAD, WATER, Land, hills, patches
from gallery_models import Fronts, Ignition, Spread, Weather, corine

SPOTTING = {  # as the sample's (data/spread.py)
    "random_seed": 917,
    "firebrands_per_unit_heat": 2e-9,
    "downwind_distance_mean": 6.0,
    "fireline_intensity_exponent": 0.4,
    "wind_speed_exponent": 0.35,
    "downwind_variance_mean_ratio": 120.0,
    "crosswind_distance_stdev": 90.0,
    "decay_distance": 1200.0,
}


@dataclass(frozen=True)
class Fire:
    """One fire of the gallery.

    Attributes
    ----------
    make
        What spreads it; None: the command that the sample is made with.
    start
        Moment that its times count from.
    interval
        Seconds between the run's times.
    night
        Whether it is filmed by night.
    fuel
        What most of its smoke is from.
    """

    title: str
    make: Callable[[], Spread | Fronts] | None
    start: str
    interval: int
    fuel: str
    night: bool = False


def grass() -> Spread:
    """300 ha of a grass plain in an hour, with tracks that stop its flanks."""
    shape, cell = (240, 360), 20.0
    land = Land.of(
        (38.62, -98.87),
        cell,
        560.0 + hills(shape, cell, 11, 3000.0, 4.0),
        patches(shape, cell, 12, 1600.0, {101: 0.1, 102: 0.35, 104: 0.55}),
    )
    x, y = land.places()
    bent = 40.0 * np.sin(x / 900.0)
    land.category[np.abs(y + bent - 1450.0) < cell] = ROAD
    land.category[np.abs(y + bent + 1700.0) < cell] = ROAD
    land.category[np.hypot((x - 300) / 1.6, y + 500) < 110] = WATER
    weather = Weather(
        [(0, 26, 265), (0.5, 31, 258), (1, 28, 250)],
        dead=0.05,
        live=0.5,
        temperature=34.0,
    )
    return Spread(land, weather, [Ignition(land.near(-2500, -300, 30))], 65.0)


def shrub() -> Spread:
    """Thousands of hectares of chaparral hills in a dry wind from the land."""
    shape, cell = (400, 400), 30.0
    height = 700.0 + hills(shape, cell, 21, 5000.0, 150.0)
    category = patches(shape, cell, 22, 1500.0, {145: 0.45, 147: 0.25, 142: 0.15, 102: 0.15})
    land = Land.of((34.42, -118.35), cell, height, category)
    weather = Weather([(0, 40, 40), (2, 50, 50), (4, 44, 55)], dead=0.04, live=0.75, temperature=31.0)
    return Spread(land, weather, [Ignition(land.near(4000, 4000, 60))], 290.0)


def timber() -> Spread:
    """Conifers on steep slopes, crowns burning in the afternoon."""
    shape, cell = (360, 360), 30.0
    height = 1100.0 + hills(shape, cell, 31, 6000.0, 260.0)
    category = patches(shape, cell, 32, 2000.0, {122: 0.08, 183: 0.12, 188: 0.1, 165: 0.7})
    land = Land.of((56.1, -124.6), cell, height, category)
    dense = fractal(shape, 33, 40.0, 2.0, 1.0) > -1.2
    land.wooded((category > 160) & dense, 0.65, 19.0, 1.6, 0.14).wooded(height > 1650.0, 0.1, 6.0, 1.0, 0.03)
    weather = Weather(
        [(0, 24, 230), (3, 36, 240), (6, 26, 245)],
        dead=0.04,
        live=0.7,
        temperature=26.0,
    )
    return Spread(land, weather, [Ignition(land.near(-4000, -3000, 60))], 290.0, SPOTTING)


def burn() -> Spread:
    """A prescribed burn of 300 m under pines: strips lit one after the other against the wind."""
    shape, cell = (160, 160), 3.0
    category = patches(shape, cell, 42, 60.0, {188: 0.5, 102: 0.4, 183: 0.1})
    land = Land.of((31.22, -84.48), cell, 50.0 + hills(shape, cell, 41, 300.0, 0.8), category)
    x, y = land.places()
    inside = np.maximum(np.abs(x), np.abs(y)) < 150.0
    land.category[(np.maximum(np.abs(x), np.abs(y)) < 156.0) & ~inside] = BARE
    land.wooded(fractal(shape, 43, 8.0, 2.0, 0.6) > 0.4, 0.4, 20.0, 9.0, 0.06)
    strips = [
        Ignition(
            (np.abs(x - east + 4.0 * np.sin(y / 40.0)) < 2.0) & inside & (np.abs(y) < 146.0),
            8.0 * number,
        )
        for number, east in enumerate((143.0, 105.0, 65.0, 25.0, -15.0, -55.0, -95.0, -135.0))
    ]
    weather = Weather([(0, 9, 270), (1.2, 11, 275)], dead=0.08, live=0.9, temperature=22.0)
    return Spread(land, weather, strips, 75.0)


def mega() -> Spread:
    """A fire of 100 km in a boreal forest, two days of strong wind with a night between."""
    shape, cell = (260, 340), 400.0
    height = 400.0 + hills(shape, cell, 51, 40_000.0, 60.0)
    category = patches(shape, cell, 52, 15_000.0, {122: 0.1, 145: 0.15, 183: 0.1, 165: 0.65})
    category[np.abs(fractal(shape, 53, 60.0, 3.0, 1.6) - 1.9) < 0.35] = WATER
    land = Land.of((57.6, -111.9), cell, height, category)
    land.wooded(category > 160, 0.6, 15.0, 1.2, 0.16)
    hours = [
        (0, 38, 240),
        (8, 52, 245),
        (14, 26, 250),
        (22, 34, 255),
        (32, 55, 262),
        (42, 30, 268),
        (48, 30, 270),
    ]
    weather = Weather(hours, dead=0.035, live=0.6, temperature=28.0)
    lit = [Ignition(land.near(*place, 900.0)) for place in ((-58e3, -22e3), (-50e3, 6e3))]
    return Spread(land, weather, lit, 44 * 60.0)


def island() -> Spread:
    """Forest and heath of an island in the sea, south of the equator."""
    shape, cell = (300, 300), 30.0
    x, y = Land.of((-42.7, 149.6), cell, np.zeros(shape), np.zeros(shape)).places()
    shore = 1.0 - np.hypot(x / 3300.0, y / 2300.0) + 0.16 * fractal(shape, 61, 90.0, 3.0, 1.6)
    height = 320.0 * np.clip(shore, 0.0, None) ** 0.9 * (1.0 + 0.35 * fractal(shape, 62, 60.0, 3.0, 2.0))
    height = np.where(shore > 0, np.maximum(height, 1.0), 0.0)
    category = patches(shape, cell, 63, 900.0, {162: 0.4, 145: 0.3, 122: 0.3})
    category = np.where(shore <= 0, WATER, np.where(shore < 0.02, BARE, category))
    land = Land.of((-42.7, 149.6), cell, height, category)
    land.wooded(category == 162, 0.5, 18.0, 3.0, 0.08)
    weather = Weather([(0, 28, 300), (4, 36, 310)], dead=0.05, live=0.7, temperature=27.0)
    return Spread(land, weather, [Ignition(land.near(-1900, 600, 40))], 240.0, SPOTTING)


def night() -> Spread:
    """Maquis and pines of a dry coast at night."""
    shape, cell = (300, 300), 25.0
    height = 280.0 + hills(shape, cell, 71, 3500.0, 90.0)
    category = patches(shape, cell, 72, 900.0, {145: 0.4, 142: 0.2, 165: 0.25, 102: 0.15})
    land = Land.of((43.27, 6.33), cell, height, category)
    land.wooded(category == 165, 0.5, 12.0, 1.5, 0.12)
    weather = Weather([(0, 36, 320), (3, 30, 330)], dead=0.05, live=0.7, temperature=24.0)
    return Spread(land, weather, [Ignition(land.near(-2000, 2000, 40))], 180.0)


def tropics() -> Spread:
    """Several fires of a flat savanna without wind or trees, looked at every six hours."""
    shape, cell = (200, 200), 200.0
    category = patches(shape, cell, 82, 6000.0, {102: 0.5, 104: 0.3, 101: 0.2})
    land = Land.of((8.4, 20.6), cell, np.full(shape, 430.0), category)
    places = ((-9e3, -6e3), (4e3, 8e3), (11e3, -9e3), (-2e3, 1e3))
    lit = [Ignition(land.near(*place, 250.0), 240.0 * number) for number, place in enumerate(places)]
    return Spread(
        land,
        Weather([(0, 0, 0), (48, 0, 0)], dead=0.06, live=0.5, temperature=33.0),
        lit,
        48 * 60.0,
    )


def lake() -> Fronts:
    """Two fires that run round a lake and merge behind it."""
    shape, cell = (260, 320), 20.0
    height = 210.0 + hills(shape, cell, 91, 2500.0, 12.0)
    category = patches(shape, cell, 92, 800.0, {102: 0.6, 142: 0.25, 165: 0.15})
    land = Land.of((46.22, 1.33), cell, height, category)
    x, y = land.places()
    lie = np.hypot((x + 500) / 620.0, (y - 100) / 270.0) + 0.1 * fractal(shape, 93, 60.0, 3.0, 1.5)
    land.category[lie < 1] = WATER
    land.elevation = np.where(lie < 1, 200.0, np.maximum(height, 201.0))
    return Fronts(
        land,
        corine(land),
        [(-1650, -130), (-1500, 380)],
        (5.0, 0.2),
        130.0,
        (2022, 206),
    )


FIRES = {
    "king": Fire("King Fire 2014 (synthetic sample)", None, "", 60, "timber"),
    "grass": Fire("Exercise grass fire", grass, "2022-08-12T20:00:00Z", 20, "grass"),
    "lake": Fire("Exercise lake fire", lake, "2022-07-25T12:30:00Z", 60, "grass"),
    "shrub": Fire("Exercise chaparral fire", shrub, "2021-10-14T19:30:00Z", 60, "shrub"),
    "timber": Fire("Exercise mountain fire", timber, "2023-07-19T19:00:00Z", 120, "timber"),
    "burn": Fire("Exercise prescribed burn", burn, "2023-02-20T18:00:00Z", 20, "litter"),
    "mega": Fire("Exercise great boreal fire", mega, "2023-06-30T18:00:00Z", 600, "timber"),
    "island": Fire("Exercise island fire", island, "2020-01-23T02:00:00Z", 60, "timber"),
    "night": Fire("Exercise night fire", night, "2021-08-17T20:00:00Z", 60, "shrub", night=True),
    "tropics": Fire("Exercise savanna fires", tropics, "2023-01-15T10:00:00Z", 21600, "grass"),
}


def made(name: str, runs: Path) -> Path:
    """The run of a fire in `runs`, made where it is missing."""
    out = runs / name
    if (out / "run.toml").exists():
        return out
    runs.mkdir(parents=True, exist_ok=True)
    fire, part = FIRES[name], runs / f"{name}.part"
    shutil.rmtree(part, ignore_errors=True)
    if fire.make is None:
        _firetwin("sample", part)
    else:
        spread = fire.make()
        with tempfile.TemporaryDirectory() as folder:
            files = spread.write(Path(folder))
            _firetwin(
                "convert",
                *files,
                "--out",
                part,
                "--start",
                fire.start,
                "--interval",
                fire.interval,
                "--name",
                fire.title,
            )
        _says_what_it_is(part / "run.toml")
    part.rename(out)
    return out


def _firetwin(*words: object) -> None:
    subprocess.run([sys.executable, "-m", "firetwin", *map(str, words)], check=True)


def _says_what_it_is(path: Path) -> None:
    """Have the run say that it is invented."""
    path.write_text("synthetic = true\n" + path.read_text(encoding="utf-8"), encoding="utf-8")


def main() -> None:
    """Make runs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=Path, required=True, metavar="DIR")
    parser.add_argument("--fires", nargs="+", choices=FIRES, default=list(FIRES), metavar="NAME")
    given = parser.parse_args()
    for name in given.fires:
        print(made(name, given.runs))


if __name__ == "__main__":
    main()
