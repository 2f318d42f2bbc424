"""Suggested allocation: compared with brute force and closed forms, ties, and reasons for a failure."""

import argparse
import itertools
import json
import re
import sys
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
import small_stations
from fires import LATITUDE, LONGITUDE, axes, round_fire, write_run
from firetwin import cli, extras
from firetwin.allocation import (
    LIMITS,
    command,
    containment,
    divisions,
    job,
    nearest,
    page,
    read,
    resources,
    shortfall,
    symmetry,
)
from firetwin.allocation.control_line import LineOptions
from firetwin.allocation.model import Options
from firetwin.allocation.problem import Problem, Request, set_escape_loss
from firetwin.allocation.resources import Unit
from firetwin.errors import Error, InputError, UsageError
from firetwin.imaging import map_symbols
from firetwin.run import areas, readers
from firetwin.stations import measures, reading
from firetwin.stations.records import EXERCISE, Availability, Station
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

pytest.importorskip("scipy")

EXACT = Options(gap=0.0)
TYPES = ("engine/3", "dozer/2", "crew/IHC", "helicopter/2")
START = datetime(2014, 9, 17, 4, 45, tzinfo=UTC)


def made(seed, n, k, t, **request):
    """A problem of random numbers; some resources are identical, and some costs are equal."""
    rng = np.random.default_rng(seed)
    like = np.sort(rng.integers(0, max(n - n // 3, 1), n))
    perimeter = 100.0 + np.abs(np.cumsum(rng.uniform(-500, 900, (k, t)), axis=1))
    return Problem(
        tuple(f"{i}" for i in range(n)),
        tuple(np.array(TYPES)[rng.integers(0, 4, n)][like]),
        rng.uniform(10, 120, (n, k))[like],
        rng.choice([0.0, 300.0, 600.0, 1500.0], n)[like],
        rng.choice([500.0, 900.0, 1234.56], n)[like],
        np.arange(1.0, t + 1),
        perimeter,
        np.round(np.cumsum(perimeter, axis=1) * rng.uniform(0, 3), 2),
        Request(**request),
    )


def brute_force(problem):
    """Least cost and loss of all assignments; None if none is allowed."""
    n, k = problem.minutes.shape
    choices = np.array(list(itertools.product(range(-1, k), repeat=n)), np.int64).reshape(-1, n)
    sent = choices >= 0
    total = sent @ problem.cost
    allowed = np.ones(len(choices), bool)
    if problem.request.budget is not None:
        allowed &= total <= problem.request.budget + 1e-9
    in_time = np.column_stack([problem.in_time, np.zeros(n, bool)])[np.arange(n), choices]
    for kind, number in problem.request.response.items():
        allowed &= (in_time & problem.of(kind)).sum(1) >= number
    for division in range(k):
        line = (choices == division).astype(float) @ problem.line[:, division]
        each = np.where(line >= problem.perimeter[division] - 1e-3, problem.loss[division], np.inf).min(1)
        if problem.request.escape is not None:
            each = np.minimum(each, problem.escape[division])
        total = total + each
    total = np.where(allowed, total, np.inf)
    return None if not np.isfinite(total).any() else float(total.min())


@given(
    st.integers(0, 10**6), st.integers(1, 5), st.integers(1, 3), st.sampled_from([None, 2000.0, 4000.0]),
    st.sampled_from([None, 0.0, 3000.0]), st.sampled_from([{}, {"engine": 1}, {"crew/IHC": 1, "dozer/2": 1}]),
)  # fmt: skip
@settings(deadline=None, max_examples=examples(60))
def test_it_is_the_best_of_all_assignments(seed, n, k, budget, escape, response):
    problem = made(seed, n, k, 3, budget=budget, escape=escape, response=response, limit=90.0)
    best, answer = brute_force(problem), containment.solve(problem, EXACT)
    if best is None:
        assert answer is None
        assert shortfall.explain(problem, tuple("ABC"[:k]), EXACT)
        return
    containment.check(problem, answer)
    assert answer.cost + answer.loss == pytest.approx(best, abs=2e-3, rel=1e-9)


def test_it_is_the_same_each_time_and_in_any_order():
    """Sixty resources, of which many cost and build the same: the lowest ids go."""
    rng = np.random.default_rng(4)
    units = [
        Unit(f"{i}", TYPES[i % 2], 200.0, 20.0, 60.0, 100.0 + 50.0 * (i % 3), 38.9 + 0.01 * (i % 5), -120.6)
        for i in range(60)
    ]
    answers = []
    for order in (range(60), range(60), reversed(range(60)), rng.permutation(60)):
        kept, _ = resources.select_usable([units[i] for i in order])
        problem = replace(
            made(1, 60, 3, 4),
            ids=tuple(unit.id for unit in kept),
            types=tuple(unit.type for unit in kept),
            minutes=resources.travel_times(kept, [[38.9, -120.5], [38.8, -120.5], [38.9, -120.7]]),
            rate=np.array([unit.line_m_h for unit in kept]),
            cost=np.array([unit.cost_hour for unit in kept]),
        )
        answer = containment.solve(problem)
        answers.append([(unit.id, int(k)) for unit, k in zip(kept, answer.division, strict=True) if k >= 0])
    assert answers[0]
    assert answers == answers[:1] * 4
    assert [unit.id for unit in resources.select_usable(units[::-1])[0]] == [str(i) for i in range(60)]


@given(st.integers(0, 10**6), st.sampled_from([0.0, 1e-3, 0.3]), st.sampled_from([{}, {"engine": 2}]))
@settings(deadline=None, max_examples=examples(40))
def test_ties_are_decided_exactly_whatever_the_gap_of_the_solver(seed, gap, response):
    """Without losses and with free resources: the first hour counts, and every sent resource helps."""
    problem = made(seed, 14, 2, 4, escape=1e5, response=response, limit=120.0)
    free = np.where(np.arange(14) % 3 == 0, 0.0, problem.cost)
    problem = replace(problem, cost=free, loss=np.zeros_like(problem.loss))
    answer = containment.solve(problem, Options(gap=gap))
    if answer is None:
        return
    containment.check(problem, answer)

    def hours(division):
        held = containment.built_line(problem, division) >= problem.perimeter - 0.01
        return np.where(held.any(1), held.argmax(1), -1).tolist()

    assert answer.hour.tolist() == hours(answer.division)
    for each in np.flatnonzero(answer.division >= 0):
        fewer = np.where(np.arange(14) == each, -1, answer.division)
        there = problem.in_time[np.arange(14), fewer] & (fewer >= 0)
        met = all((there & problem.of(kind)).sum() >= number for kind, number in response.items())
        assert not met or hours(fewer) != answer.hour.tolist()
    for members in symmetry.find_classes(problem):
        sent = answer.division[members]
        chosen = sent[sent >= 0].tolist()
        assert sent.tolist() == sorted(chosen) + [-1] * (len(sent) - len(chosen))


def test_five_hundred_resources_are_soon_allocated():
    """Within the ten processor seconds that a test may take."""
    problem = made(2, 500, 4, 12, escape=1e6, response={"engine/3": 4}, limit=100.0, budget=50_000.0)
    answer = containment.solve(problem)
    containment.check(problem, answer)
    assert answer.in_time
    assert answer.cost + answer.loss <= 1.0011 * answer.bound
    at = problem.in_time[np.arange(500), answer.division] & (answer.division >= 0) & problem.of("engine/3")
    assert at.sum() >= 4


def simple(**request):
    """Two engines and a dozer before one division of 1,000 m, in two hours."""
    return Problem(
        ("1", "2", "3"), ("engine/3", "engine/3", "dozer/2"), np.array([[60.0], [70.0], [60.0]]),
        np.array([100.0, 100.0, 300.0]), np.array([1000.0, 1000.0, 4000.0]), np.array([1.0, 2.0]),
        np.array([[500.0, 400.0]]), np.array([[0.0, 0.0]]), Request(**request),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"budget": 4500.0}, "budget of 4,500.00 is too small by 500.00: the cheapest .* costs 5,000.00"),
        (
            {"response": {"engine": 2}},
            "is short of 1 of 2 engine: 1 can arrive within 60 min; 2 can arrive within 70 min",
        ),
        (
            {"response": {"crew/IHC": 2}},
            "is short of 2 of 2 crew/IHC: 0 can .* within 60 min; the file has 0",
        ),
    ],
)
def test_it_says_why_there_is_none(request_, words):
    problem = simple(**request_)
    assert containment.solve(problem, EXACT) is None
    (reason,) = shortfall.explain(problem, ("A",), EXACT)
    assert re.search(words, reason), reason


