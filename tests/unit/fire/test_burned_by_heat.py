"""Burned area of runs with heat fluxes alone, against fires of known area on cells of 150 m."""

import numpy as np
import pytest
import whole_run
from firetwin.run import burned_by_heat, info
from firetwin.run import opening as runs

CELL, CELLS, PARTS, END = 150.0, 24, 10, 3600.0  # m; s
DELAY = 600.0  # s


def circle(x, y):
    return np.hypot(x - 40.0, y - 65.0) / 0.3


def ellipse(x, y):
    return whole_run._travel(x, y, 0.3, (4.0, 2.3))


def line(angle):
    turned = np.radians(angle)
    return lambda x, y: (np.cos(turned) * x + np.sin(turned) * y + 1500.0) / 0.6


def fire(folder, shape, interval=60.0, **options):
    """Write mean fluxes of exponentially burning fuel; return the run and the arrival in parts of cells."""
    times = np.arange(0.0, END + 1.0, interval)
    metres = (np.arange(CELLS * PARTS) - (CELLS * PARTS - 1) / 2) * CELL / PARTS
    came = np.maximum(shape(*np.meshgrid(metres, metres)), 0.0)
    heat = [1.0 - np.exp(-np.maximum(time - came, 0.0) / DELAY) for time in times]
    cells = np.array(heat).reshape(len(times), CELLS, PARTS, CELLS, PARTS).mean((2, 4)) * 18e6
    flux = np.diff(cells, axis=0, prepend=cells[:1]) / interval
    path = whole_run.write(
        folder, cell=CELL, cells=CELLS, times=tuple(times.tolist()), **{"arrival": False} | options
    )
    np.save(path / "heat_flux.npy", flux.astype(np.float32))
    return runs.open(path), came


@pytest.mark.parametrize("shape", [circle, ellipse, line(0), line(15), line(30), line(45)])
def test_the_area_is_that_of_the_fire(tmp_path, shape):
    """It was up to 16 % too large, as cells were counted whole."""
    run, came = fire(tmp_path / "run", shape)
    moments = [2400.0, 3000.0, END]
    areas = [np.count_nonzero(came <= time) * (CELL / PARTS) ** 2 for time in moments]
    assert info.burned(run, moments) == pytest.approx(areas, rel=0.01)


def test_fluxes_of_five_minutes(tmp_path):
    run, came = fire(tmp_path / "run", ellipse, 300.0)
    area = np.count_nonzero(came <= END) * (CELL / PARTS) ** 2
    assert info.burned(run, [END])[0] == pytest.approx(area, rel=0.02)


def test_uneven_fuel_does_not_count_as_area(tmp_path):
    """Heavy fuel releases four times the heat of the same area."""
    _, came = fire(tmp_path / "run", circle)
    load = np.where(np.indices((CELLS, CELLS)).sum(axis=0) % 3, 0.6, 2.4)
    path = tmp_path / "run"
    np.save(path / "heat_flux.npy", (np.load(path / "heat_flux.npy") * load / 0.6).astype(np.float32))
    np.save(path / "surface_fuel.npy", load.astype(np.float32))
    area = np.count_nonzero(came <= END) * (CELL / PARTS) ** 2
    assert info.burned(runs.open(path), [END])[0] == pytest.approx(area, rel=0.02)


def test_few_cells_and_random_fluxes_tell_nothing(tmp_path):
    run, _ = fire(tmp_path / "run", lambda x, y: np.hypot(x, y) / 0.02)
    assert burned_by_heat.areas(run) is None
    path = tmp_path / "run"
    noise = np.random.default_rng(1).uniform(0.0, 3e4, np.load(path / "heat_flux.npy").shape)
    np.save(path / "heat_flux.npy", noise.astype(np.float32))
    assert burned_by_heat.areas(runs.open(path)) is None


def test_runs_with_arrival_times_count_by_them(tmp_path):
    run, _ = fire(tmp_path / "run", circle, arrival=True)
    expected = np.count_nonzero(run.fuel_arrival_time() <= 2000.0) * CELL**2
    assert info.burned(run, [2000.0])[0] == pytest.approx(expected, rel=1e-3)


def test_fluxes_are_read_once_if_they_fit_into_the_memory(tmp_path, monkeypatch):
    run, _ = fire(tmp_path / "run", circle)

    class Counting:
        read = 0

        def __getattr__(self, name):
            return getattr(run, name)

        def frames(self, name):
            self.read += 1
            return run.frames(name)

    once, twice = Counting(), Counting()
    areas = burned_by_heat.areas(once)
    monkeypatch.setattr(burned_by_heat, "_KEPT", 0)
    assert burned_by_heat.areas(twice).tolist() == areas.tolist()
    assert (once.read, twice.read) == (1, 2)
