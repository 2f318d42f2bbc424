"""Benchmarks for developers: speed and error of further steps, in addition to `firetwin bench`.

    .venv/bin/python tests/benchmarks                             lists all of them
    .venv/bin/python tests/benchmarks NAME ... [--runs N] [--json | --markdown] [--out DIR]

Prints the tables of subjects; `--out` also draws run time against error and size. The other files are studies
with their own arguments: `.venv/bin/python tests/benchmarks/NAME.py --help`.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
SUBJECTS = (
    "positions",
    "planting",
    "frame_change",
    "scattering",
    "flow_conservation",
    "particles",
    "planning",
)


def main() -> None:
    """List the benchmarks, or measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", metavar="NAME", nargs="*", choices=[[], *SUBJECTS], help=", ".join(SUBJECTS))
    parser.add_argument("--runs", metavar="N", type=int, default=1, help="repeated measurements (1)")
    parser.add_argument("--out", metavar="DIR", type=Path, help="folder for the plots")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON")
    form.add_argument("--markdown", action="store_true", help="write Markdown tables")
    options = parser.parse_args()
    if not options.names:
        print("\n".join(list_benchmarks()))
        return
    print(measure(options))


def list_benchmarks() -> list[str]:
    """List each subject and each study by name and the first line of its docstring."""
    scripts = sorted(path.stem for path in HERE.glob("*.py") if "\ndef main(" in path.read_text("utf-8"))
    studies = [name for name in scripts if name != "__main__"]
    return [f"{name:<22}{_summary(name)}" for name in (*SUBJECTS, *(f"{name}.py" for name in studies))]


def _summary(name: str) -> str:
    source = (HERE / name).with_suffix(".py").read_text("utf-8")
    return (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]


def measure(options: argparse.Namespace) -> str:
    """Measure subjects and format their report."""
    from firetwin.bench import measure_modules, table
    from firetwin.progress import Reporter

    sys.path.append(str(HERE.parent / "helpers"))
    paths = [str(HERE), os.environ.get("PYTHONPATH", "")]
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, paths))  # for processes that a subject starts
    report = measure_modules(options.names, options.runs, Reporter())
    if options.out:
        import plots

        plots.draw(report, options.out)
    if options.json:
        return json.dumps(report.as_json(), indent=1)
    return table.markdown(report) if options.markdown else table.page(report)


if __name__ == "__main__":
    main()
