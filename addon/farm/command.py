"""`firetwin farm`: a film on a render farm."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import argument_types as types
from ..command import FILMS, Command, add_verb

_ENGINES = Path(__file__).parent / "engines"
VERBS = ("plan", "status", "resume", "cancel", "task", "assemble")
_PLAN = VERBS[0]

_DETAIL = """\
Divides the film into tasks in three stages (bake, render, assemble), writes the job to DIR/farm and prints
the command that submits it; --submit runs that command. Options after `--` go to the scheduler's command.

  firetwin farm SCENE.toml --engine slurm --out DIR --submit -- --partition=gpu --time=4:00:00
  firetwin farm status DIR     tasks and pictures that are done, running, failed or waiting; remaining time
  firetwin farm resume DIR     check all pictures and submit the tasks of missing or damaged ones
  firetwin farm cancel DIR     cancel the submitted tasks

Schedulers run `firetwin farm task DIR N` and `firetwin farm assemble DIR`. Exit status: 0 done, 1 failed
(assemble: pictures are missing), 2 invalid input, 75 no GPU or disk space now, 143 ended by SIGTERM."""


def _split_options(words: list[str]) -> tuple[list[str], list[str]]:
    """Split words at `--`, and insert the verb `plan` if no verb is given."""
    at = words.index("--") if "--" in words else len(words)
    ours, options = words[:at], words[at + 1 :]
    if ours and ours[0] not in (*VERBS, "-h", "--help"):
        ours = [_PLAN, *ours]
    return ours, options


def _engines() -> list[str]:
    """List the schedulers by file name, without loading them."""
    return sorted(path.stem for path in _ENGINES.glob("[a-z]*.py"))


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the verbs."""
    verbs = parser.add_subparsers(dest="verb", metavar="SCENE|VERB", required=True)

    plan = add_verb(verbs, _PLAN, "plan a film and write the scheduler's job (the default verb)")
    plan.add_argument("scene", metavar="SCENE|RUN", type=types.path, help="scene file, or run folder")
    plan.add_argument("--engine", choices=_engines(), required=True, help="scheduler that runs the tasks")
    plan.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the film and the job"
    )
    plan.add_argument(
        "--chunk",
        metavar="N",
        type=types.count,
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
        verb = add_verb(verbs, name, summary)
        verb.add_argument("out", metavar="DIR", type=types.path, help="folder of the film")
        if name == "status":
            verb.add_argument("--json", action="store_true", help="write JSON")
        if name in ("task", "assemble"):
            verb.add_argument(
                "--scene",
                metavar="FILE",
                type=types.path,
                help="scene file on this machine (path at planning)",
            )
        if name == "task":
            verb.add_argument("numbers", metavar="N", help="task numbers, such as 7 or 3-5")


def _run(arguments: argparse.Namespace) -> int | None:
    """Plan, run or follow a farm job."""
    from . import verbs

    return verbs.run(arguments)


COMMAND = Command("farm", "plan a film for a render farm", _DETAIL, FILMS, _run, _add, prepare=_split_options)
