"""The worker of samples gets the plan and the draws themselves."""

import pickle

import small_plan
from firetwin.dataset import sample_job
from firetwin.dataset.draws import Drawer
from firetwin.dataset.places import Visit
from firetwin.jobs import worker
from firetwin.progress import no_message, silent


def test_a_worker_gets_the_draws_of_its_visit_as_they_are(tmp_path, monkeypatch):
    small_plan.write_run(tmp_path / "a")
    plan = small_plan.plan(folder=tmp_path)  # its file does not exist, so nobody can read it again
    visit, tasks = Visit((Drawer(plan).draw(1),)), []
    monkeypatch.setattr(worker, "run", lambda work, *rest, **named: tasks.append(work))
    sample_job.make(plan, visit, [1], tmp_path / "set", silent, no_message)
    (task,) = tasks
    assert pickle.loads(pickle.dumps(task)).args[:2] == (plan, visit)
