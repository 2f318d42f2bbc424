"""The panel of stations: the filters of a search; list, 3D view and map share one selection."""

import bpy
import exercise_stations
import firetwin
import numpy as np
import panel_scene
import pytest
from exercise_stations import BASE, BEYOND, NEAR
from firetwin.scene.stations.handles import STATION
from firetwin.stations import describe, picture, search
from firetwin.stations.query import Query
from firetwin.ui import (
    station_data,
    station_list,
    station_map,
    station_selection,
    station_sync,
    stations_panel,
)


@pytest.fixture(scope="module")
def blend(panel_blend, tmp_path_factory):
    """A scene with stations that the panel built, as a file."""
    folder = tmp_path_factory.mktemp("stations")
    path = panel_scene.copied(panel_blend, folder)
    for panel in panel_scene.opened(path):
        panel.stations.file = str(exercise_stations.write(folder / "stations.gpkg"))
        panel.stations.enabled = True
        bpy.ops.firetwin.build(part="stations")
        bpy.ops.wm.save_mainfile()
    return path


@pytest.fixture
def panel(blend, plain_looks):
    """The panel of that scene, its list made."""
    for panel in panel_scene.opened(blend):
        stations_panel.sync()
        yield panel


def names():
    """Names that are listed, by the window's data."""
    return [row.name for row in bpy.context.window_manager.firetwin_stations.rows]


def handle(key):
    return next(obj for obj in bpy.data.objects if obj.get(STATION) == key)


def click(key):
    """Select a handle as a click in the 3D view does."""
    for obj in bpy.context.view_layer.objects.selected:
        obj.select_set(False)
    handle(key).select_set(True)
    bpy.context.view_layer.objects.active = handle(key)
    bpy.context.view_layer.update()


def searched(**conditions):
    """Names of the stations of a search, each once."""
    return list(
        dict.fromkeys(
            e.station.name for e in search.find(exercise_stations.STATION_FILE, Query(**conditions))
        )
    )


def test_filters_are_those_of_a_search(panel):
    chosen, loaded = panel.station_filter, station_list.shown().loaded
    near = loaded.ignition
    assert names() == ["Near Station", "Base Two", "Beyond"]
    for change, conditions in (
        ({"kind": "Engine, dozer"}, {"kinds": ("engine", "dozer")}),
        ({"types": "3-6"}, {"types": ("3", "4", "5", "6")}),
        ({"mode": "line"}, {"modes": ("line",)}),
        ({"minutes": 30.0}, {"minutes": 30.0}),
        ({"kind": "engine", "within": 5.0}, {"kinds": ("engine",), "within_km": 5.0}),
    ):
        for name in ("kind", "types", "mode", "minutes", "within"):
            chosen.property_unset(name)
        for name, value in change.items():
            setattr(chosen, name, value)
        stations_panel.sync()
        assert names() == searched(near=near, **conditions) != [], change
    rows = bpy.context.window_manager.firetwin_stations.rows
    match = search.find(exercise_stations.STATION_FILE, Query(near=near, kinds=("engine",)))[0]
    assert (rows[0].name, rows[0].minutes) == (match.station.name, f"{match.minutes:.0f} min")
    assert rows[0].exercise


def test_available_and_head_follow_the_time_that_is_shown(panel):
    chosen, scene = panel.station_filter, bpy.context.scene
    chosen.available, chosen.near = True, "head"
    seen = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        stations_panel.sync()
        seen.append(([*names()], station_list.shown().query.near))
    assert [listed for listed, _ in seen] == [["Base Two"], ["Beyond"], ["Beyond"]]
    assert seen[0][1] != seen[2][1]  # the head runs
    panel.property_unset("first_time")
    stations_panel.sync()
    assert names() == []
    assert "build the scene first" in station_list.shown().status


def test_what_cannot_be_listed_is_told(panel, tmp_path):
    panel.station_filter.types = "3-1"
    stations_panel.sync()
    assert names() == []
    assert "goes backwards" in station_list.shown().status
    panel.property_unset("station_filter")
    (tmp_path / "bad.gpkg").write_text("no places")
    panel.stations.file = str(tmp_path / "bad.gpkg")
    stations_panel.sync()
    assert "bad.gpkg" in station_list.shown().status
    panel.stations.file = ""
    stations_panel.sync()
    assert station_list.shown().status == station_list.NO_FILE


