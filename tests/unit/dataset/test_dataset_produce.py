"""Production of a data set: each sample complete or absent, and made once, by one or several processes."""

import dataclasses
import json
import os
import threading

import fake_samples
import pytest
import small_plan
from firetwin.dataset import about, estimate, produce, record
from firetwin.dataset.run_scene import RunScene
from firetwin.errors import InputError, UsageError

COUNT = 16


class Killed(BaseException):
    """The end of a process."""


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    for name in ("a", "b"):
        small_plan.write_run(folder / name, cells=32)
    # Towers of the small terrain stand close to it.
    return small_plan.plan(
        "a", "b", folder=folder, count=COUNT, moments=2, cameras={"drone": 0.7, "nadir": 0.3}
    )


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    monkeypatch.setattr(produce, "_POLL_INTERVAL", 0.01)


@pytest.fixture(autouse=True, scope="module")
def _clear():
    """Solve no smoke."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(RunScene, "veil", lambda *_: 0.0)
        yield


@pytest.fixture(scope="module")
def undisturbed(plan, tmp_path_factory):
    out = tmp_path_factory.mktemp("whole") / "set"
    produce.run(produce.prepare(plan, out), fake_samples.make)
    return fake_samples.content(out)


def test_all_samples_are_made_once_with_their_record(plan, undisturbed, tmp_path):
    out = tmp_path / "set"
    produce.run(produce.prepare(plan, out), fake_samples.make)
    assert sorted(fake_samples.log(out)) == list(range(1, COUNT + 1))
    assert fake_samples.content(out) == undisturbed
    assert about.read(out) == about.About(
        plan.title, COUNT, 7, "camera", "", {name: value.unit for name, value in produce.VALUES.items()}
    )
    produce.run(produce.prepare(plan, out), fake_samples.make)
    assert len(fake_samples.log(out)) == COUNT


@pytest.mark.parametrize("stop", [1, 9])
def test_an_interrupted_data_set_continues_to_the_same_files(plan, undisturbed, tmp_path, stop):
    out = tmp_path / "set"

    def make(*arguments):
        *most, _progress, tell = arguments

        def count(*_):
            if len(fake_samples.log(out)) == stop:
                raise Killed

        fake_samples.make(*most, count, tell)

    with pytest.raises(Killed):
        produce.run(produce.prepare(plan, out), make)
    assert len(fake_samples.log(out)) == stop
    produce.run(produce.prepare(plan, out), fake_samples.make)
    assert sorted(fake_samples.log(out)) == list(range(1, COUNT + 1))
    assert fake_samples.content(out) == undisturbed


def test_two_producers_share_the_visits(plan, undisturbed, tmp_path, monkeypatch):
    out, errors = tmp_path / "set", []
    monkeypatch.setattr(fake_samples, "PAUSE", 0.005)

    def work():
        try:
            produce.run(produce.prepare(plan, out), fake_samples.make)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert sorted(fake_samples.log(out)) == list(range(1, COUNT + 1))
    assert fake_samples.content(out) == undisturbed


def test_samples_alone_equal_those_of_the_data_set(plan, undisturbed, tmp_path):
    out = tmp_path / "set"
    produce.run(produce.prepare(plan, out, "0011,3"), fake_samples.make)
    assert sorted(fake_samples.log(out)) == [3, 11]
    made = {path: data for path, data in fake_samples.content(out).items() if "/" in path}
    assert len(made) == 2 * 12
    assert made.items() <= undisturbed.items()


def test_a_sample_of_a_large_plan_needs_the_draws_of_its_block_alone(plan, tmp_path, monkeypatch):
    """Each of them is drawn once, and its visits do not depend on the number of samples."""
    large, drawn = dataclasses.replace(plan, count=1_000_000), []
    monkeypatch.setattr(produce.places, "BLOCK", 96)
    monkeypatch.setattr(produce.Drawer, "draw", _noted(produce.Drawer.draw, drawn))
    production = produce.prepare(large, tmp_path / "set", "97,100")
    assert production.estimate().samples == 2
    produce.run(production, fake_samples.make)
    assert drawn == list(range(97, 193))
    assert sorted(fake_samples.log(tmp_path / "set")) == [97, 100]
    small = produce.prepare(dataclasses.replace(plan, count=200), tmp_path, "97")
    assert small.visits(small.blocks[0]) == production.visits(production.blocks[0])


def _noted(draw, numbers):
    def noted(drawer, index):
        numbers.append(index)
        return draw(drawer, index)

    return noted


def test_all_blocks_of_a_plan_are_made(plan, tmp_path, monkeypatch):
    monkeypatch.setattr(produce.places, "blocks", lambda plan: [range(1, 6), range(6, 11), range(11, 17)])
    monkeypatch.setattr(produce, "_KEPT", 1)
    produce.run(produce.prepare(plan, tmp_path / "set"), fake_samples.make)
    assert sorted(fake_samples.log(tmp_path / "set")) == list(range(1, COUNT + 1))


def test_a_folder_of_another_plan_is_refused_with_the_changes(plan, tmp_path):
    out = tmp_path / "set"
    produce.run(produce.prepare(plan, out, "1"), fake_samples.make)
    other = dataclasses.replace(plan, seed=8)
    with pytest.raises(InputError, match=r"changed: seed.*; choose another folder for --out"):
        produce.run(produce.prepare(other, out), fake_samples.make)
    found = json.loads((out / record.NAME).read_text())
    found["versions"]["firetwin"] = "0.0.1"
    (out / record.NAME).write_text(json.dumps(found))
    with pytest.raises(InputError, match="version of firetwin"):
        produce.run(produce.prepare(plan, out), fake_samples.make)


@pytest.mark.parametrize("only", ["0", "17", "x", "3-1"])
def test_samples_that_do_not_exist_are_refused(plan, tmp_path, only):
    with pytest.raises(UsageError, match="samples are numbered 1 to 16"):
        produce.prepare(plan, tmp_path, only)


def test_a_maker_that_writes_nothing_does_not_loop(plan, tmp_path):
    with pytest.raises(RuntimeError, match="was not written"):
        produce.run(produce.prepare(plan, tmp_path / "set"), lambda *_: None)


def test_progress_counts_the_samples_of_the_whole_data_set(plan, tmp_path):
    seen = []
    produce.run(
        produce.prepare(plan, tmp_path / "set"), fake_samples.make, lambda *where: seen.append(where[:2])
    )
    assert seen[-1] == (COUNT, COUNT)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


def test_unfinished_files_of_killed_processes_are_removed(tmp_path):
    (tmp_path / "images").mkdir()
    (tmp_path / "images" / ".000001.0123456789ab.part.jpg").write_bytes(b"x")
    (tmp_path / "images" / "000001.jpg").write_bytes(b"x")
    assert produce.remove_parts(tmp_path) == 1
    assert [path.name for path in (tmp_path / "images").iterdir()] == ["000001.jpg"]


def test_an_estimate_grows_with_samples_and_pixels_and_compares_the_disk(monkeypatch, tmp_path):
    monkeypatch.setattr(estimate, "_free", lambda out: 10**6)
    small = estimate.estimate(range(10), 1, (640, 480), tmp_path)
    large = estimate.estimate(range(10), 1, (1280, 960), tmp_path)
    assert large.bytes == pytest.approx(4 * small.bytes)
    assert large.seconds > 2 * small.seconds
    assert "the disk has 1 MB left" in small.lines()[1]
    assert estimate.estimate([], 0, (640, 480), tmp_path).lines() == ["all samples are finished"]


def test_an_estimate_of_a_set_that_continues_takes_the_cost_of_its_own_samples(tmp_path):
    costs = [tmp_path / f"{number}.json" for number in range(5)]
    for number, path in enumerate(costs):
        path.write_text(json.dumps({"processor_seconds": {"surfaces": 90.0 + number, "classes": 8.0}}))
    cores = os.cpu_count()
    found = estimate.estimate(range(10), 3, (640, 480), tmp_path, costs)
    assert found.seconds == pytest.approx(10 * 100.0 / cores)
    few = estimate.estimate(range(10), 3, (640, 480), tmp_path, costs[:4])
    assert few.seconds == estimate.estimate(range(10), 3, (640, 480), tmp_path).seconds


def test_a_production_knows_the_cost_of_its_finished_samples(plan, tmp_path, monkeypatch):
    given = []
    monkeypatch.setattr(produce, "estimate", lambda *arguments: given.append(arguments[-1]))
    production = produce.prepare(plan, tmp_path / "set")
    path = produce.cost_file(tmp_path / "set", 3)
    path.parent.mkdir(parents=True)
    path.write_text("{}")
    production.estimate()
    assert given == [[path]]


def test_work_that_one_process_does_alone_waits_for_another(tmp_path):
    order = []

    def late():
        with produce.alone(tmp_path, "finish"):
            order.append("late")

    with produce.alone(tmp_path, "finish"):
        thread = threading.Thread(target=late)
        thread.start()
        thread.join(0.1)
        order.append("first")
    thread.join()
    assert order == ["first", "late"]
