"""Data sets of real processes: after kills, side by side, and on a full disk."""

import collections
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import fake_samples
import pytest
import small_plan

COUNT = 60
PLAN = f"""\
count = {COUNT}
seed = 3
moments = 3
[cameras]
tower = 0
aircraft = 0
[[runs]]
place = "A"
run = "a"
[[runs]]
place = "B"
run = "b"
"""


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plan")
    for name in "ab":
        small_plan.write_run(folder / name, cells=32)
    (folder / "plan.toml").write_text(PLAN)
    return folder / "plan.toml"


def start(plan, out, pause=0.0):
    out.parent.mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, fake_samples.__file__, plan, out],
        env={**os.environ, "PYTHONPATH": str(Path(fake_samples.__file__).parent), "FAKE_PAUSE": str(pause)},
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_for(out, count):
    while len(fake_samples.log(out)) < count:
        time.sleep(0.02)


@pytest.fixture(scope="module")
def undisturbed(plan, tmp_path_factory):
    out = tmp_path_factory.mktemp("whole") / "set"
    process = start(plan, out)
    assert process.wait() == 0, process.stderr.read()
    return fake_samples.content(out)


def test_killed_producers_lose_nothing_and_make_nothing_twice(plan, undisturbed, tmp_path):
    out = tmp_path / "work" / "set"
    first, second = (start(plan, out, pause=0.03) for _ in range(2))
    wait_for(out, 12)
    first.send_signal(signal.SIGKILL)
    wait_for(out, 25)
    third = start(plan, out, pause=0.03)
    second.send_signal(signal.SIGKILL)
    assert third.wait() == 0, third.stderr.read()
    assert fake_samples.content(out).keys() - undisturbed.keys() <= {
        path for path in fake_samples.content(out) if ".part" in path
    }
    assert {path: fake_samples.content(out)[path] for path in undisturbed} == undisturbed
    made = collections.Counter(fake_samples.log(out))
    assert len(made) >= COUNT - 2  # a kill can meet a sample between its files and the log
    assert sum(made.values()) <= COUNT


def test_a_full_disk_is_one_line_and_the_data_set_continues_with_more_room(plan, undisturbed):
    place = Path("/tmp") / f"firetwin-full-{os.getpid()}"
    place.mkdir()
    if subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=700k", "tmpfs", place], capture_output=True
    ).returncode:
        place.rmdir()
        pytest.skip("cannot mount a small disk here")
    try:
        out = place / "set"
        process = start(plan, out)
        assert process.wait() == 1
        assert "FullDiskError" in process.stderr.read()
        before = fake_samples.log(out)
        assert 0 < len(before) < COUNT
        assert not [path for path in fake_samples.content(out) if ".part" in path]
        subprocess.run(["mount", "-o", "remount,size=20m", place], check=True)
        process = start(plan, out)
        assert process.wait() == 0, process.stderr.read()
        assert sorted(fake_samples.log(out)) == list(range(1, COUNT + 1))
        assert fake_samples.content(out) == undisturbed
    finally:
        subprocess.run(["umount", place], check=True)
        place.rmdir()