def test_it_says_how_much_line_is_missing():
    """At hour 2 the three have 100, 83.3 and 300 m."""
    problem = replace(simple(), perimeter=np.array([[500.0, 600.0]]))
    assert containment.solve(problem, EXACT) is None
    (reason,) = shortfall.explain(problem, ("C",), EXACT)
    assert "117 m of the 600 m of division C at hour 2 are missing, a rate of 58 m/h" in reason
    lacking, _ = containment.minimum_shortfall(problem, EXACT)
    assert lacking[0] == pytest.approx(600.0 - 100.0 - 250.0 / 3.0 - 300.0)


def test_a_division_cannot_be_contained_before_the_fire_comes():
    late = replace(simple(), perimeter=np.array([[np.nan, 90.0]]), loss=np.array([[np.nan, 0.0]]))
    answer = containment.solve(late, EXACT)
    assert (answer.hour.tolist(), answer.division.tolist()) == ([1], [0, -1, -1])


def test_the_nearest_of_each_kind_are_paired_one_to_one():
    minutes = np.array([[10.0, 11.0], [12.0, 30.0], [50.0, 60.0]])
    problem = replace(made(0, 3, 2, 2), types=("engine/3", "engine/6", "dozer/2"), minutes=minutes)
    found = {(each.kind, each.division): problem.ids[each.resource] for each in nearest.pair_nearest(problem)}
    assert found == {("engine", 0): "1", ("engine", 1): "0", ("dozer", 0): "2"}


