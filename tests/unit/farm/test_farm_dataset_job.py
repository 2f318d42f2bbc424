"""Farm jobs of data sets: tasks of complete scenes, status by finished samples."""

import pytest
from firetwin.dataset import farm_work, truth
from firetwin.farm import assemble, divided, plan, status, submission, task
from firetwin.farm.engines import Batch, known
from firetwin.render import fingerprint

SCENES = [1, 4, 5], [2, 3], [*range(6, 13)], [13]


@pytest.fixture
def job(tmp_path, monkeypatch):
    calls = []
    monkeypatch.setattr(farm_work, "split", lambda plan, out: (13, SCENES))
    for name in ("make", "finish"):
        monkeypatch.setattr(farm_work, name, lambda *words, name=name: calls.append((name, *words)))
    (tmp_path / "plan.toml").write_text('[[runs]]\nplace = "A"\nrun = "a"\n')
    planned = divided.make_job("dataset", tmp_path / "plan.toml", tmp_path / "out", 6)
    monkeypatch.setattr(fingerprint, "versions", lambda: planned.versions)
    plan.write(planned, tmp_path / "out")
    return planned, tmp_path / "out", calls


def write(out, index):
    path = truth.path(out / farm_work.FOLDER, index)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()


def test_a_task_has_complete_scenes(job):
    planned, out, calls = job
    assert [each.frames for each in planned.tasks] == ["1-5", "6-12", "13"]
    assert plan.read(out) == planned
    task.run(out, [2])
    assert calls == [("make", out.parent / "plan.toml", out, "6-12")]


def test_a_plan_is_told_from_a_scene_by_its_places(tmp_path):
    path = tmp_path / "a.toml"
    for text, is_plan in (
        ('[[runs]]\nplace = "A"\nrun = "a"\n', True),
        ('run = "a"\n[[runs]]\nname = "B"\npath = "b"\n', False),
        ("not TOML", False),
    ):
        path.write_text(text)
        assert divided.find(path) == ("dataset" if is_plan else "")
    assert divided.find(tmp_path) == ""


def test_progress_and_resubmission_go_by_finished_samples(job):
    planned, out, _ = job
    assert (status.gather(out).pictures, status.gather(out).finished) == (13, 0)
    assert status.gather(out).waiting == [1, 2, 3]
    for index in (*range(1, 6), 7):
        write(out, index)
    assert status.gather(out).done == [1]
    missing, numbers = submission.find_missing(out)
    assert [each.frame for each in missing] == [6, *range(8, 14)]
    assert numbers == [2, 3]
    assert list(assemble.format_missing(missing)) == ["sample labels 6,8-13: not rendered"]
    assert sum(1 for task in planned.tasks for _ in planned.pictures(task)) == 13


def test_the_last_stage_finishes_a_complete_data_set_alone(job):
    _, out, calls = job
    assert len(assemble.run(out)) == 13
    assert not calls
    for index in range(1, 14):
        write(out, index)
    assert assemble.run(out) == {}
    assert calls == [("finish", out.parent / "plan.toml", out)]


@pytest.mark.parametrize("engine", sorted(known()))
def test_every_scheduler_gets_the_tasks(job, engine):
    planned, out, _ = job
    known()[engine]().write(Batch(planned, out, (1, 2, 3)))
    written = "".join(path.read_text() for path in (out / "farm" / engine).rglob("*") if path.is_file())
    assert "farm" in written
    assert "task" in written
