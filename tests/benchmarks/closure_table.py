"""Closure of smoke and heat: sums over snapshots of solved smoke against the emission of 33 small fires.

    .venv/bin/python tests/benchmarks/closure_table.py [NAME ...]

Each case is a fire (`FIRES` of tests/helpers/closure.py) over one of three terrains, solved in a box and a
nest of few cells. Columns are relative errors in percent: smoke in the cells of a snapshot plus outflow
against emission, for box and nest; power of the shot's sources against the run's flux times area, between
model times; and heat in the solved air against the convective share of these sources.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import astuple
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

import closure


def main() -> None:
    """Measure the cases and print them as a Markdown table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", metavar="NAME", nargs="*", help="fires or terrains; default: all")
    wanted = parser.parse_args().names
    cases = [case for case in closure.CASES if not wanted or set(wanted) & set(case)]
    print("| fire | terrain | smoke, box | smoke, nest | heat, sources | heat, air |")
    print("|---|---|--:|--:|--:|--:|")
    worst = 0.0
    for fire, terrain in cases:
        with tempfile.TemporaryDirectory() as folder:
            errors = astuple(closure.measure(closure.make_shot(Path(folder) / "run", fire, terrain)))
        worst = max(worst, *map(abs, errors))
        cells = [fire, terrain, *(f"{100.0 * error:+.3f}" for error in errors)]
        print(f"| {' | '.join(cells)} |", flush=True)
    print(f"\n{len(cases)} cases; largest error {100.0 * worst:.2f} %")


if __name__ == "__main__":
    main()
