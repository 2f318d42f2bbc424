"""`firetwin dataset`: labelled training data."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite, add_verb

VERBS = ("make", "formats", "check", "draw")
_MAKE = VERBS[0]
FORMATS = "coco,yolo"
"""Formats by default."""

_DETAIL = """\
Renders labelled samples of the runs of a plan, for the training of detectors of fire and smoke. Each sample
has a picture, its twin without smoke, alpha of smoke, depth, classes, a thermal picture, and metadata.

  firetwin dataset PLAN.toml --out DIR              make or continue the data set, with its formats and report
  firetwin dataset PLAN.toml --out DIR --estimate   print time, size and rejected cameras; make nothing
  firetwin dataset PLAN.toml --out DIR --only 0137  make these samples alone
  firetwin dataset formats DIR --format yolo,hf     write a finished data set in other formats
  firetwin dataset check DIR                        check files, hashes, labels, formats and splits
  firetwin dataset draw DIR --out FOLDER            draw the labels of samples onto their pictures

Several processes, also on several machines, can make one data set at the same time. A stopped process loses
only the samples that it had not finished. `examples/dataset.toml` shows every key of a plan."""


def _insert_verb(words: list[str]) -> tuple[list[str], list[str]]:
    """Insert the verb `make` in a command line without a verb."""
    has_verb = not words or words[0] in (*VERBS, "-h", "--help")
    return (words if has_verb else [_MAKE, *words]), []


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the verbs."""
    verbs = parser.add_subparsers(dest="verb", metavar="PLAN|VERB", required=True)

    make = add_verb(verbs, _MAKE, "make or continue a data set (the default verb)")
    make.add_argument("plan", metavar="PLAN.toml", type=types.path, help="plan of the data set")
    make.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder of the data set")
    make.add_argument(
        "--only", metavar="LIST", default="", help="samples to make, such as 0137 or 1-20 (all)"
    )
    make.add_argument("--estimate", action="store_true", help="print an estimate; make nothing")
    make.add_argument("--json", action="store_true", help="write the estimate as JSON")
    formats = add_verb(verbs, "formats", "write a finished data set in other formats")
    for each in (make, formats):
        help = f"formats of the labels, such as coco,yolo,hf, or all ({FORMATS})"
        each.add_argument("--format", metavar="LIST", default=FORMATS, help=help)
    check = add_verb(verbs, "check", "check a finished data set; the exit status is 1 if it has faults")
    draw = add_verb(verbs, "draw", "draw the labels of samples onto their pictures")
    draw.add_argument(
        "--out", metavar="FOLDER", type=types.path, required=True, help="folder of the pictures, PNG"
    )
    help = "samples to draw, such as 0137 or 1-20 (24 of them)"
    draw.add_argument("--only", metavar="LIST", default="", help=help)
    for each in (make, formats, draw):
        add_overwrite(each)
    for each in (formats, check, draw):
        each.add_argument("folder", metavar="DIR", type=types.path, help="folder of the data set")


def _run(arguments: argparse.Namespace) -> int:
    """Make labelled training data, or write it in other formats."""
    from . import verbs

    return verbs.run(arguments)


COMMAND = Command(
    "dataset", "make labelled training data from a plan", _DETAIL, FILMS, _run, _add, prepare=_insert_verb
)