def test_minutes_are_by_road_or_straight():
    north, _ = areas.metres_per_degree(38.9)
    engine = Unit("1", "engine/3", 0.0, 5.0, 60.0, 0.0, 38.9 - 30_000.0 / north, -120.6)
    both = resources.travel_times([engine, engine._replace(type="helicopter/2")], [[38.9, -120.6]])
    assert both[:, 0] == pytest.approx([5.0 + 42.0, 5.0 + 30.0], rel=5e-3)


@pytest.fixture
def round_run(make_run):
    """A run of two hours whose fire begins at the middle and grows as a circle by 0.5 m/s from 300 m on."""
    time = round_fire(*axes(160), 0.5) - 600.0
    time = np.where(time > 7000.0, np.nan, time)
    return write_run(make_run, time, 160, coarse=32, interval=900.0)


def test_divisions_of_a_circle_have_its_arcs(round_run):
    parts = divisions.divide(readers.open(round_run), 0.0, 1, 6, LineOptions(0.0, 0.0))
    radius = 300.0 + 0.5 * 3600.0
    assert parts.perimeter[:, 0] == pytest.approx(2.0 * np.pi * radius / 6.0, rel=0.03)
    assert parts.perimeter.sum() == pytest.approx(2.0 * np.pi * radius, rel=0.002)
    assert parts.burned.sum() == pytest.approx(np.pi * radius**2, rel=0.01)
    assert parts.centre == pytest.approx((LATITUDE, LONGITUDE), abs=1e-6)
    assert parts.names == ("A", "B", "C", "D", "E", "F")
    assert parts.bearings(1) == (60.0, 120.0)
    east = (parts.place[:, 1] - LONGITUDE)[[1, 4]]
    assert east[0] > 0.0 > east[1]


