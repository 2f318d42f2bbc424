"""Parts of the benchmark: tools compute equal results, errors are errors, and tables print targets."""

import importlib
import json
import time
from functools import partial

import firetwin.bench
import interpolation
import numpy as np
import pytest
from firetwin import cli
from firetwin.bench import SUBJECTS, forest, harness, radiometry, table, text, timing
from firetwin.bench.harness import Bench
from firetwin.bench.timing import Times
from firetwin_core import sensor


@pytest.fixture
def bench():
    bench = Bench()
    bench.begin("geodesy", "Speed of geodesy, against a slow tool.")
    for tool, slower in (("firetwin", 1), ("slow", 8)):
        times = Times(tuple(2e-2 * slower * noise for noise in (1.0, 0.9, 1.5)))
        error = 1e-9 * (slower - 1)
        bench.row("720 x 720", tool, times, 720**2, "value", error=error, error_unit="m")
    bench.target("Speed / slow", (8.0, 7.5, 12.0), 4, "x")
    bench.target("error", 6, 5, "nm", most=True)
    bench.target("front error", 24, 47, "%", most=True, rival="linear blending")
    bench.rival("no_such_package")
    return bench


def test_the_page_says_what_is_met_and_what_is_not_with_ranges(bench):
    lines = table.page(bench).splitlines()
    assert "geodesy: Speed of geodesy, against a slow tool." in lines
    (slow,) = (line.split() for line in lines if " slow " in line and "720" in line)
    assert " ".join(slow) == "720 x 720 slow 160 ms (144 to 240) 309 ns/value 7.0e-09 m"
    assert "| geodesy | Speed / slow | 8 x (7.5 to 12) | at least 4 x | MET |" in lines
    assert "| geodesy | error | 6 nm | at most 5 nm | MISSED |" in lines
    assert "| geodesy | front error | 24 %, linear blending 47 % | at most linear blending | MET |" in lines
    assert any("no_such_package is not installed" in line for line in lines)


def test_the_command_prints_json_and_explains_former_options(bench, monkeypatch, capsys):
    monkeypatch.setattr(firetwin.bench, "measure", lambda progress: bench)
    assert cli.main(["bench", "--json"]) == 1  # a target is missed
    data = json.loads(capsys.readouterr().out)
    assert [t["met"] for t in data["targets"]] == [True, False, True]
    assert data["targets"][0]["values"] == [8.0, 7.5, 12.0]
    assert [row["seconds"] for row in data["rows"]] == [2e-2, 0.16]
    for former, remedy in ((["--runs", "2"], "several times"), (["--markdown"], "Markdown table")):
        assert cli.main(["bench", *former]) == 2
        assert remedy in capsys.readouterr().err


def test_tools_take_turns():
    """A disturbance of the machine affects all tools, and the first call of each does not count."""
    calls = []

    def slow(name):
        calls.append(name)
        time.sleep(2 * timing.SAMPLE)

    made = [timing.Runner(name, partial(slow, name)) for name in ("a", "b")]
    found = timing.race(made, 7, 1e-9)
    assert [len(times.seconds) for times in found] == [timing.LEAST, timing.LEAST]
    assert calls[-2 * timing.LEAST :] == ["a", "b"] * timing.LEAST
    assert len(calls) > 2 * timing.LEAST
    assert len(timing.race(made, 7, 100.0)[0].seconds) == 7


def test_quick_calls_are_timed_in_bunches():
    calls = []
    times = timing.race([timing.Runner("quick", lambda: calls.append(1))], 5, 0.0)[0]
    assert len(calls) > 100
    assert 0 < times.median < timing.SAMPLE


def test_how_much_faster_is_told_round_by_round():
    ours, theirs = timing.Times((1.0, 2.0, 4.0)), timing.Times((4.0, 10.0, 8.0))
    assert ours.faster_than(theirs) == (4.0, 5.0, 2.0)
    assert ours.median == 2.0
    assert ours.speed(8.0) == (8.0, 4.0, 2.0)


def test_every_subject_says_what_it_compares():
    for name in SUBJECTS:
        subject = importlib.import_module(name)
        assert subject.__doc__.partition("\n")[0].endswith(".")
        assert callable(subject.run)


def test_each_subject_runs_under_its_name(monkeypatch):
    calls, told = [], []
    monkeypatch.setattr(text, "run", lambda bench: calls.append(bench.subject))
    monkeypatch.setattr(forest, "run", lambda bench: calls.append(bench.subject))
    firetwin.bench.measure(SUBJECTS[:2], progress=lambda *what: told.append(what))
    assert calls == ["text", "forest"]
    assert told == [(k, 2, "measuring") for k in range(3)]


def test_the_better_form_of_a_rival_is_the_one_to_beat(tmp_path, monkeypatch):
    seconds = {"firetwin": 1.0, "as float64 then cast": 3.0, "as float32": 5.0}
    bench = Bench(subject="text")

    def invented(runners, *_):
        return [Times((seconds[r.label.partition(", ")[2] or r.label],)) for r in runners]

    monkeypatch.setattr(harness, "race", invented)
    path = tmp_path / "720.txt"
    path.write_text(text.grid_text(36))
    text.race(bench, path, 36)
    speed = next(each for each in bench.targets if "loadtxt" in each.quantity)
    assert speed.values == (3.0,)
    assert not speed.met


def test_front_error_and_departure():
    before, after = np.array([[1.0, 0, 0, 0, 0]]), np.array([[1.0, 1, 1, 1, 0]])
    true = np.array([[1.0, 1, 0, 0, 0]])
    assert interpolation.front_error(true, true, before, after) == 0
    assert interpolation.front_error(after, true, before, after) == pytest.approx(200 / 3)
    assert interpolation.brightness(4 * true) == pytest.approx(16)
    assert interpolation.departure(np.array([1.1, 0.9]), np.array([1.0, 1.0])) == pytest.approx(10)


def test_a_drone_sees_some_of_the_stems_of_a_stand():
    grid = forest.fuel_grid(72)  # of cells 10 times as wide as the bench's, which hold 100 times as much
    stems, levels = forest.stand(grid, forest.part(grid, 200), forest.drone())
    assert len(stems) == pytest.approx(20_000, rel=0.05)
    assert 0 < len(levels) < len(stems)


def test_numpy_has_the_same_temperatures():
    radiance = radiometry.picture()
    exact = sensor.brightness_temperature(radiance, radiometry.BAND)
    assert np.abs(radiometry.with_numpy(radiance) - exact).max() < 0.01
