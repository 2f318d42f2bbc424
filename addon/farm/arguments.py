"""The command line of `firetwin farm`; nothing heavy is imported here."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

_ENGINES = Path(__file__).parent / "engines"
VERBS = ("plan", "status", "resume", "cancel", "task", "assemble")
_PLAN = VERBS[0]

DETAIL = """\
Plans the film as stages of tasks (bake, render, assemble), writes DIR/farm, and prints the command that
submits it, or submits it. What follows `--` goes to the engine's own command.

  firetwin farm SCENE.toml --engine slurm --out DIR --submit -- --partition=gpu --time=4:00:00
  firetwin farm status DIR     tasks and pictures that are done, running, failed and waiting; time left
  firetwin farm resume DIR     reads all pictures and submits the tasks of those that are missing
  firetwin farm cancel DIR     cancels what was submitted

Engines run `firetwin farm task DIR N` and `firetwin farm assemble DIR`. Exit status: 0 done, 1 failed (of
assemble: pictures are missing), 2 wrong input, 75 no device or disk now, 143 ended by SIGTERM."""


def normal(argv: list[str]) -> tuple[list[str], list[str]]:
    """A command line of ours with the verb written out, and what follows `--`."""
    if argv[:1] != ["farm"]:
        return argv, []
    at = argv.index("--") if "--" in argv else len(argv)
    ours, options = argv[1:at], argv[at + 1 :]
    if ours and ours[0] not in (*VERBS, "-h", "--help"):
        ours = [_PLAN, *ours]
    return ["farm", *ours], options


def _engines() -> list[str]:
    """Names of all engines; none is loaded."""
    return sorted(path.stem for path in _ENGINES.glob("[a-z]*.py"))


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], count: Callable[[str], int]) -> None:
    """Define the verbs.

    Parameters
    ----------
    path, count
        Types of arguments.
    """
    verbs = parser.add_subparsers(dest="verb", metavar="SCENE|VERB", required=True)

    def verb(name: str, summary: str) -> argparse.ArgumentParser:
        found = verbs.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        found.add_argument("--debug", action="store_true", help="show a traceback when something fails")
        return found

    plan = verb(_PLAN, "plan a film and write the engine's job (the verb may be left out)")
    plan.add_argument("scene", metavar="SCENE|RUN", type=path, help="scene file, or run folder")
    plan.add_argument("--engine", choices=_engines(), required=True, help="engine that runs the tasks")
    plan.add_argument(
        "--out", metavar="DIR", type=path, required=True, help="folder for the film and the job"
    )
    plan.add_argument(
        "--chunk",
        metavar="N",
        type=count,
        help="frames per task at most (30)",
    )
    plan.add_argument("--submit", action="store_true", help="submit the job")
    for name, summary in (
        ("status", "print the progress of a job, from its files alone"),
        ("resume", "submit the tasks whose pictures are missing or damaged"),
        ("cancel", "cancel what was submitted"),
        ("task", "run tasks of a job, as engines do"),
        ("assemble", "check and enter all pictures, and make films and manifest"),
    ):
        found = verb(name, summary)
        found.add_argument("out", metavar="DIR", type=path, help="folder of the film")
        if name == "status":
            found.add_argument("--json", action="store_true", help="write JSON")
        if name in ("task", "assemble"):
            found.add_argument(
                "--scene", metavar="FILE", type=path, help="scene file here (where it was planned)"
            )
        if name == "task":
            found.add_argument("numbers", metavar="N", help="numbers of tasks, such as 7 or 3-5")
