"""Command line of `firetwin farm`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

_ENGINES = Path(__file__).parent / "engines"
VERBS = ("plan", "status", "resume", "cancel", "task", "assemble")
_PLAN = VERBS[0]

DETAIL = """\
Divides the film into tasks in three stages (bake, render, assemble), writes the job to DIR/farm and prints
the command that submits it; --submit runs that command. Options after `--` go to the scheduler's command.

  firetwin farm SCENE.toml --engine slurm --out DIR --submit -- --partition=gpu --time=4:00:00
  firetwin farm status DIR     tasks and pictures that are done, running, failed or waiting; remaining time
  firetwin farm resume DIR     check all pictures and submit the tasks of missing or damaged ones
  firetwin farm cancel DIR     cancel the submitted tasks

Schedulers run `firetwin farm task DIR N` and `firetwin farm assemble DIR`. Exit status: 0 done, 1 failed
(assemble: pictures are missing), 2 invalid input, 75 no GPU or disk space now, 143 ended by SIGTERM."""


def split_options(argv: list[str]) -> tuple[list[str], list[str]]:
    """Split a command line at `--`, and insert the verb `plan` if no verb is given."""
    if argv[:1] != ["farm"]:
        return argv, []
    at = argv.index("--") if "--" in argv else len(argv)
    ours, options = argv[1:at], argv[at + 1 :]
    if ours and ours[0] not in (*VERBS, "-h", "--help"):
        ours = [_PLAN, *ours]
    return ["farm", *ours], options


def _engines() -> list[str]:
    """List the schedulers by file name, without loading them."""
    return sorted(path.stem for path in _ENGINES.glob("[a-z]*.py"))


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], count: Callable[[str], int]) -> None:
    """Define the verbs.

    Parameters
    ----------
    path, count
        Argument types: convert text to a path, and to a positive integer.
    """
    verbs = parser.add_subparsers(dest="verb", metavar="SCENE|VERB", required=True)

    def verb(name: str, summary: str) -> argparse.ArgumentParser:
        found = verbs.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        found.add_argument("--debug", action="store_true", help="show a traceback when something fails")
        return found

    plan = verb(_PLAN, "plan a film and write the scheduler's job (the default verb)")
    plan.add_argument("scene", metavar="SCENE|RUN", type=path, help="scene file, or run folder")
    plan.add_argument("--engine", choices=_engines(), required=True, help="scheduler that runs the tasks")
    plan.add_argument(
        "--out", metavar="DIR", type=path, required=True, help="folder for the film and the job"
    )
    plan.add_argument(
        "--chunk",
        metavar="N",
        type=count,
        help="maximum frames per task (30)",
    )
    plan.add_argument("--submit", action="store_true", help="submit the job")
    for name, summary in (
        ("status", "print the progress of a job, read from its files"),
        ("resume", "submit the tasks whose pictures are missing or damaged"),
        ("cancel", "cancel the submitted tasks"),
        ("task", "run tasks of a job; schedulers call this"),
        ("assemble", "check all pictures, then write films and manifest"),
    ):
        found = verb(name, summary)
        found.add_argument("out", metavar="DIR", type=path, help="folder of the film")
        if name == "status":
            found.add_argument("--json", action="store_true", help="write JSON")
        if name in ("task", "assemble"):
            found.add_argument(
                "--scene", metavar="FILE", type=path, help="scene file on this machine (path at planning)"
            )
        if name == "task":
            found.add_argument("numbers", metavar="N", help="task numbers, such as 7 or 3-5")
