"""Command line of `firetwin dataset`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

VERBS = ("make", "formats", "check", "draw")
_MAKE = VERBS[0]
_FORMATS = "coco,yolo"

DETAIL = """\
Renders labelled samples of the runs of a plan, for the training of detectors of fire and smoke. Each sample
has a picture, its twin without smoke, alpha of smoke, depth, classes, a thermal picture, and metadata.

  firetwin dataset PLAN.toml --out DIR              make or continue the data set, with its formats and report
  firetwin dataset PLAN.toml --out DIR --estimate   print time, size and rejected cameras; make nothing
  firetwin dataset PLAN.toml --out DIR --only 0137  make these samples alone
  firetwin dataset formats DIR --format yolo,voc    write a finished data set in other formats
  firetwin dataset check DIR                        check files, hashes, labels, formats and splits
  firetwin dataset draw DIR --out FOLDER            draw the labels of samples onto their pictures

Several processes, also on several machines, can make one data set at the same time. A stopped process loses
only the samples that it had not finished. `examples/dataset.toml` shows every key of a plan."""


def insert_verb(argv: list[str]) -> list[str]:
    """Insert the verb `make` in a command line without a verb."""
    if argv[:1] == ["dataset"] and len(argv) > 1 and argv[1] not in (*VERBS, "-h", "--help"):
        return ["dataset", _MAKE, *argv[1:]]
    return argv


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path]) -> None:
    """Define the verbs; `path` is the argument type of paths."""
    verbs = parser.add_subparsers(dest="verb", metavar="PLAN|VERB", required=True)

    def verb(name: str, summary: str) -> argparse.ArgumentParser:
        found = verbs.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        found.add_argument("--debug", action="store_true", help="show a traceback when something fails")
        return found

    make = verb(_MAKE, "make or continue a data set (the default verb)")
    make.add_argument("plan", metavar="PLAN.toml", type=path, help="plan of the data set")
    make.add_argument("--out", metavar="DIR", type=path, required=True, help="folder of the data set")
    make.add_argument(
        "--only", metavar="LIST", default="", help="samples to make, such as 0137 or 1-20 (all)"
    )
    make.add_argument("--estimate", action="store_true", help="print an estimate; make nothing")
    make.add_argument("--json", action="store_true", help="write the estimate as JSON")
    formats = verb("formats", "write a finished data set in other formats")
    for each in (make, formats):
        help = f"formats of the labels, such as coco,yolo,voc, or all ({_FORMATS})"
        each.add_argument("--format", metavar="LIST", default=_FORMATS, help=help)
    check = verb("check", "check a finished data set; the exit status is 1 if it has faults")
    draw = verb("draw", "draw the labels of samples onto their pictures")
    draw.add_argument("--out", metavar="FOLDER", type=path, required=True, help="folder of the pictures, PNG")
    help = "samples to draw, such as 0137 or 1-20 (24 of them)"
    draw.add_argument("--only", metavar="LIST", default="", help=help)
    for each in (formats, check, draw):
        each.add_argument("folder", metavar="DIR", type=path, help="folder of the data set")
