"""Decisions of training stories: questions have numbers of their time, answers of the next decision."""

import re
from itertools import pairwise

import pytest
import whole_run
from firetwin import cli
from firetwin.run import info, measure, readers, times
from firetwin.run.labels import Label
from firetwin.story import choose, story_file, timeline, training

PLACES = [Label("Near", 38.9, -120.597), Label("Far", 38.95, -120.6)]


@pytest.fixture
def run(tmp_path):
    return readers.open(whole_run.write(tmp_path / "run", cells=32))


@pytest.fixture
def story(run, tmp_path):
    return training.with_decisions(choose.choose(run, tmp_path / "story.toml"), run, PLACES)


def test_the_growth_is_complete_and_pauses_at_decisions(story, run):
    names = [shot.name for shot in story.shots if shot.name.startswith(("growth", "decision", "answer"))]
    parts = [f"{kind}-{k}" for k in (1, 2, 3) for kind in ("answer", "decision", "growth")]
    expected = ["growth-1", "decision-1", "growth-2", "answer-1", "decision-2", "growth-3"]
    assert names == [*expected, "answer-2", "decision-3", "growth-4", "answer-3"]
    assert {*names} == {*parts, "growth-4"}
    growth = [shot for shot in story.shots if shot.name.startswith("growth")]
    assert all(a.end == b.start for a, b in pairwise(growth))
    ends = [times.seconds(run, at) for at in (growth[0].start, growth[-1].end)]
    assert ends == [run.times[0], run.times[-1]]
    gained = info.burned(run, [times.seconds(run, shot.end) for shot in growth])
    assert [area / gained[-1] for area in gained] == pytest.approx([0.1, 0.35, 0.65, 1.0], abs=0.02)


def test_numbers_of_questions_and_answers_are_the_run_s(story, run):
    shots = {shot.name: shot for shot in story.shots}
    for number in (1, 2, 3):
        at, until = (times.seconds(run, shots[f"growth-{k}"].end) for k in (number, number + 1))
        now, then = (measure.area(area, "us") for area in info.burned(run, [at, until]))
        question, answer = (shots[f"{kind}-{number}"].caption for kind in ("decision", "answer"))
        assert f"\nBurned: {now}\n" in question
        assert f"\nBurned: {then}" in answer
        assert "Wind at the fire: 4 m/s (9 mph) from the west" in question
    assert re.search(r"Nearest places: Near 0\.\d km, Far 5\.\d km", shots["decision-1"].caption)
    reached = [number for number in (1, 2, 3) if "Reached: Near at" in shots[f"answer-{number}"].caption]
    assert len(reached) == 1  # a place that has burned is asked for no more
    later = "".join(shots[f"decision-{k}"].caption for k in range(reached[0] + 1, 4))
    assert not re.search(r"\bNear \d", later)


def test_no_earlier_shot_shows_a_later_time(story):
    first = next(shot for shot in story.shots if shot.name == "growth-1")
    before = story.shots[: story.shots.index(first)]
    assert all(shot.start is None or shot.start <= first.start for shot in before)


def test_a_run_without_fire_has_no_decision(tmp_path):
    run = readers.open(whole_run.write(tmp_path / "still", cells=16, fires=((0.0, 0.0, 9e9),)))
    story = choose.choose(run, tmp_path / "story.toml")
    assert training.with_decisions(story, run, PLACES) == story


def test_the_instructor_has_each_question_with_its_time_in_the_film(run, tmp_path):
    out = tmp_path / "out"
    words = ["story", run.path, "--out", str(out), "--storyboard", "--for", "training"]
    assert cli.main(words) == 0
    sheet = (out / "instructor.html").read_text()
    spans = timeline.lay_out(story_file.read(out / "story.toml"))
    asked = [span for span in spans if span.shot.name.startswith("decision")]
    assert len(asked) == 3
    for span in asked:
        assert f"<td>{(span.first - 1) / 24:.0f} s<td>{span.shot.caption.splitlines()[0]}<br>" in sheet
