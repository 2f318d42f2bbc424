"""`firetwin info`: the content of a run."""

from __future__ import annotations

import argparse
import json
import sys

from .. import argument_types as types
from ..command import RUNS, Command
from ..progress import result, say
from ._scene_runs import is_scene, list_runs

_DETAIL = """\
Lists grid, extent, fuels, times, heat flux, energy, burned area and warnings, and reported acreages if the
run depicts a known fire."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "run", metavar="RUN", type=types.path, help="run or ensemble folder, or a scene file for all its runs"
    )
    parser.add_argument("--json", action="store_true", help="write JSON")


def _run(arguments: argparse.Namespace) -> None:
    """Show the contents of a run, or of all runs of a scene file."""
    from ..run import info, readers, zone
    from ..shot.source import ShotSource

    if is_scene(arguments.run):
        shot = ShotSource(scene=str(arguments.run)).shot()
        runs = list_runs(shot)
        say(shot.describe_film())
        facts = {name: info.gather(run, zone.time_zone(run)) for name, run in runs.items()}
        page = "\n\n".join(f"{name}: {runs[name].path}\n{info.page(each)}" for name, each in facts.items())
    else:
        run = readers.open(arguments.run)
        facts = info.gather(run, zone.time_zone(run))
        page = info.page(facts)
    if arguments.json:
        json.dump(facts, sys.stdout, indent=1)
        print()
    else:
        result(page)


COMMAND = Command("info", "list the content of a run", _DETAIL, RUNS, _run, _add)
