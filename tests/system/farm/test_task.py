"""Tasks of a farm as engines run them: twice, at once, stopped, on a full disk; and what assemble says."""

import json
import os
import signal
import subprocess

import pytest
from farm_film import firetwin, flow_scene, pictures, rendered, start, until, without
from firetwin.run.content import sha256

OTHER_3 = ["other/depth/other_depth_000003.exr", "other/rgb/other_rgb_000003.png"]


def test_tasks_make_the_film_of_one_process(film, tasks):
    assert pictures(tasks) == pictures(film[1])
    assert len(rendered(tasks)) == len(set(rendered(tasks))) == 21
    assert "4 done, 0 running, 0 failed, 0 waiting" in firetwin("farm", "status", tasks)


def test_a_task_that_runs_again_makes_nothing_that_is_whole(film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out")
    firetwin("farm", "task", out, 2)
    assert len(rendered(out)) == 21
    (out / OTHER_3[0]).unlink()
    (out / OTHER_3[1]).write_bytes(b"damaged")
    said = firetwin("farm", "assemble", out, status=1)
    assert said.splitlines() == ["other rgb 3: damaged or replaced", "other depth 3: not rendered"]
    firetwin("farm", "task", out, 4)
    assert sorted(rendered(out)[-3:]) == sorted(
        path for path in pictures(film[1]) if "other_" in path and "3." in path
    )
    firetwin("farm", "assemble", out)
    assert pictures(out) == pictures(film[1])


def test_a_task_that_runs_twice_at_once_ends_as_one(film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2)
    both = [start("farm", "task", out, 2) for _ in range(2)]
    for each in both:
        said = each.communicate(timeout=900)
        assert each.returncode == 0, said
    firetwin("farm", "assemble", out)
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == 21 + 6


def test_a_task_that_is_told_to_end_drops_its_frame_and_goes_on_later(film, tasks, tmp_path):
    out = without(tasks, tmp_path / "out", 2)
    place = tmp_path / "own"
    place.mkdir()
    task = start("farm", "task", out, 2, environment=os.environ | {"TMPDIR": str(place)})
    until(lambda: len(rendered(out)) > 21 - 6)  # the first of two frames
    task.send_signal(signal.SIGTERM)
    assert task.wait(60) == 143
    assert list(place.glob("firetwin-farm-*")) == []
    assert [path for path in out.rglob("*.part*") if "cache" not in path.parts] == []
    status = json.loads(firetwin("farm", "status", out, "--json"))
    assert status["failed"] == [2] or status["done"] == [1, 2, 3, 4]  # it may have been quicker
    firetwin("farm", "task", out, 2)
    firetwin("farm", "assemble", out)
    assert pictures(out) == pictures(film[1])
    assert len(rendered(out)) == len(set(rendered(out)))  # nothing whole was made again


def test_a_bake_that_is_told_to_end_goes_on_from_its_checkpoint(run_folder, tmp_path):
    path = flow_scene(tmp_path / "scene.toml", run_folder, 4)
    text = path.read_text()
    path.write_text(text.replace("cell_budget = 0.1", "cell_budget = 0.25").replace("21:06", "22:00"))
    stopped, whole = tmp_path / "stopped", tmp_path / "whole"
    for out in (stopped, whole):
        firetwin("farm", path, "--engine", "slurm", "--out", out)
    task = start("farm", "task", stopped, 1)
    until(lambda: list(stopped.rglob("state.npz")) or task.poll() is not None)
    if task.poll() is not None:
        pytest.skip("this machine solves the flow before there is a checkpoint")
    task.send_signal(signal.SIGTERM)
    assert task.wait(60) == 143
    first = [_first_progress(firetwin("farm", "task", out, 1)) for out in (stopped, whole)]
    assert first[0] > first[1] == 0.0
    assert _snapshots(stopped) == _snapshots(whole)
    assert len(_snapshots(whole)) >= 4


def _first_progress(said):
    return next(float(line.split()[1]) for line in said.splitlines() if line.startswith("openjd_progress"))


def _snapshots(out):
    folder = out / "farm" / "cache"
    return {path.relative_to(folder): sha256(path) for path in folder.rglob("moment_*.npz")}


def test_a_full_disk_is_a_reason_to_try_again(film, tasks, tmp_path):
    out, place = without(tasks, tmp_path / "out", 4), tmp_path / "small"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=24k", "tmpfs", place]
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("a small disk cannot be mounted here")
    try:
        firetwin("farm", "task", out, 4, environment=os.environ | {"TMPDIR": str(place)}, status=75)
    finally:
        subprocess.run(["umount", place], check=True)
    assert "disk is full" in firetwin("farm", "status", out)
    firetwin("farm", "task", out, 4)
    firetwin("farm", "assemble", out)
    assert pictures(out) == pictures(film[1])
