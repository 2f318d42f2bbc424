"""`firetwin deliver`: finished files of a film as a version."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import FILMS, Command, add_overwrite

PATTERN = "{camera}/{pass}/{camera}_{pass}.{frame}.{ext}"

_DETAIL = """\
Copies the finished pictures and films of firetwin render into DIR/v001, DIR/v002 and so on. A version is
complete or missing, and is never overwritten. manifest.json and SHA256SUMS list its files with their hashes;
check them with: cd DIR/latest && sha256sum -c SHA256SUMS"""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("film", metavar="FILM", type=types.path, help="folder of firetwin render")
    parser.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder of the versions")
    parser.add_argument(
        "--pattern",
        metavar="TEXT",
        default=PATTERN,
        help="names in DIR/v001, of {camera}, {pass}, {version}, {frame} and {ext} (%(default)s)",
    )
    parser.add_argument(
        "--start", metavar="N", type=types.count, default=1001, help="number of the first frame (1001)"
    )
    parser.add_argument(
        "--version", dest="number", metavar="N", type=types.count, help="number of the version (the next)"
    )
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Deliver the finished files of a film."""
    from ..progress import Reporter, count, result, say, size
    from . import names, version

    names.check(arguments.pattern)
    found = names.choose(arguments.film, arguments.pattern, arguments.start)
    for text in found.messages:
        say(text)
    reporter = Reporter("copying")
    made = version.write(arguments.out, found, arguments.number, reporter, arguments.overwrite)
    say(f"delivered {count(len(found.files), 'file')} of {size(sum(each.bytes for each in found.files))}")
    result(made)


COMMAND = Command("deliver", "copy finished files into a version folder", _DETAIL, FILMS, _run, _add)
