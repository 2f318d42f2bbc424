"""A gallery of fires of every size and fuel: sheets of pictures, and numbers on them.

    python tests/benchmarks/gallery.py --runs DIR --out OUT [--before OLD] [--fires grass burn] [--width 640]
                                       [--samples 6] [--through WORDS] [--again]

Runs are made in DIR where they are missing (gallery_fires.py: needs the extras "simulate" and "models", and
forefire). Each is filmed by the scene that `firetwin new` writes for it, at one frame: overview, drone, flank
and satellite by day, the overview in the thermal band, and by night, for which the fire's clock is moved.

OUT/NAME_VIEW.png     the pictures
OUT/NAME.png          one sheet a fire; with --before, those of OLD beside them
OUT/numbers.json .md  gallery_numbers.py on each, and seconds and memory of the smoke's flow

What is in OUT is kept; --again measures it and draws the sheets, and renders nothing. A fire takes 1 to 10
minutes on 2 cores at 320 px.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import bpy  # noqa: F401 (Blender's own libraries come first)
import gallery_fires
import gallery_numbers
import gallery_pictures
import gallery_sheet
import numpy as np
from firetwin_core import sensor
from optical import brightness, colours

VIEWS = ("overview", "drone", "flank", "satellite", "thermal", "night")
_SMOKE_OF = {
    "overview": False,
    "satellite": True,
}  # view: smoke is only what is brighter
_DARK = ("night", "thermal")  # views whose brightness nothing is asked of
_BAR = 0.1  # of a thermal picture's width, on the right, where its bar of temperatures stands
_COLUMNS = (
    "straight_per_cent",
    "median",
    "clipped_per_cent",
    "dimension",
    "front_seen",
)


def measured(out: Path, name: str, view: str) -> dict[str, float]:
    """Numbers on a picture of a fire."""
    file = out / f"{name}_{view}.png"
    seen = colours(file)
    if view == "thermal":
        seen = seen[:, : -round(_BAR * seen.shape[1])]
    share, _ = gallery_numbers.straight(brightness(seen))
    found = {
        "straight_per_cent": share,
        "median": gallery_numbers.median(brightness(seen)),
        "clipped_per_cent": gallery_numbers.clipped(seen),
    }
    smoky, clear = (out / f"{name}_{view}{end}.exr" for end in ("", "_clear"))
    if view in _SMOKE_OF and smoky.exists() and clear.exists():
        light = [np.asarray(sensor.read_image(each), np.float64)[..., :3] for each in (smoky, clear)]
        found |= gallery_numbers.dimensions(*light, brighter=_SMOKE_OF[view])
        found["dimension"] = gallery_numbers.dimension(found)
    return found


def drawn(out: Path, name: str, before: Path | None) -> Path:
    """A fire's sheet."""
    title = f"{name}: {gallery_fires.FIRES[name].title}"
    if before is None:
        cells = [(view, _there(out, name, view)) for view in VIEWS]
        return gallery_sheet.sheet(out / f"{name}.png", title, [cells[:3], cells[3:]])
    rows = []
    for pair in zip(VIEWS[::2], VIEWS[1::2], strict=True):
        cells = [
            (f"{view}, {when}", _there(folder, name, view))
            for view in pair
            for when, folder in (("before", before), ("now", out))
        ]
        rows.append(cells)
    return gallery_sheet.sheet(out / f"{name}.png", title + ", before and now", rows)


def _there(out: Path, name: str, view: str) -> Path | None:
    file = out / f"{name}_{view}.png"
    return file if file.exists() else None


def table(found: dict[str, dict]) -> str:
    """All numbers as a page of Markdown; what is not as asked for has an exclamation mark."""
    lines = [
        "| fire | view | " + " | ".join(_COLUMNS) + " |",
        "|---" * (2 + len(_COLUMNS)) + "|",
    ]
    for name, fire in found.items():
        for view, numbers in fire["views"].items():
            cells = [
                _cell(column, numbers.get(column), gallery_fires.FIRES[name].night or view in _DARK)
                for column in _COLUMNS
            ]
            lines.append(f"| {name} | {view} | " + " | ".join(cells) + " |")
    lines += ["", "| fire | flow, s | peak, MB | smoke |", "|---|---|---|---|"]
    for name, fire in found.items():
        flow = fire.get("flow", {})
        cells = [f"{flow[key]:.0f}" if key in flow else "" for key in ("seconds", "megabytes")]
        lines.append(f"| {name} | {' | '.join(cells)} | {flow.get('smoke', '')} |")
    return "\n".join(lines) + "\n"


def _cell(column: str, value: float | None, dark: bool) -> str:
    if value is None or not np.isfinite(value):
        return ""
    asked = gallery_numbers.within(column, value)
    if column == "median" and dark:
        asked = None
    return f"{value:.2f}" + ("!" if asked is False else "")


def main() -> None:
    """Make the gallery."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=Path, required=True, metavar="DIR")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--before", type=Path, metavar="OLD", help="the --out of another time")
    parser.add_argument(
        "--fires",
        nargs="+",
        choices=gallery_fires.FIRES,
        default=[*gallery_fires.FIRES],
    )
    parser.add_argument("--width", type=int, default=640, help="of pictures, px (%(default)s)")
    parser.add_argument("--samples", type=int, default=6)
    parser.add_argument(
        "--through",
        default="",
        metavar="WORDS",
        help="before each command, such as nice",
    )
    parser.add_argument("--again", action="store_true", help="measure what is there")
    given = parser.parse_args()
    file, found = given.out / "numbers.json", {}
    if file.exists():
        found = json.loads(file.read_text(encoding="utf-8"))
    for name in given.fires:
        fire = found.setdefault(name, {})
        if not given.again:
            run = gallery_fires.made(name, given.runs)
            night = gallery_fires.FIRES[name].night
            how = gallery_pictures.How(
                given.width,
                given.samples,
                night,
                tuple(given.through.split()),
            )
            fire |= gallery_pictures.made(name, run, given.out, how)
        views = [view for view in VIEWS if _there(given.out, name, view)]
        seen = fire.get("front_seen", {})
        fire["views"] = {
            view: measured(given.out, name, view) | ({"front_seen": seen[view]} if view in seen else {})
            for view in views
        }
        drawn(given.out, name, given.before)
        file.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    page = table(found)
    (given.out / "numbers.md").write_text(page, encoding="utf-8")
    print(page, end="")


if __name__ == "__main__":
    main()
