"""A film by Open Job Description's own command: its job is checked and run."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from farm_film import firetwin, pictures, rendered

VERSION = "0.8.0"
PLACE = Path(__file__).parents[3] / "build" / "openjd"


@pytest.fixture(scope="module")
def openjd():
    """Environment with openjd-cli, from a virtual environment of its own."""
    command = PLACE / "bin" / "openjd"
    if not command.exists():
        made = [sys.executable, "-m", "venv", PLACE]
        got = [PLACE / "bin" / "pip", "install", "-q", f"openjd-cli=={VERSION}"]
        for each in (made, got):
            done = subprocess.run(each, capture_output=True, text=True)
            if done.returncode:
                pytest.skip(f"openjd-cli cannot be installed here: {done.stderr.strip()[-300:]}")
    return os.environ | {"PATH": f"{PLACE / 'bin'}:{os.environ['PATH']}"}


def test_a_film_by_openjd_is_that_of_one_process(openjd, film, tmp_path):
    path, one = film
    out = tmp_path / "out"
    command = firetwin("farm", path, "--engine", "openjd", "--out", out, "--chunk", 2)
    template = out / "farm" / "openjd" / "template.json"
    check = subprocess.run(["openjd", "check", template], env=openjd, capture_output=True, text=True)
    assert check.returncode == 0, check.stdout + check.stderr
    done = subprocess.run(shlex.split(command), env=openjd, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert "openjd_progress: 100.0" in done.stdout
    assert pictures(out) == pictures(one)
    assert len(rendered(out)) == len(set(rendered(out))) == 21
