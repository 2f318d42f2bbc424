"""Farm jobs of data sets: tasks of complete scenes, status by finished samples."""

import json

import pytest
from firetwin.dataset import truth
from firetwin.farm import assemble, dataset_job, plan, status, submission
from firetwin.farm.engines import Batch, known
from firetwin.render import fingerprint

SCENES = ["1,4-5", "2-3", "6-12", "13"]


@pytest.fixture
def job(tmp_path, monkeypatch):
    calls = []

    def call(arguments, capture=False):
        calls.append(arguments)
        return json.dumps({"count": 13, "scenes": SCENES})

    monkeypatch.setattr(dataset_job, "_call", call)
    (tmp_path / "plan.toml").write_text('[[runs]]\nplace = "A"\nrun = "a"\n')
    found = dataset_job.make_job(tmp_path / "plan.toml", tmp_path / "out", 6)
    plan.write(found, tmp_path / "out")
    return found, tmp_path / "out", calls


def write(out, index):
    path = out / dataset_job.FOLDER / truth.FOLDER / f"{truth.stem(index)}.json"
    assert path == truth.path(out / dataset_job.FOLDER, index)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()


def test_a_task_has_complete_scenes(job):
    found, out, calls = job
    assert [task.frames for task in found.tasks] == ["1-5", "6-12", "13"]
    assert plan.read(out) == found
    assert calls == [[str(out.parent / "plan.toml"), "--out", str(out / "dataset"), "--estimate", "--json"]]


def test_a_plan_is_told_from_a_scene_by_its_places(tmp_path):
    path = tmp_path / "a.toml"
    for text, is_plan in (
        ('[[runs]]\nplace = "A"\nrun = "a"\n', True),
        ('run = "a"\n[[runs]]\nname = "B"\npath = "b"\n', False),
        ("not TOML", False),
    ):
        path.write_text(text)
        assert dataset_job.is_plan(path) == is_plan
    assert not dataset_job.is_plan(tmp_path)


def test_progress_and_resubmission_go_by_finished_samples(job):
    found, out, _ = job
    assert (status.gather(out).pictures, status.gather(out).finished) == (13, 0)
    assert status.gather(out).waiting == [1, 2, 3]
    for index in (*range(1, 6), 7):
        write(out, index)
    assert status.gather(out).done == [1]
    missing, numbers = submission.find_missing(out)
    assert [each.frame for each in missing] == [6, *range(8, 14)]
    assert numbers == [2, 3]
    assert list(assemble.format_missing(missing)) == ["sample labels 6,8-13: not rendered"]
    assert sum(1 for task in found.tasks for _ in found.pictures(task)) == 13


def test_the_last_stage_finishes_a_complete_data_set_alone(job, monkeypatch):
    found, out, calls = job
    monkeypatch.setattr(fingerprint, "versions", lambda: found.versions)
    assert len(assemble.run(out)) == 13
    assert len(calls) == 1
    for index in range(1, 14):
        write(out, index)
    assert assemble.run(out) == {}
    assert calls[1:] == [[str(out.parent / "plan.toml"), "--out", str(out / "dataset")]]


@pytest.mark.parametrize("engine", sorted(known()))
def test_every_scheduler_gets_the_tasks(job, engine):
    found, out, _ = job
    known()[engine]().write(Batch(found, out, (1, 2, 3)))
    written = "".join(path.read_text() for path in (out / "farm" / engine).rglob("*") if path.is_file())
    assert "farm" in written
    assert "task" in written
