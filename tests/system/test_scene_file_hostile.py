"""Scene files with anything in them, in a process with Blender in it: if that ends, it is a finding."""

import subprocess
import sys
from pathlib import Path

FUZZ = Path(__file__).parent / "fuzz/scenes.py"


def test_scenes_are_built_or_refused_politely():
    command = [sys.executable, FUZZ, "--cases", "80", "--builds", "4", "--jobs", "1", "--seed", "3"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "build: done" in done.stdout
