"""The benchmark's own parts: its rivals compute the same things, its errors are errors, its tables tell."""

import json

import numpy as np
import pytest
from firetwin.bench import emitters, geodesy, interpolation, particles, plots, plume, smoke, table, text
from firetwin.bench.harness import Bench
from firetwin_core.geo import LocalFrame


@pytest.fixture
def report():
    bench = Bench()
    for subject in ("text", "geodesy"):
        bench.subject = subject
        for side, seconds in ((144, 1e-3), (720, 2e-2)):
            for tool, slower in (("firetwin", 1), ("slow", 8)):
                bench.row(
                    f"{side} x {side}",
                    tool,
                    seconds * slower,
                    side**2,
                    "value",
                    error=1e-9 * (slower - 1),
                    error_unit="m",
                )
    bench.target("faster than slow", 8, 4, "x")
    bench.target("error", 6, 5, "nm", most=True)
    bench.rival("no_such_package")
    return bench.report()


def test_tables_say_what_is_met_and_what_is_not(report):
    lines = table.markdown(report).splitlines()
    assert "| geodesy | 720 x 720 | slow | 160 ms | 309 ns/value | 8x |  | 7.0e-09 m |" in lines
    assert "| geodesy | faster than slow | 8 x | >= 4 x | met |" in lines
    assert "| geodesy | error | 6 nm | <= 5 nm | MISSED |" in lines
    assert not any("144 x 144" in line for line in lines)
    assert any("no_such_package is not installed" in line for line in lines)
    assert "MISSED" in table.page(report)


def test_json_is_complete(report):
    data = json.loads(json.dumps(report.as_json()))
    assert [t["met"] for t in data["targets"]] == [True, False]
    assert len(data["rows"]) == 8
    assert data["machine"]["cores"] >= 1


def test_plots_are_drawn(report, tmp_path):
    pytest.importorskip("matplotlib")
    for path in plots.draw(report, tmp_path):
        assert path.read_bytes().startswith(b"\x89PNG")
    assert len(list(tmp_path.iterdir())) == 2


def test_the_best_time_is_the_shortest_of_a_few():
    calls = []
    assert 0 <= Bench().best(lambda: calls.append(1), 4) < 1
    assert len(calls) == 4


def test_wrong_values_are_seen():
    grid = text.grid_text(36)
    values = np.array(grid.split(), float).astype(np.float32)
    assert text.wrong_share(grid, values) == 0
    values[::2] = np.nextafter(values[::2], np.float32(np.inf))
    assert text.wrong_share(grid, values) == 0.5
    hard = text.hard_text()
    by_way_of_double = np.array(hard.split(), float).astype(np.float32)
    assert 0.4 < text.wrong_share(hard, by_way_of_double) < 0.6
    assert len(text.grid_text(1440).split()) == 1440**2


def test_the_geodetic_rival_and_the_reference_agree_with_the_core():
    pytest.importorskip("mpmath")
    points = np.array([38.5, 39.1]), np.array([-121.0, -120.2]), np.array([200.0, 3000.0])
    enu = LocalFrame(*geodesy.ORIGIN).forward(*points)
    np.testing.assert_allclose(geodesy.numpy_enu(*points), enu, rtol=0, atol=1e-8)
    assert geodesy.error(points, enu) < 5e-9
    assert geodesy.error(points, enu + np.array([0, 0, 1e-3])) == pytest.approx(1e-3)


def test_the_emitter_rival_chooses_the_same():
    field, position = emitters.burning(144)
    for ours, theirs in zip(
        emitters.ours(field, position), emitters.with_numpy(field, position), strict=True
    ):
        np.testing.assert_array_equal(ours, theirs)
        assert len(ours) == emitters.BUDGET


def test_front_error_and_departure():
    before, after = np.array([[1.0, 0, 0, 0, 0]]), np.array([[1.0, 1, 1, 1, 0]])
    true = np.array([[1.0, 1, 0, 0, 0]])
    assert interpolation.front_error(true, true, before, after) == 0
    assert interpolation.front_error(after, true, before, after) == pytest.approx(200 / 3)
    assert interpolation.brightness(4 * true) == pytest.approx(16)
    assert interpolation.departure(np.array([1.1, 0.9]), np.array([1.0, 1.0])) == pytest.approx(10)


def test_plumes_rise_as_the_theory_says():
    way, end = plume.errors(1e9)
    assert way < 10
    assert end < 1
    wrong = plume.euler(1e9, 1.0)
    right = plume.euler(1e9, 0.1)
    time, top = right
    assert abs(top / plume.theory(1e9, np.array(time)) - 1) < 0.01
    assert abs(wrong[1] / top - 1) > 1e-3


def test_the_smoke_files_hold_their_mass(monkeypatch):
    bench = Bench(subject="smoke")
    monkeypatch.setattr(smoke, "VOXELS", (400.0, 200.0))
    smoke.run(bench)
    assert all(row.error < 1e-4 and row.bytes > 1000 for row in bench.rows)
    assert any("single" in row.case for row in bench.rows)
    assert "MB |" in table.markdown(bench.report())


def test_the_exact_particle_solves_its_equation():
    """Against Runge and Kutta's method with small steps."""
    pull = np.array([0, 0, particles.LIFT])

    def slope(time, state):
        drag = (particles.wind(time) - state[3:]) / particles.RELAXATION
        return np.concatenate([state[3:], drag + pull])

    state, step = np.concatenate([np.zeros(3), particles.VELOCITY]), 1e-3
    for i in range(2000):
        a = slope(i * step, state)
        b = slope((i + 0.5) * step, state + step / 2 * a)
        c = slope((i + 0.5) * step, state + step / 2 * b)
        d = slope((i + 1) * step, state + step * c)
        state = state + step / 6 * (a + 2 * b + 2 * c + d)
    np.testing.assert_allclose(particles.exact(2.0), state[:3], rtol=0, atol=1e-9)
    assert np.linalg.norm(particles.euler(240, 2) - particles.exact(particles.SECONDS)) < 0.1