def test_the_list_selects_the_sign_and_the_sign_the_list(panel):
    other = bpy.data.objects.new("artist's", None)
    bpy.context.scene.collection.objects.link(other)
    other.select_set(True)
    panel.station_index = names().index("Base Two")
    layer = bpy.context.view_layer
    assert panel.station == BASE
    assert layer.objects.active == handle(BASE)
    assert [*layer.objects.selected] == [handle(BASE)]
    click(NEAR)
    assert panel.station == NEAR
    assert panel.station_index == names().index("Near Station")
    layer.objects.active = other
    layer.update()
    assert panel.station == NEAR  # no station was chosen
    panel.station_index = names().index("Beyond")  # it has no sign
    layer.update()
    assert panel.station == BEYOND
    assert not handle(NEAR).select_get()
    panel.station_filter.kind = "dozer"
    stations_panel.sync()
    assert panel.station_index == -1  # not listed
    assert station_list.detail(panel).station.name == "Beyond"


def test_a_handle_stands_where_the_sign_does_and_no_station_beyond_has_one(panel):
    found = station_selection.handles(bpy.context.scene)
    assert sorted(obj[STATION] for obj in found) == [NEAR, BASE]
    points = [tuple(v.co) for v in bpy.data.objects["Firetwin Signs"].data.vertices]
    for obj in found:
        assert any(np.allclose(obj.location, point, atol=0.01) for point in points)


def test_undo_brings_the_selection_back(panel):
    bpy.ops.ed.undo_push(message="before")
    panel.station_index = names().index("Base Two")
    bpy.ops.ed.undo_push(message="chosen")
    click(NEAR)
    bpy.ops.ed.undo_push(message="clicked")
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    panel = bpy.context.scene.firetwin
    assert (panel.station, bpy.context.view_layer.objects.active[STATION]) == (BASE, BASE)
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    assert bpy.context.scene.firetwin.station == ""
    bpy.ops.ed.redo()
    bpy.context.view_layer.update()
    stations_panel.sync()
    panel = bpy.context.scene.firetwin
    assert (panel.station, panel.station_index) == (BASE, names().index("Base Two"))


def test_saving_keeps_the_selection_and_the_filters(panel, tmp_path):
    panel.station_filter.kind = "engine"
    stations_panel.sync()
    panel.station_index = names().index("Base Two")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    stations_panel.sync()
    assert names() == []
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    stations_panel.sync()
    kept = bpy.context.scene.firetwin
    assert (kept.station, kept.station_filter.kind) == (BASE, "engine")
    assert kept.station_index == names().index("Base Two")
    click(NEAR)
    assert kept.station == NEAR  # the 3D view is followed in this file too


def test_what_is_known_of_the_selected_station(panel):
    panel.station_index = names().index("Base Two")
    lines = station_list.detail(panel).lines
    assert lines[-1] == ("", "Exercise: not operational advice")
    known = dict(lines)
    assert known["Resources"] == "1 x engine/3, 1 x dozer/2"
    assert known["Source"].startswith("Made up exercise")
    assert known["Fire"].startswith(("within ", "not reached, nearest fire "))
    panel.station_index = names().index("Near Station")
    assert "17 Sep 2014" in dict(station_list.detail(panel).lines)["Fire"]
    panel.station_index = names().index("Beyond")
    assert dict(station_list.detail(panel).lines)["Fire"].startswith("outside the run")


def pixels():
    held = station_map.image()
    found = np.empty(held.size[0] * held.size[1] * 4, np.float32)
    held.pixels.foreach_get(found)
    return found.reshape(held.size[1], held.size[0], 4)


def test_the_map_follows_time_and_selection(panel):
    scene = bpy.context.scene
    scene.frame_set(1)
    panel.station_map = True
    bpy.ops.firetwin.station_map()
    first = pixels()
    scene.frame_set(3)
    stations_panel.sync()
    later = pixels()
    assert 0.01 < (np.abs(first - later).max(axis=-1) > 0.05).mean() < 0.9  # the fire
    panel.station_index = names().index("Base Two")
    stations_panel.sync()
    changed = np.argwhere(np.abs(pixels() - later).max(axis=-1) > 0.05)
    row, column = station_list.shown().loaded.plan.pixels([38.872], [-120.515])
    far = np.hypot(changed[:, 0] - row, changed[:, 1] - column)
    assert 6.0 < far.min() < far.max() < 14.0  # a ring
    assert station_map.icon() or bpy.app.background
    before = pixels()
    stations_panel.sync()
    assert (pixels() == before).all()