def test_what_cannot_be_held_is_said_with_the_nearest_plan(round_run, station_file, tmp_path, capsys):
    """The budget of one engine for four divisions of 4 km: one is held, and the plans keep to the budget."""
    layer = tmp_path / "plan.geojson"
    line = ["allocate", str(station_file), str(round_run), "--hours", "1", "--geojson", str(layer)]
    assert cli.main([*line, "--budget", "100", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    lost = [each for each in result["divisions"] if each["contained_at_hour"] is None]
    assert len(lost) == 3
    plans = [each["nearest_plan"] for each in lost]
    assert sum(plan["cost"] for plan in plans) + result["sums"]["cost"] <= 100.0
    for plan in plans:
        assert plan["line"] + plan["missing"] == pytest.approx(plan["front"], abs=0.2)
        assert plan["line"] == pytest.approx(sum(each["line"] for each in plan["resources"]), abs=0.2)
        assert plan["hour_of_all"] == 1.0
    text = page.format_text(result, {})
    assert text.count("cannot be held, with a front of") == 3
    assert "  nearest feasible plan: 0 m (0 %) by hour 1, for another 0.00 USD" in text
    assert "  all resources together would contain it at hour 1: they build " in text
    drawn = json.loads(layer.read_text())["features"]
    kinds = [each["properties"]["kind"] for each in drawn]
    assert kinds.count("control_line") == kinds.count("division_break") == 4
    assert {each["properties"]["exercise"] for each in drawn} == {EXERCISE}
    categories = {each["properties"]["FeatureCategory"] for each in drawn} - {""}
    assert categories == {"Planned Line", "Line Not Held", "Division Break"}
    assert categories <= {*map_symbols.LINES, *map_symbols.POINTS}


def test_the_rest_builds_as_much_line_as_any_assignment():
    """Against brute force: all assignments of the resources that are left, within the budget."""
    checked = 0
    for seed in range(12):
        problem = made(seed, 6, 2, 3, budget=3000.0, escape=100.0)
        answer = containment.solve(problem, EXACT)
        rest = np.flatnonzero(answer.division < 0)
        lost = np.flatnonzero(answer.hour < 0)
        plan = containment.plan_the_rest(problem, answer, EXACT)
        assert np.isnan(plan.line[answer.hour >= 0]).all()
        assert not (plan.division[answer.division >= 0] >= 0).any()
        best = -1.0
        built = containment.built_line(problem, answer.division)[lost, -1]
        for choice in itertools.product([-1, *lost], repeat=len(rest)):
            sent = np.array(choice, np.int64)
            if problem.cost[rest[sent >= 0]].sum() <= 3000.0 - answer.cost + 1e-9:
                more = [problem.line[rest[sent == k], k, -1].sum() for k in lost]
                best = max(best, np.minimum(built + more, problem.perimeter[lost, -1]).sum())
        if lost.size:
            checked += bool(rest.size)
            found = np.minimum(plan.line[lost], problem.perimeter[lost, -1]).sum()
            assert found == pytest.approx(best, abs=0.1)
            spent = problem.cost[plan.division >= 0].sum()
            assert spent <= 3000.0 - answer.cost + 1e-9
    assert checked > 3


def test_without_a_loss_as_many_divisions_as_possible_are_held():
    costs = np.array([1200.0, 800.5])
    assert set_escape_loss(Request(escape=np.inf), costs).escape == 3000.0
    assert set_escape_loss(Request(escape=5.0), costs).escape == 5.0
    assert set_escape_loss(Request(), costs).escape is None


def test_islands_need_no_line():
    """A ring of burned ground: its outer line counts, the one around the island does not."""
    turn = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    x = np.concatenate([2.0 * np.cos(turn), np.cos(-turn)])
    y = np.concatenate([2.0 * np.sin(turn), np.sin(-turn)])
    after = np.concatenate([np.roll(np.arange(60), -1), 60 + np.roll(np.arange(60), -1)])
    assert divisions.outer_points(x, y, after).tolist() == list(range(60))


UNITS = [
    Unit(f"{i}", TYPES[i % 3], 6000.0, 15.0, 60.0, 100.0, 38.9 + 0.01 * i, -120.7, f"Station {i}")
    for i in range(12)
]


def test_a_suggestion_says_what_it_is(round_run):
    result = job.suggest(UNITS, readers.open(round_run), Request(), hours=1)
    assert result["label"] == EXERCISE
    assert result["status"] == "suggested"
    assert json.loads(json.dumps(result)) == result
    for part in result["divisions"]:
        assert part["line"] >= part["perimeter"][int(part["contained_at_hour"]) - 1]
        assert sum(each["line"] for each in part["resources"]) == pytest.approx(part["line"], abs=1.0)
    sent = [each["id"] for part in result["divisions"] for each in part["resources"]]
    assert len(sent) == len(set(sent))
    assert result["sums"]["cost"] == 100.0 * len(sent)
    text = page.format_text(result, {})
    assert text.startswith(f"*** {EXERCISE} ***")
    assert text.endswith(f"*** {EXERCISE} ***")
    assert all(f"- {limit}" in text for limit in LIMITS)
    assert result == job.suggest(UNITS[::-1], readers.open(round_run), Request(), hours=1)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"hours": 9}, "--hours: the run ends 2 h after the order; give at most 2"),
        (
            {"start": START + timedelta(hours=3)},
            "--from: an hour from 2014-09-17T07:45:00Z is not in the run",
        ),
        ({"count": 27}, "--divisions: must be from 1 to 26, not 27"),
    ],
)
def test_what_the_run_has_not_is_told(round_run, options, words):
    with pytest.raises(UsageError, match=words):
        job.suggest(UNITS, readers.open(round_run), Request(), **options)


