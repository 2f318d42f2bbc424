"""The panel of a suggested allocation: its operator, text and line in the scene."""

import json
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import exercise_stations
import panel_scene
import pytest
from firetwin.allocation import job as allocation_job
from firetwin.allocation import panel as allocation
from firetwin.allocation.panel import text as allocation_text
from firetwin.blender import owned
from firetwin.errors import Error
from firetwin.jobs.worker import StoppedError
from firetwin.scene.camera import ground_raycast
from firetwin.scene.stations import control_line
from firetwin.stations.records import EXERCISE
from firetwin.ui import working


def sent(name, station, arrival):
    """A resource that is sent."""
    own = {"id": "11-1", "type": "engine/3", "origin": "exercise", "line": 500.0, "cost": 10.0}
    return own | {"name": name, "station": station, "arrival": arrival}


def line(division, held, *lines):
    """The feature of a control line."""
    about = {"kind": "control_line", "division": division, "held": held}
    return {"properties": about, "geometry": {"type": "MultiLineString", "coordinates": lines}}


PLAN = {
    "hour": 2.0,
    "front": 1000.0,
    "line": 660.0,
    "missing": 340.0,
    "missing_rate": 170.0,
    "line_of_all": 1400.0,
    "hour_of_all": 2.0,
    "cost": 10.0,
    "resources": [sent("R12", "Base Two", 90.0)],
}
INSIDE = [[-120.560, 38.826], [-120.556, 38.829], [-120.552, 38.826]]
OTHER = [[-120.560, 38.822], [-120.556, 38.819]]
OUTSIDE = [[-110.0, 30.0], [-110.1, 30.0]]


def recorded():
    """A result of `job.suggest`: A is held, B is not, C has no fire."""
    return {
        "run": "Small",
        "from": "2014-09-17T21:00:00+00:00",
        "label": EXERCISE,
        "reasons": [],
        "hours": [1.0, 2.0],
        "divisions": [
            {
                "name": "A",
                "perimeter": [400.0, 480.0],
                "contained_at_hour": 2.0,
                "line": 500.0,
                "resources": [sent("R11", "Base Two", 21.0)],
            },
            {
                "name": "B",
                "perimeter": [900.0, 1000.0],
                "contained_at_hour": None,
                "line": 0.0,
                "resources": [],
                "nearest_plan": PLAN,
            },
            {"name": "C", "perimeter": [0.0, 0.0], "contained_at_hour": None, "resources": []},
        ],
        "sums": {"cost": 20.0, "loss": 0.0, "above_bound": 0.0, "same_each_time": True},
        "left_out": [],
        "units": {"cost": "USD"},
        "map": {
            "features": [
                line("A", True, INSIDE, OUTSIDE),
                line("B", False, OTHER),
                line("C", False, OUTSIDE),
                {"properties": {"kind": "division_break"}, "geometry": {"coordinates": [0.0, 0.0]}},
            ]
        },
    }


@pytest.fixture(scope="module")
def blend(panel_blend, tmp_path_factory):
    """A scene that the panel built, as a file, next to a station file."""
    folder = tmp_path_factory.mktemp("allocation")
    exercise_stations.write(folder / "stations.gpkg")
    return panel_scene.copied(panel_blend, folder)


@pytest.fixture
def panel(blend, monkeypatch):
    """The panel of that scene with the station file, and the recorded result in place of the solver's."""
    calls = []

    def suggest(units, run, request, start, **options):
        calls.append((units, request, start, options))
        return recorded()

    monkeypatch.setattr(allocation_job, "suggest", suggest)
    monkeypatch.setattr(allocation_job, "default_order_time", lambda run: 0.0)
    for settings in panel_scene.opened(blend):
        settings.stations.file = str(blend.parent / "stations.gpkg")
        yield SimpleNamespace(settings=settings, calls=calls)


def lines():
    """Objects of control lines in the scene."""
    return owned.stage(bpy.context.scene).objects_of(control_line.PART)


def shown():
    """Text of the stored result."""
    return allocation_text.describe(bpy.context.scene.firetwin.allocation)


def test_the_result_names_resources_and_times_and_the_plan_for_what_cannot_be_held(panel):
    assert bpy.ops.firetwin.allocate() == {"FINISHED"}
    assert working.last_messages(allocation.FIRETWIN_OT_allocate)[-1].text == (
        "1 of 2 divisions with fire can be held"
    )
    a, b, c, left = shown().blocks
    assert (a.title, b.title, c.title) == (
        "Division A: held",
        "Division B: cannot be held",
        "Division C: no fire",
    )
    assert a.lines == (
        "Contained 17 Sep 2014 15:00 -08, after 2 h",
        "Line 500 m, front 480 m",
        "R11 (engine/3, Base Two): arrives 17 Sep 2014 13:21 -08",
    )
    assert b.lines == (
        "Nearest feasible plan: 660 m of 1,000 m (66 %)",
        "by 17 Sep 2014 15:00 -08; 340 m are missing",
        "All available resources together would contain it by 17 Sep 2014 15:00 -08",
        "R12 (engine/3, Base Two): arrives 17 Sep 2014 14:30 -08",
    )
    assert left.title == "Resources left out: 1"
    assert left.lines[0].startswith("R13 (engine/6) is ")
    assert shown().label == EXERCISE
    assert shown().head == ("Ordered 17 Sep 2014 13:00 -08, for 2 h", "Cost 20 USD")