def test_a_map_with_an_exercise_carries_its_sentence(panel):
    bpy.ops.firetwin.station_map()
    assert any(each.exercise for each in station_list.shown().rows)
    opacity = station_map._exercise_text()
    high, wide = opacity.shape
    assert wide < 512
    strip = pixels()[:high, :wide, :3]
    amber = np.abs(strip - np.array(picture.COLOURS["exercise"])).max(axis=-1) < 0.02
    assert (amber == (opacity[::-1] > 0.97))[opacity[::-1] != 0.97].mean() > 0.98
    assert amber.sum() > 300
    assert strip[opacity[::-1] == 0.0].max() < 0.25


def test_a_click_on_the_map_is_at_the_nearest_station(panel):
    plan = station_list.shown().loaded.plan
    row, column = plan.pixels([38.872], [-120.515])
    assert station_map.station_at((row[0] + 4.0) / 512, (column[0] - 4.0) / 512) == BASE


def test_the_web_map_is_an_address_alone():
    assert (
        describe.web_map_address(38.84, -120.555)
        == "https://www.openstreetmap.org/?mlat=38.84000&mlon=-120.55500#map=14/38.84000/-120.55500"
    )


class Layout:
    """Record of drawn items."""

    def __init__(self, drawn):
        self.__dict__["drawn"] = drawn

    def __getattr__(self, name):
        def call(*arguments, **more):
            self.drawn.append((name, arguments, more))
            return self

        return call

    def __setattr__(self, name, value):
        self.drawn.append((name, (value,), {}))


def test_panels_draw_what_is_known_and_read_nothing(panel, monkeypatch):
    panel.station_index = names().index("Base Two")
    for module, name in ((station_data, "load"), (station_list, "refresh"), (station_map, "update")):
        monkeypatch.setattr(module, name, lambda *_: pytest.fail("the panel works"))
    monkeypatch.setattr(stations_panel, "draw_paragraph", lambda *_: None)  # needs a window
    for cls in (stations_panel.FIRETWIN_PT_stations, stations_panel.FIRETWIN_PT_station_map):
        drawn = []
        cls.draw(type("Self", (), {"layout": Layout(drawn)})(), bpy.context)
        if cls is stations_panel.FIRETWIN_PT_stations:
            assert ("template_list", "FIRETWIN_UL_stations") in [(n, a[0]) for n, a, _ in drawn if a]
            assert ("url", (describe.web_map_address(38.872, -120.515),), {}) in drawn
            assert ("text", ("38.872000 -120.515000",), {}) in drawn  # of Go to
            assert any(m.get("text") == "Exercise: not operational advice" for _, _, m in drawn)


def test_nothing_is_left_behind(panel):
    bpy.ops.firetwin.station_map()
    panel.station_map = True
    stations_panel.sync()
    firetwin.unregister()
    left = [
        function
        for name in dir(bpy.app.handlers)
        if isinstance(handlers := getattr(bpy.app.handlers, name), list)
        for function in handlers
        if function.__module__.startswith("firetwin")
    ]
    assert left == []
    assert not hasattr(bpy.types.WindowManager, "firetwin_stations")
    assert not bpy.app.timers.is_registered(station_sync._tick)
    assert (station_map._kept, station_data._known, station_list.shown().rows) == ([], {}, [])
    firetwin.register()


def test_changes_wake_the_list_in_a_window_alone(monkeypatch):
    calls = []
    station_sync.start(lambda: calls.append(1) or len(calls) < 2)
    try:
        station_sync.wake()
        assert not bpy.app.timers.is_registered(station_sync._tick)  # no window
        assert station_sync._tick() == station_sync._SOON  # still reading
        assert station_sync._tick() is None
        for name in ("frame_change_post", "undo_post", "redo_post", "load_post"):
            assert station_sync.wake in getattr(bpy.app.handlers, name)
    finally:
        station_sync.stop()
    assert not any(station_sync.wake in handlers for handlers in station_sync._watched())
