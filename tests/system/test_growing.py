"""`firetwin watch` next to a model's process, and frames of a film that follows it."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import growing_model
import numpy as np
import pytest
from firetwin.growing import follow, watch, watched
from firetwin.jobs import convert, worker
from firetwin.jobs.render import RenderRequest
from firetwin.run import readers
from firetwin.shot.source import ShotSource
from firetwin_core import sensor
from scene_text import NO_PLANTS, NO_SMOKE, TINY

pytest.importorskip("netCDF4")
TIMES = 4
BEGIN = datetime(2020, 7, 1, 20, tzinfo=UTC)
SCENE = (
    """\
run = "{run}"
cache = "cache"
[time]
start = 2020-07-01T20:15:00Z
end = 2020-07-01T20:25:00Z
frames = 2
"""
    + NO_PLANTS
    + NO_SMOKE
    + TINY
    + """\
video = false
[[cameras]]
name = "drone"
[[cameras.keys]]
latitude = 38.8945
longitude = -120.597
height = 400
target_latitude = 38.9032
target_longitude = -120.596
"""
)


def check_values(folder: Path, factor: float = 1.0) -> None:
    """Check that a run has all times with the model's values."""
    run = readers.open(folder)
    assert list(run.times) == [growing_model.STEP * k for k in range(TIMES)]
    for index in range(TIMES):
        np.testing.assert_array_equal(run.heat_flux(index), growing_model.flux(index, factor))


@pytest.mark.parametrize("kind", ["netcdf3", "netcdf4", "zarr"])
def test_a_model_writes_on_while_it_is_watched(tmp_path, monkeypatch, kind):
    """Also with locks of HDF5 in the environment: the watch disables them."""
    pytest.importorskip("zarr" if kind == "zarr" else "netCDF4")
    monkeypatch.setenv("HDF5_USE_FILE_LOCKING", "TRUE")
    (tmp_path / "model").mkdir()
    out, end = tmp_path / "DIR", BEGIN + timedelta(seconds=growing_model.STEP * (TIMES - 1))
    look = watch.Watch(watch.WatchRequest(tmp_path / "model", out, end=end), print)
    path = tmp_path / "model" / ("fire.zarr" if kind == "zarr" else "fire.nc")
    model = growing_model.Process(path, kind)
    for done in range(1, TIMES + 1):
        model.append()
        look.poll()
        assert len(watched.times(out)) == done - 1  # the last time may be incomplete
    assert model.close() == (0, "closed\n", "")
    look.poll()
    look.poll()
    assert look.state == "ended"
    check_values(out)


Worker = worker.Worker


class FreshProcesses:
    """A process of its own for each work, in place of one for all."""

    def __init__(self, **options):
        self.options = options

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def run(self, work, progress, stop, tell):
        with Worker(**self.options) as process:
            return process.run(work, progress, stop, tell)


def test_frames_of_a_growing_run_equal_those_of_the_finished_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = growing_model.Writer(tmp_path / "fire.nc", "netcdf4")
    end = BEGIN + timedelta(seconds=3 * growing_model.STEP)
    look = watch.Watch(watch.WatchRequest(tmp_path / "fire.nc", tmp_path / "DIR", end=end), print)
    model.append()
    said = []

    def wait(_: float) -> None:
        if model.count < TIMES:
            model.append()
        with monkeypatch.context() as patch:
            patch.setattr(
                watch.worker, "run", lambda work, **_: work()
            )  # the model's library is in this process
            look.poll()

    def film(run: str, out: str) -> list[np.ndarray]:
        (tmp_path / f"{out}.toml").write_text(SCENE.format(run=run))
        asked = RenderRequest(tmp_path / out, passes="rgb")
        follow.run(ShotSource(scene=f"{out}.toml"), asked, tell=said.append, wait=wait)
        return [sensor.read_image(tmp_path / out / f"drone/rgb/drone_rgb_00000{k}.png") for k in (1, 2)]

    wait(0.0)
    growing = film("DIR", "growing")
    assert any("1 frame left" in each for each in said)
    model.close()
    convert.run([tmp_path / "fire.nc"], tmp_path / "finished")
    monkeypatch.setattr(follow.worker, "Worker", FreshProcesses)
    for live, after in zip(growing, film("finished", "after"), strict=True):
        np.testing.assert_array_equal(live, after)
    assert (growing[0] != growing[1]).any()
