"""Damage files of every fire model and convert them: a run or one polite line, or it is a finding.

    .venv/bin/python tests/system/fuzz/convert.py [--each 1000] [--jobs 2] [--seed 0] [KIND ...]

A damaged file that is a finding is left in build/fuzz/findings; exit status 1.
"""

import argparse
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "helpers"))

import damage


def work(kind, each, seed):
    """Count the results of damaged files of a kind, and list findings."""
    ends, findings, guessed = Counter(), [], 0
    with tempfile.TemporaryDirectory() as folder:
        for end in damage.tried(kind, Path(folder), each, seed):
            ends["signal" if end.signal else "refused" if end.said else "read"] += 1
            guessed += "is damaged or incomplete: " in end.said
            findings += [f"{kind}: {end.way}: {end.wrong}: {end.said[:400]!r}"] if end.wrong else []
    print(f"fuzz: {kind}: {dict(ends)}; refused by what nobody foresaw: {guessed}", flush=True)
    return findings


def main():
    """Share the kinds out, and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("each", 1000), ("jobs", 2), ("seed", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("kinds", metavar="KIND", nargs="*", help=", ".join(damage.KINDS))
    asked = parser.parse_args()
    with ThreadPoolExecutor(asked.jobs) as pool:
        found = pool.map(lambda kind: work(kind, asked.each, asked.seed), asked.kinds or damage.KINDS)
        findings = [line for lines in found for line in lines]
    print(*findings, sep="\n")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
