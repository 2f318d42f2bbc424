"""Verb `info` of `firetwin tiles`."""

from __future__ import annotations

import argparse
import json

from ..errors import Error
from ..progress import count, notify_if_slow, result
from . import info
from .loader import Loader
from .sources import Network, Source, open_source

_MAX_SERVER_FILES = 50  # of a server


def run(arguments: argparse.Namespace, network: Network) -> None:
    """List the content of a tileset.

    Raises
    ------
    Error
        A file is missing, with `--strict`.
    """
    source = open_source(arguments.source, network)
    try:
        with notify_if_slow(f"reading {source.name(source.root)}"):
            facts = info.gather(Loader(source), arguments.files or _default_files(source))
    finally:
        source.close()
    result(json.dumps(facts, indent=1) if arguments.json else info.format_text(facts))
    if arguments.strict and facts["missing"]:
        raise Error(
            f"--strict: {count(len(facts['missing']), 'file')} missing: {'; '.join(facts['missing'])}"
        )


def _default_files(source: Source) -> int | None:
    """Return the default limit on files to read."""
    if not source.policy.may_prefetch:
        return 1
    return None if source.local else _MAX_SERVER_FILES
