"""Damage tilesets, subtrees and .3tz archives and read them: a tree or an InputError, or it is a finding.

    .venv/bin/python tests/system/fuzz/tilesets.py [--runs 100000] [--seed 0] [KIND ...]

KIND is json, subtree or archive. An input that takes over 5 s of processor time is a finding, too.
A damaged file that is one is left in build/fuzz/findings; exit status 1.
"""

import argparse
import sys
import tempfile
import time
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "helpers"))

from damage import WAYS, damaged
from firetwin.errors import InputError
from firetwin.tiles.loader import Loader
from firetwin.tiles.sources.archive import Archive
from tile_samples import SAMPLES
from tilesets import Memory, as_bytes

SECONDS = 5.0
FINDINGS = Path("build/fuzz/findings")
KINDS = {"json": ".json", "subtree": ".subtree", "archive": ".3tz"}


def seeds(kind):
    """Sound files of a kind: the files that surround each, its name, and its bytes."""
    for files in SAMPLES.values():
        files = {name: as_bytes(value) for name, value in files.items()}
        if kind == "archive":
            yield {}, "a.3tz", packed(files)
        else:
            yield from ((files, name, data) for name, data in files.items() if name.endswith(KINDS[kind]))


def packed(files):
    """A .3tz archive."""
    with tempfile.TemporaryFile() as file:
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in files.items():
                archive.writestr(name, data)
        file.seek(0)
        return file.read()


def read(files, name, data, folder):
    """Read a whole tileset of which one file is damaged."""
    if not name.endswith(".3tz"):
        source = Memory(files | {name: data})
    else:
        path = folder / name
        path.write_bytes(data)
        source = Archive(path)
    try:
        loader = Loader(source)
        loader.expand_all(100)
        loader.check(range(min(len(loader.tree.content), 10)))
    finally:
        source.close()


def work(kind, runs, seed, folder):
    """Number of findings of a kind."""
    rng, ends, found = np.random.default_rng(seed), Counter(), list(seeds(kind))
    for run in range(runs):
        files, name, data = found[run % len(found)]
        data = damaged(data, WAYS[run // len(found) % len(WAYS)], rng)
        began, wrong = time.process_time(), ""
        try:
            read(files, name, data, folder)
            ends["read"] += 1
        except InputError:
            ends["refused"] += 1
        except Exception as error:
            wrong = repr(error)
        if (took := time.process_time() - began) > SECONDS:
            wrong = f"took {took:.1f} s"
        if wrong:
            ends["finding"] += 1
            FINDINGS.mkdir(parents=True, exist_ok=True)
            (FINDINGS / f"{kind}-{seed}-{run}{KINDS[kind]}").write_bytes(data)
            print(f"fuzz: {kind}, run {run}: {wrong[:400]}", flush=True)
    print(f"fuzz: {kind}: {dict(ends)}", flush=True)
    return ends["finding"]


def main():
    """Damage files of each kind, and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("kinds", metavar="KIND", nargs="*", choices=[*KINDS, []], help=", ".join(KINDS))
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = [work(kind, asked.runs, asked.seed, Path(folder)) for kind in asked.kinds or KINDS]
    return 1 if any(found) else 0


if __name__ == "__main__":
    sys.exit(main())
