"""Smoke of a shot in words: a still counts the smoke of its spin-up."""

from types import SimpleNamespace

import pytest
import whole_run
from firetwin.run import readers, times
from firetwin.shot.sections import Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot
from firetwin.smoke import plume_mass


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
