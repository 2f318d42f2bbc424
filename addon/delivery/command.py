"""The command `firetwin deliver`."""

from __future__ import annotations

import argparse

from ..progress import Reporter, count, result, say, size


def run(arguments: argparse.Namespace) -> None:
    """Deliver the finished files of a film."""
    from . import names, version

    names.check(arguments.pattern)
    found = names.choose(arguments.film, arguments.pattern, arguments.start)
    for text in found.messages:
        say(text)
    made = version.write(arguments.out, found, arguments.number, Reporter("copying"))
    say(f"delivered {count(len(found.files), 'file')} of {size(sum(each.bytes for each in found.files))}")
    result(made)
