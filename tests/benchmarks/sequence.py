"""Renders a shot across model minutes and measures whether anything in it steps, pulses or pops.

    .venv/bin/python tests/benchmarks/sequence.py RUN --out DIR [--frames 240] [--minutes 4]

Writes DIR/sequence.png and DIR/sequence.json. For every frame: the area in flames, from the front and from
the interpolated heat flux, the mean brightness of the picture, and how much it differs from the frame before.
A jump is the largest change from one frame to the next, in per cent of the series' mean.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import firetwin_core
import numpy as np
from firetwin.shot.fire import burning
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from numpy.typing import NDArray

SCENE = """run = "{run}"
[time]
start = 2014-09-17T16:10:20-07:00
end = 2014-09-17T16:{end:02d}:20-07:00
frames = {frames}
[render]
resolution = [192, 108]
samples = 4
passes = ["rgb"]
[smoke]
method = "puffs"
voxel_size = 110.0
extinction = 0.01
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.990
longitude = -120.5505
height = 600.0
target = "point"
target_latitude = 38.966
target_longitude = -120.536
target_height = 200.0
"""


def pictures(folder: Path) -> NDArray[np.float32]:
    """Every frame's luminance in linear light (frames, height, width); sRGB decoded."""
    import matplotlib.image

    frames = []
    for path in sorted(folder.glob("*.png")):
        rgb = matplotlib.image.imread(path)[..., :3]
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        frames.append((linear @ np.array([0.2126, 0.7152, 0.0722])).astype(np.float32))
    return np.stack(frames)


def measure(scene: Path, rendered: NDArray[np.float32]) -> dict[str, NDArray]:
    """Series over the frames."""
    settings = scene_file.read(scene)
    run = firetwin_core.run.open(settings.run)
    shot = Shot(settings, run)
    times, fire = shot.frames.times, shot.fire
    cells = fire.cells(times[0] - 3600.0, times[-1])
    model_cell = cells.area * run.surface_fuel.size / run.elevation.size
    ages = times[:, None] - cells.arrival
    fields = [fire.flux.at(float(time)) for time in times]
    low, high = run.flux_range()
    return {
        "model time, s": times - times[0],
        "front, ha": ((ages >= 0.0) & (ages < burning.BURN_TIME)).sum(axis=1) * cells.area / 1.0e4,
        "flux above 0, ha": np.array([(field > 0.0).sum() for field in fields]) * model_cell / 1.0e4,
        "heat, GW": np.array([np.nansum(field, dtype=np.float64) for field in fields]) * model_cell / 1.0e9,
        "F^1.5, mean": np.array([np.nanmean(np.clip((f - low) / (high - low), 0, 1) ** 1.5) for f in fields]),
        "brightness": rendered.mean(axis=(1, 2)),
        "difference": np.concatenate(
            [[np.nan], np.abs(np.diff(rendered, axis=0)).mean(axis=(1, 2)) / rendered.mean()]
        ),
    }


def jumps(series: NDArray, minute: NDArray[np.bool_]) -> dict[str, float]:
    """Largest change between frames, in parts of the mean: anywhere and where a model minute begins."""
    change = np.abs(np.diff(series)) / np.nanmean(series)
    return {"anywhere": float(np.nanmax(change)), "at a minute": float(np.max(change[minute]))}


def plot(series: dict[str, NDArray], out: Path) -> None:
    """Each series over the frames, minutes marked."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    time = series["model time, s"]
    names = [name for name in series if name != "model time, s"]
    figure, axes = pyplot.subplots(len(names), 1, figsize=(9, 1.9 * len(names)), sharex=True)
    for axis, name in zip(axes, names, strict=True):
        axis.plot(time, series[name], lw=1.2)
        axis.set_ylabel(name)
        axis.set_ylim(0.0, 1.15 * np.nanmax(series[name]))
        for minute in np.flatnonzero(np.diff(np.floor((time + 20.0) / 60.0)) > 0):
            axis.axvline(time[minute + 1], color="#bbbbbb", lw=0.8, zorder=0)
    axes[-1].set_xlabel("model time since the first frame, s (grey: the model's minutes)")
    figure.tight_layout()
    figure.savefig(out, dpi=110)


def main() -> None:
    """Render, measure and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--minutes", type=int, default=4)
    wanted = parser.parse_args()
    wanted.out.mkdir(parents=True, exist_ok=True)
    scene = wanted.out / "sequence.toml"
    scene.write_text(
        SCENE.format(run=wanted.run.resolve(), end=10 + wanted.minutes, frames=wanted.frames),
        encoding="utf-8",
    )
    command = "import sys; from firetwin.cli import main; sys.exit(main(sys.argv[1:]))"
    film = wanted.out / "film"
    subprocess.run([sys.executable, "-c", command, "render", scene, "--out", film, "--resume"], check=True)
    series = measure(scene, pictures(film / "drone" / "rgb"))
    time = series["model time, s"]
    minute = np.diff(np.floor((time + 20.0) / 60.0)) > 0
    report = {name: jumps(values, minute) for name, values in series.items() if name != "model time, s"}
    plot(series, wanted.out / "sequence.png")
    table = {name: values.tolist() for name, values in series.items()}
    (wanted.out / "sequence.json").write_text(
        json.dumps({"jumps": report, "series": table}), encoding="utf-8"
    )
    for name, values in report.items():
        print(
            f"{name:20} largest change from frame to frame {values['anywhere']:7.2%}, "
            f"where a minute begins {values['at a minute']:7.2%}"
        )


if __name__ == "__main__":
    main()
