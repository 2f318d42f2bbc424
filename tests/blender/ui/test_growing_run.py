"""A run that grows offers its new times in the panel Run."""

from types import SimpleNamespace

import bpy
import growing_model
import pytest
from firetwin.growing import panel as growing_run
from firetwin.growing import watch
from firetwin.ui import folder_watch, run

pytest.importorskip("netCDF4")


class Layout:
    """In place of a layout: keeps its labels and buttons."""

    def __init__(self):
        self.drawn = []

    def column(self, **_):
        return self

    def label(self, text="", **_):
        self.drawn.append(text)

    def operator(self, name, text="", **_):
        self.drawn.append(text)


@pytest.fixture
def model(tmp_path, monkeypatch):
    """A model with two complete times, and its watch."""
    monkeypatch.setattr(watch.worker, "run", lambda work, **_: work())
    writer = growing_model.Writer(tmp_path / "fire.nc", "netcdf3")
    look = watch.Watch(watch.WatchRequest(tmp_path / "fire.nc", tmp_path / "DIR", idle=1e-6), lambda _: None)
    for _ in range(3):
        writer.append()
    look.poll()
    yield SimpleNamespace(writer=writer, watch=look, out=tmp_path / "DIR")
    writer.close()
    growing_run.unregister()


def lines(folder):
    """Lines of the panel."""
    preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    layout, context = Layout(), SimpleNamespace(preferences=preferences, region=SimpleNamespace(width=2000))
    growing_run.draw_run(context, layout, folder)
    return layout.drawn


def looked():
    assert growing_run._watch.tick() == folder_watch.SHORT
    growing_run._watch.thread.join()
    return growing_run._watch.tick()


def test_new_times_are_offered_until_they_are_read(panel, model):
    panel.run = str(model.out)
    assert panel.problem == ""
    assert lines(model.out) == ["The model is running; newest time 2020-07-01 20:10 UTC"]
    model.writer.append()
    model.watch.poll()
    assert lines(model.out) == ["The model is running; newest time 2020-07-01 20:10 UTC"]  # not while drawing
    assert looked() == growing_run._PERIOD
    assert lines(model.out)[-1] == "Read 1 new time"
    assert bpy.ops.firetwin.inspect() == {"FINISHED"}
    assert lines(model.out) == ["The model is running; newest time 2020-07-01 20:20 UTC"]
    model.watch.poll()
    assert looked() is None
    assert lines(model.out)[-1] == "Read 1 new time"
    assert "ended" in lines(model.out)[0]


def test_a_time_that_comes_while_the_run_is_read_is_offered(panel, model, monkeypatch):
    collect = run.collect_facts

    def slow(folder):
        found = collect(folder)
        model.writer.append()
        model.watch.poll()
        return found

    monkeypatch.setattr(run, "collect_facts", slow)
    panel.run = str(model.out)
    assert looked() == growing_run._PERIOD
    assert lines(model.out)[-1] == "Read 1 new time"


def test_other_runs_have_no_line(panel, run_folder):
    panel.run = str(run_folder)
    assert panel.facts
    assert lines(run_folder) == []
    assert growing_run._watch.tick() is None