def test_a_run_without_fire_has_nothing_to_allocate_to(make_run):
    run = readers.open(make_run(heat_flux=np.zeros((3, 4, 5), np.float32)))
    with pytest.raises(InputError, match="has no fire"):
        job.suggest(UNITS, run, Request())


def test_without_scipy_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(
        Error, match=f"needs the Python package scipy.*{re.escape(extras.install('resources'))}"
    ):
        containment.solve(simple())


def test_what_lacks_a_number_is_left_out_and_told():
    units = [Unit("1", "engine/3", None, 5.0, 60.0, 10.0, 38.9, -120.6)]
    units += [units[0]._replace(id="2", speed_km_h=None), units[0]._replace(id="3", cost_hour=-1.0)]
    kept, left = resources.select_usable(units)
    assert [unit.id for unit in kept] == ["1"]
    assert left == ["2 (engine/3) has no speed_km_h", "3 (engine/3) has no cost_hour"]


@pytest.fixture
def station_file(tmp_path):
    """A station file: seven engines, and a dozer that is committed until five."""
    bases = [Station(1, "North", 38.95, -120.6, "exercise", 1), Station(2, "", 38.9, -120.7, "exercise", 1)]
    known = {"line_m_h": 8000.0, "cost_hour": 100.0, "currency": "USD"}
    sent = [
        small_stations.resource(7, 1, "engine/3", 7, 60.0, 10.0, **known),
        small_stations.resource(9, 2, "dozer/2", 1, 60.0, 10.0, name="Dozer", **known),
    ]
    day, five = timedelta(days=1), datetime(2014, 9, 17, 5, tzinfo=UTC)
    windows = [Availability(9, five - day, five, "committed"), Availability(9, five, five + day)]
    return small_stations.put(tmp_path / "stations.gpkg", bases, sent, windows)


