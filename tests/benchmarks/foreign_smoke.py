"""Pictures of smoke from runs that lack what the sample has, to be looked at.

    python tests/benchmarks/foreign_smoke.py RUN --out DIR [--width 320] [--samples 4] [--kinds wind sea]

RUN is the sample as `firetwin sample --format npy` writes it. Of it are made a run without wind, one without
arrival times, one with output each quarter of an hour, and one whose head burns towards the sea; each is
drawn once from 6 km upwind with smoke as a flow of the last `SPIN_UP` s. Prints where the pictures lie. What
lies in DIR is not made anew. A picture takes 2 to 3 minutes of one processor.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

SPIN_UP = 420.0
SHORE = -120.50, 0.20  # longitude of the shore, and over how many degrees the land slopes down to it
MINUTES = 15

SCENE = """run = "{run}"
cache = "cache"
[time]
start = 2014-09-17T16:15:00-07:00
frames = 1
[forest]
trees = false
grass = false
understorey = 0
[smoke]
method = "flow"
spin_up = {spin_up}
[render]
resolution = [{width}, {height}]
samples = {samples}
passes = ["rgb"]
[[cameras]]
name = "seen"
[[cameras.keys]]
latitude = 38.935
longitude = -120.615
height = 1500.0
target = "point"
target_latitude = 38.975
target_longitude = -120.535
target_height = 900.0
"""


def _linked(model: Path, out: Path, but: set[str]) -> None:
    """The run with all its fields but some; they are linked where one disk holds both, else copied."""
    for path in model.glob("*.npy"):
        if path.stem not in but:
            try:
                (out / path.name).hardlink_to(path)
            except OSError:
                shutil.copy(path, out)
    shutil.copy(model / "run.toml", out)


def no_wind(model: Path, out: Path) -> None:
    """No wind of its own."""
    _linked(model, out, {"wind_east", "wind_north"})


def no_arrival(model: Path, out: Path) -> None:
    """Heat alone says where it burns."""
    _linked(model, out, {"fuel_arrival_time"})


def quarters(model: Path, out: Path) -> None:
    """Output each quarter of an hour alone, heat as its mean, and no arrival times."""
    _linked(model, out, {"fuel_arrival_time", "heat_flux", "wind_east", "wind_north", "temperature"})
    for name in ("wind_east", "wind_north"):
        np.save(out / f"{name}.npy", np.load(model / f"{name}.npy", mmap_mode="r")[::MINUTES])
    flux = np.load(model / "heat_flux.npy", mmap_mode="r")
    means = [flux[max(0, n - MINUTES + 1) : n + 1].mean(0) for n in range(0, len(flux), MINUTES)]
    np.save(out / "heat_flux.npy", np.array(means, np.float32))
    text = (out / "run.toml").read_text(encoding="utf-8")
    for name in ("interval_s", "mean_s"):
        text = text.replace(f"{name} = 60.0", f"{name} = {60.0 * MINUTES}")
    (out / "run.toml").write_text(text, encoding="utf-8")


def sea(model: Path, out: Path) -> None:
    """East of `SHORE` nothing but water at height 0."""
    changed = ("elevation", "fuel_elevation", "canopy_fuel", "surface_fuel", "fuel_arrival_time", "heat_flux")
    _linked(model, out, set(changed))
    for name in changed:
        values = np.load(model / f"{name}.npy")
        axis = "longitude" if values.shape[-1] == len(np.load(model / "longitude.npy")) else "fuel_longitude"
        land = np.clip((SHORE[0] - np.load(model / f"{axis}.npy")) / SHORE[1], 0.0, 1.0)
        if name == "fuel_arrival_time":
            values[:, land == 0.0] = np.nan
        else:
            values *= land if "elevation" in name else land > 0.0
        np.save(out / f"{name}.npy", values)


KINDS: dict[str, Callable[[Path, Path], None]] = {
    "wind": no_wind,
    "arrival": no_arrival,
    "quarters": quarters,
    "sea": sea,
}


def main() -> None:
    """Make the runs and draw them."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--samples", type=int, default=4)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    given = parser.parse_args()
    for kind in given.kinds:
        folder, film = given.out / f"run_{kind}", given.out / kind
        if not folder.exists():
            folder.mkdir(parents=True)
            KINDS[kind](given.run, folder)
        scene = given.out / f"{kind}.toml"
        height = round(given.width * 9 / 32) * 2
        text = SCENE.format(
            run=folder.resolve(), spin_up=SPIN_UP, width=given.width, height=height, samples=given.samples
        )
        scene.write_text(text, encoding="utf-8")
        picture = film / "seen" / "rgb" / "seen_rgb_000001.png"
        if not picture.exists():
            command = [sys.executable, "-m", "firetwin", "render", scene, "--out", film]
            subprocess.run(command, check=True, stdout=sys.stderr)
        print(picture, flush=True)


if __name__ == "__main__":
    main()
