"""Developers' benchmarks: tools compute equal results, errors are errors, and all are listed."""

import importlib
import subprocess
import sys
from pathlib import Path

import flow_conservation
import numpy as np
import particles
import positions
import pytest
from firetwin.bench.harness import ORIGIN
from firetwin_core.geo import LocalFrame
from module_file import load_module

FOLDER = Path(__file__).parents[3] / "tests/benchmarks"


def benchmarks(*words):
    return subprocess.run([sys.executable, FOLDER, *words], capture_output=True, text=True)


def test_every_benchmark_is_listed_by_what_it_compares():
    done = benchmarks()
    assert done.returncode == 0
    lines = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    scripts = {path.name for path in FOLDER.glob("*.py") if f"benchmarks/{path.name}" in path.read_text()}
    assert scripts == {name for name in lines if name.endswith(".py")}
    subjects = {path.stem for path in FOLDER.glob("*.py") if "\ndef run(bench: Bench)" in path.read_text()}
    assert subjects == {name for name in lines if not name.endswith(".py")}
    assert all(callable(importlib.import_module(name).run) for name in subjects)


def test_a_subject_is_measured_and_printed(monkeypatch, capsys):
    module = load_module(FOLDER / "__main__.py", "benchmarks")
    monkeypatch.setattr(particles, "run", lambda bench: bench.row("60 steps/s", "firetwin", None, 1, "s"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    monkeypatch.setenv("PYTHONPATH", "")
    monkeypatch.setattr(sys, "argv", ["benchmarks", "particles"])
    module.main()
    assert "  60 steps/s " in capsys.readouterr().out
    monkeypatch.setattr(sys, "argv", ["benchmarks", "sailing"])
    with pytest.raises(SystemExit):
        module.main()


def test_errors_of_positions_are_errors():
    pytest.importorskip("mpmath")
    points = np.array([38.5, 39.1]), np.array([-121.0, -120.2]), np.array([200.0, 3000.0])
    enu = LocalFrame(*ORIGIN).forward(*points)
    assert positions.error(points, enu) < 5e-9
    assert positions.error(points, enu + np.array([0, 0, 1e-3])) == pytest.approx(1e-3)


def test_the_flow_keeps_heat_and_smoke():
    given, held = flow_conservation.warmed()
    assert given < 1e-9
    assert held < 1e-4
    assert flow_conservation.written() < 1e-6
