"""Smoke of a shot in words: a still counts the smoke of its spin-up."""

from threading import Event
from types import SimpleNamespace

import pytest
import whole_run
from firetwin.errors import Error, InputError
from firetwin.run import readers, times
from firetwin.shot.sections import Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import coarse, plume_mass
from firetwin.smoke.integrator import Integrator


@pytest.mark.parametrize("frames", [1, 2])
def test_a_still_counts_the_smoke_before_it(tmp_path, monkeypatch, frames):
    """A still said "0 kg of smoke in 0 min" next to an optical depth of 320."""
    run = readers.open(whole_run.write(tmp_path / "run", cells=16))
    start = run.times[0] + 1800.0
    time = Time(start=times.utc(run, start), frames=frames, fps=1)
    shot = Shot(Settings(path=tmp_path / "scene.toml", time=time), run)
    monkeypatch.setattr(plume_mass.sources, "select", lambda shot: SimpleNamespace(snapshot=int, domains=[]))
    text = plume_mass.describe(shot)
    first = start - shot.spin_up if frames == 1 else start
    assert plume_mass.measure(shot).made == pytest.approx(shot.fire.smoke_made(first, shot.frames.last))
    assert not text.startswith("0 kg")
    assert ("before the picture" in text) == (frames == 1)


def test_smoke_of_a_fire_without_fuel_is_not_of_crowns(tmp_path, monkeypatch):
    run = readers.open(whole_run.write(tmp_path / "run", cells=16, surface=0.0))
    shot = Shot(Settings(path=tmp_path / "scene.toml", time=Time(frames=2, fps=1)), run)
    monkeypatch.setattr(plume_mass.sources, "select", lambda shot: SimpleNamespace(snapshot=int, domains=[]))
    assert plume_mass.describe(shot).endswith("from its heat, as no fuel burns")


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("the wind is too strong for the grid; use a shorter time step", "is too fast"),
        ("the flow has diverged to infinity; use a shorter time step", "becomes infinitely fast"),
    ],
)
def test_air_that_is_too_fast_for_its_cells_is_an_error_with_file_time_and_remedy(
    tmp_path, monkeypatch, fault, words
):
    run = readers.open(whole_run.write(tmp_path / "run", cells=16, wind=(0.0, 0.0), speed=0.1))
    start = times.utc(run, run.times[0] + 1800.0)
    shot = Shot(Settings(path=tmp_path / "scene.toml", time=Time(start=start, frames=1)), run)
    solved = coarse.CoarseFlow(shot)
    solving = Integrator(solved.shot, solved.domains, Event(), 1)

    def fail(*_):
        raise Error(fault)

    fast = SimpleNamespace(time=60.0, step=fail, set_wind=lambda _: None, set_sources=lambda *_: None)
    monkeypatch.setattr(solving, "solvers", [fast])
    with pytest.raises(
        InputError, match=rf"run: .* at 2020-07-01T2.*wind of 0 m/s, the air {words}.*smoke.enabled = false"
    ):
        solving.advance(1.0)


def test_the_flow_emits_the_smoke_of_the_fire(tmp_path, monkeypatch):
    run = readers.open(
        whole_run.write(
            tmp_path / "run", cells=32, cell=10.0, times=(0.0, 60.0, 150.0, 600.0, 720.0, 1200.0), lasts=60.0
        )
    )
    time = Time(start=times.utc(run, run.times[0] + 600.0), frames=8, fps=1, speed=60.0)
    solved = coarse.CoarseFlow(Shot(Settings(path=tmp_path / "scene.toml", time=time), run))
    solving = Integrator(solved.shot, solved.domains, Event(), 1)
    rates = []
    solver = SimpleNamespace(set_wind=lambda _: None, set_sources=lambda *parts: rates.append(parts[2].sum()))
    monkeypatch.setattr(solving, "solvers", [solver])
    emitted = 0.0
    for step, length in enumerate(solving.steps):
        solving.step = step
        solving._update_sources()
        emitted += length * rates[-1]
    shot = solved.shot
    assert len(rates) > 3
    assert emitted == pytest.approx(shot.fire.smoke_made(solving.begin, shot.frames.last), rel=1e-3)