def test_resources_are_read_as_they_are_at_the_time(station_file):
    units, left = read.read(station_file, START)
    assert [unit.id for unit in units] == [f"7-{k}" for k in range(1, 8)]
    assert (units[0].name, units[0].lat, units[0].currency) == ("North (1 of 7)", 38.95, "USD")
    assert units[0].station == "North"
    assert left == ["Dozer (dozer/2) is committed"]
    assert [unit.id for unit in read.read(station_file, START + timedelta(minutes=15))[0]][-1] == "9"
    assert read.read(station_file, START + timedelta(days=2))[1] == [
        "Dozer (dozer/2) is of unknown status then"
    ]


def test_costs_in_two_currencies_are_told(station_file):
    found = reading.read(station_file)
    changed = [replace(found.resources[0], currency="EUR"), replace(found.resources[1], currency="USD")]
    small_stations.put(station_file, found.stations, changed)
    with pytest.raises(InputError, match="has costs in EUR and USD"):
        read.read(station_file, START)
    small_stations.put(station_file, found.stations, [replace(changed[0], count=10_001)])
    with pytest.raises(InputError, match="resource 7 has a count of 10,001, above 10,000"):
        read.read(station_file, START)


def test_a_unit_costs_what_a_search_says(station_file):
    found = reading.read(station_file)
    rates = [{"cost_mobilise": 40.0}, {"cost_hour": None, "cost_day": 900.0}]
    rows = [replace(each, count=1, **more) for each, more in zip(found.resources, rates, strict=True)]
    small_stations.put(station_file, found.stations, rows)
    units, _ = read.read(station_file, START)
    assert resources.select_usable(units) == (units, [])
    assert resources.period_costs(units, 30.0).tolist() == [40.0 + 3000.0, 1800.0]
    assert measures.resource_costs(reading.read(station_file), 30.0).tolist() == [40.0 + 3000.0, 1800.0]


def test_an_exercise_of_the_program_can_be_allocated(round_run, tmp_path, capsys):
    towns, out = tmp_path / "towns.csv", tmp_path / "exercise.gpkg"
    towns.write_text("name,latitude,longitude\nAlpha,38.95,-120.6\nBravo,38.9,-120.7\n")
    made = ["stations", "exercise", str(round_run), "--towns", str(towns), "--out", str(out)]
    assert cli.main(made) == 0
    capsys.readouterr()
    code = cli.main(["allocate", str(out), str(round_run), "--hours", "2", "--escape-loss", "10", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert (code, found["status"]) == (0, "suggested")
    assert found["nearest"]
    assert found["units"]["cost"] == "USD"


def test_the_command_prints_a_suggestion_or_why_there_is_none(round_run, station_file, capsys):
    line = ["allocate", str(station_file), str(round_run), "--hours", "2", "--divisions", "3"]
    sent = "--standard-response", "engine/3=2", "--minutes", "45"
    assert cli.main([*line, *sent]) == 0
    text = capsys.readouterr().out
    assert "division A" in text
    assert "cost     200.00 USD (exercise)" in text
    assert "- Dozer (dozer/2) is committed" in text
    assert "  North (1 of 7) " in text
    assert cli.main([*line, "--budget", "1", "--json", "--contain-all"]) == 1
    out, err = capsys.readouterr()
    assert json.loads(out)["status"] == "infeasible"
    assert "the budget of 1.00 is too small by" in err


@pytest.mark.parametrize("text", ["engine", "engine=0", "engine=x", "=3", "engine=1,engine=2", ""])
def test_a_response_that_cannot_be_read_is_told(text):
    with pytest.raises(argparse.ArgumentTypeError, match=r"must have the form|names engine twice"):
        command.parse_response(text)
    assert command.parse_response("engine/3=4, dozer=1") == {"engine/3": 4, "dozer": 1}