def test_settings_of_the_panel_reach_the_solver(panel):
    settings = panel.settings
    bpy.ops.firetwin.allocate()
    settings.allocation_hours, settings.allocation_divisions, settings.allocation_budget = 3, 6, 5000.0
    settings.allocation_from = "frame"
    bpy.context.scene.frame_set(2)
    bpy.ops.firetwin.allocate()
    (units, request, first, options), (_, other, then, more) = panel.calls
    assert {each.station for each in units} == {"Base Two"}
    assert (request.budget, other.budget) == (None, 5000.0)
    assert request.escape == float("inf")
    assert (options["hours"], options["count"], more["hours"], more["count"]) == (None, 4, 3, 6)
    assert options["stop"] is not None
    assert then > first


def test_two_suggestions_leave_one_line_of_each_division_and_remove_deletes_them(panel):
    bpy.ops.firetwin.allocate()
    assert bpy.ops.firetwin.allocate() == {"FINISHED"}
    assert sorted(obj.name for obj in lines()) == ["Firetwin Line A, Held", "Firetwin Line B, Not Held"]
    for obj in lines():
        assert obj.hide_render
        assert tuple(obj.color) == pytest.approx(obj.active_material.diffuse_color)
        assert len(obj.data.splines) == 1
        first = obj.data.splines[0].points[0].co
        ground = ground_raycast.terrain_height(owned.stage(bpy.context.scene), first)
        assert 0.0 < first.z - ground < 30.0
    assert len([each for each in bpy.data.materials if "Line" in each.name]) == 2
    owned.remove(bpy.context.scene)
    assert not [each for each in bpy.data.curves if "Line" in each.name]
    assert not [each for each in bpy.data.materials if "Line" in each.name]


def test_without_a_scene_the_result_is_stored_without_a_line(panel):
    bpy.ops.firetwin.remove()
    bpy.ops.firetwin.allocate()
    assert shown().blocks
    assert not owned.has_data(bpy.context.scene)
    assert "Build the scene, then suggest again" in (
        working.last_messages(allocation.FIRETWIN_OT_allocate)[0].text
    )


def test_reasons_and_a_stop_are_messages_and_a_stop_keeps_the_old_result(panel, monkeypatch):
    none = recorded() | {"reasons": ["too few"], "sums": None}
    monkeypatch.setattr(allocation_job, "suggest", lambda *_, **__: none)
    bpy.ops.firetwin.allocate()
    assert shown().head[1] == "No allocation: too few"
    assert shown().blocks[0].title == "Division A: no allocation"
    before = panel.settings.allocation

    def stopped(*_, stop, **__):
        raise StoppedError

    monkeypatch.setattr(allocation_job, "suggest", stopped)
    assert bpy.ops.firetwin.allocate() == {"CANCELLED"}
    assert panel.settings.allocation == before


def test_an_error_of_the_solver_is_reported(panel, monkeypatch):
    def failing(*_, **__):
        raise Error("allocation needs the Python package scipy")

    monkeypatch.setattr(allocation_job, "suggest", failing)
    with pytest.raises(RuntimeError, match="needs the Python package scipy"):
        bpy.ops.firetwin.allocate()
    assert not panel.settings.allocation


def test_it_needs_a_station_file(panel):
    assert bpy.ops.firetwin.allocate.poll()
    panel.settings.stations.file = ""
    assert not bpy.ops.firetwin.allocate.poll()


def drawn(monkeypatch):
    """Texts that the panel draws for a result, with every division unfolded."""
    texts, layout = [], MagicMock()
    layout.panel.return_value = (layout, layout)
    layout.column.return_value = layout
    layout.label.side_effect = lambda text="", **_: texts.append(text)
    monkeypatch.setattr(allocation, "draw_paragraph", lambda context, layout, text, *_: texts.append(text))
    allocation._draw_result(bpy.context, layout, bpy.context.scene.firetwin)
    return texts


def test_the_panel_draws_every_line_and_says_when_its_files_have_changed(panel, monkeypatch):
    bpy.ops.firetwin.allocate()
    texts = drawn(monkeypatch)
    assert texts[0] == EXERCISE
    assert {line for each in shown().blocks for line in each.lines} < set(texts)
    changed = "The run or station file has changed since; suggest again"
    assert changed not in texts
    panel.settings.stations.file = str(Path(panel.settings.stations.file).with_name("other.gpkg"))
    assert changed in drawn(monkeypatch)


def test_a_long_list_of_resources_is_cut(panel):
    bpy.ops.firetwin.allocate()
    found = json.loads(panel.settings.allocation)
    found["divisions"][0]["resources"] *= 45
    assert allocation_text.describe(json.dumps(found)).blocks[0].lines[-1] == (
        "and 5 more; firetwin allocate lists all"
    )
