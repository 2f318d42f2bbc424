"""Benchmarks for developers: speed and error of further steps, in addition to `firetwin bench`.

    .venv/bin/python tests/benchmarks                             lists all of them
    .venv/bin/python tests/benchmarks NAME ...

Prints the tables of subjects. The other files are studies with their own arguments:
`.venv/bin/python tests/benchmarks/NAME.py --help`.
"""

from __future__ import annotations

import argparse
import ast
import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
SUBJECTS = (
    "positions",
    "planting",
    "interpolation",
    "motion",
    "ensembles",
    "frame_change",
    "scattering",
    "flow_conservation",
    "particles",
)


def main() -> None:
    """List the benchmarks, or measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", metavar="NAME", nargs="*", choices=[[], *SUBJECTS], help=", ".join(SUBJECTS))
    names = parser.parse_args().names
    print(measure_subjects(names) if names else "\n".join(list_benchmarks()))


def list_benchmarks() -> list[str]:
    """List each subject and each study by name and the first line of its docstring."""
    scripts = sorted(path.stem for path in HERE.glob("*.py") if "\ndef main(" in path.read_text("utf-8"))
    studies = [name for name in scripts if name != "__main__"]
    return [f"{name:<22}{_summary(name)}" for name in (*SUBJECTS, *(f"{name}.py" for name in studies))]


def _summary(name: str) -> str:
    source = (HERE / name).with_suffix(".py").read_text("utf-8")
    return (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]


def measure_subjects(names: list[str]) -> str:
    """Measure subjects and format their report."""
    from firetwin.bench import measure, table
    from firetwin.progress import Reporter

    sys.path.append(str(HERE.parent / "helpers"))
    paths = [str(HERE), os.environ.get("PYTHONPATH", "")]
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, paths))  # for processes that a subject starts
    return table.page(measure(names, Reporter()))


if __name__ == "__main__":
    main()
