"""What each command of `cli` does; heavy modules are imported by the command that needs them."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .progress import Reporter, count, say

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from .shot.choice import Choice


def sample(arguments: argparse.Namespace) -> None:
    """Write the sample run."""
    from .data import sample

    say(f"writing the synthetic King-like run to {arguments.out}")
    sample.write(arguments.out, arguments.frames, arguments.format, Reporter("model times"))
    print(arguments.out)


def info(arguments: argparse.Namespace) -> None:
    """Show what is in a run."""
    from .run import info
    from .shot.settings import Time

    facts = info.gather(_open(arguments.run), Time().zone)
    if arguments.json:
        json.dump(facts, sys.stdout, indent=1)
        print()
    else:
        print(info.page(facts))


def maps(arguments: argparse.Namespace) -> None:
    """Draw the maps of a run."""
    run = _open(arguments.run)
    say("drawing the fuel map and the fire intensity map")
    from .run import maps
    from .shot.settings import Time

    for path in maps.draw(run, arguments.out, Time().zone):
        print(path)


def build(arguments: argparse.Namespace) -> None:
    """Build the scene and save it."""
    from .errors import UsageError
    from .jobs import build

    if arguments.out.suffix != ".blend":
        raise UsageError(f"-o: {arguments.out} does not end in .blend")
    build.run(_choice(arguments), arguments.out, Reporter(), say)
    print(arguments.out)


def bake(arguments: argparse.Namespace) -> None:
    """Write the smoke volumes."""
    from .jobs import bake

    places = bake.run(_choice(arguments), Reporter("smoke"), say)
    if not places:
        say("this scene has no smoke ([smoke] enabled = false), so there is nothing to bake")
    for place in places:
        print(place)


def render(arguments: argparse.Namespace) -> None:
    """Render what is asked for and not finished, then the films."""
    from .jobs import render

    asked = render.Asked(
        arguments.out, arguments.frames, arguments.camera, arguments.passes, arguments.resume
    )
    render.run(_choice(arguments), asked, Reporter(), say)
    _list(arguments.out)


def schema(arguments: argparse.Namespace) -> None:
    """Print the JSON Schema of scene files."""
    from .shot.json_schema import json_schema
    from .shot.settings import Settings

    print(json.dumps(json_schema(Settings), indent=1, ensure_ascii=False))


def bench(arguments: argparse.Namespace) -> int:
    """Measure, print the tables, and say whether every target is met."""
    from .bench import measure, plots, table

    report = measure(arguments.full, Reporter())
    text = json.dumps(report.as_json(), indent=1)
    if arguments.json:
        print(text)
    else:
        print(table.markdown(report) if arguments.markdown else table.page(report))
    if arguments.out:
        for path in plots.draw(report, arguments.out):
            say(f"wrote {path}")
        part = arguments.out / "bench.part.json"
        part.write_text(text + "\n", encoding="utf-8")
        part.replace(arguments.out / "bench.json")
    missed = sum(not target.met for target in report.targets)
    say(f"{len(report.targets) - missed} of {len(report.targets)} targets met")
    return 1 if missed else 0


def _list(out: Path) -> None:
    """Name what there is, a line per folder of pictures and per film."""
    from .render import store

    files = store.load(out)["files"]
    folders: dict[str, int] = {}
    for name in files:
        if not name.endswith(".mp4"):
            kind = f"{Path(name).parent}/*{Path(name).suffix}"
            folders[kind] = folders.get(kind, 0) + 1
    for kind, number in folders.items():
        print(f"{out / kind}  {count(number, 'picture')}")
    for name in files:
        if name.endswith(".mp4"):
            print(out / name)
    print(out / store.NAME)


def _open(folder: Path) -> Run:
    from .run import readers

    return readers.open(folder)


def _choice(arguments: argparse.Namespace) -> Choice:
    from .shot.choice import Choice

    return Choice(scene=str(arguments.scene))
