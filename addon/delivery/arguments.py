"""Command line of `firetwin deliver`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

PATTERN = "{camera}/{pass}/{camera}_{pass}.{frame}.{ext}"

DETAIL = """\
Copies the finished pictures and films of firetwin render into DIR/v001, DIR/v002 and so on. A version is
complete or missing, and is never overwritten. manifest.json and SHA256SUMS list its files with their hashes;
check them with: cd DIR/latest && sha256sum -c SHA256SUMS"""


def add(
    parser: argparse.ArgumentParser, path: Callable[[str], Path], whole_number: Callable[[str], int]
) -> None:
    """Add the arguments; `path` and `whole_number` are argument types."""
    parser.add_argument("film", metavar="FILM", type=path, help="folder of firetwin render")
    parser.add_argument("--out", metavar="DIR", type=path, required=True, help="folder of the versions")
    parser.add_argument(
        "--pattern",
        metavar="TEXT",
        default=PATTERN,
        help="file names, of {camera}, {pass}, {version}, {frame} and {ext} (%(default)s)",
    )
    parser.add_argument(
        "--start", metavar="N", type=whole_number, default=1001, help="number of the first frame (1001)"
    )
    parser.add_argument(
        "--version", dest="number", metavar="N", type=whole_number, help="number of the version (the next)"
    )
