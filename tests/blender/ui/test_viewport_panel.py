"""The panel Viewport: the switch, the stored cost and its table, the text over the view, and reasons."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import firetwin
import pytest
import views
from firetwin.scene.live import cost, hidden_parts, switch
from firetwin.ui import frame_clock
from firetwin.ui.viewport import facts, overlay, panel, redraws


@pytest.fixture
def scene(panel_blend):
    """A built scene, as if it had a live scene too."""
    firetwin.register()
    bpy.ops.wm.open_mainfile(filepath=str(panel_blend))
    yield bpy.context.scene
    firetwin.unregister()


@pytest.fixture
def live(scene, monkeypatch):
    """A live scene that remembers only whether it is shown."""
    scene["shown"] = False
    monkeypatch.setattr(switch, "has_live", lambda scene: True)
    monkeypatch.setattr(switch, "is_live", lambda scene: bool(scene["shown"]))
    monkeypatch.setattr(switch, "show_live", lambda scene, on: scene.__setitem__("shown", on))
    monkeypatch.setattr(cost, "measure", lambda scene, live=None: cost.Cost(7000 if live else 9, 4, 3, 2, 1))
    return scene


def drawn(scene):
    """Return the texts that the panel draws."""
    layout = MagicMock()
    for name in ("column", "row", "split"):
        getattr(layout, name).return_value = layout
    panel.FIRETWIN_PT_viewport.draw(SimpleNamespace(layout=layout), views.context(scene, 400))
    return [call.kwargs["text"] for call in layout.mock_calls if "text" in call.kwargs]


def test_the_button_shows_the_live_scene_and_the_film_scene_again(live):
    assert bpy.ops.firetwin.show_live() == {"FINISHED"}
    assert switch.is_live(live)
    assert "Show film scene" in drawn(live)
    assert bpy.ops.firetwin.show_live() == {"FINISHED"}
    assert not switch.is_live(live)
    assert "Show live scene" in drawn(live)


def test_without_a_live_scene_the_panel_says_how_to_make_one(scene):
    assert any("Build live scene" in text for text in drawn(scene))


def test_measuring_counts_both_scenes_and_drawing_counts_nothing(live, monkeypatch):
    assert "Triangles" not in drawn(live)
    assert bpy.ops.firetwin.viewport_measure() == {"FINISHED"}
    monkeypatch.setattr(cost, "measure", None)
    texts = drawn(live)
    assert texts[texts.index("Triangles") + 1 :][:2] == ["9", "7,000"]
    assert texts[texts.index("Frame") + 1 :][:2] == ["-", "-"]  # no window
    assert any("1,200,000" in text for text in texts)
    facts.facts(live).seconds[True] = 0.02
    assert "20.0 ms" in drawn(live)


def test_reasons_are_read_once_after_a_change(live, monkeypatch):
    calls = []
    monkeypatch.setattr(
        hidden_parts, "why_not_drawn", lambda scene, layer: [f"reason {calls.append(0) or len(calls)}"]
    )
    facts._changed()
    assert "reason 1" in drawn(live)
    assert "reason 1" in drawn(live)
    bpy.context.scene.objects[0].hide_viewport = True
    bpy.context.view_layer.update()
    assert "reason 2" in drawn(live)
    live.frame_set(2)
    assert "reason 3" in drawn(live)


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"shading": "SOLID"}, "shading Material Preview"),
        ({"local_view": object()}, "local view"),
        ({"clip_end": 1000.0}, "1.0 km"),
    ],
)
def test_a_view_says_what_it_does_not_draw(values, word):
    (reason,) = facts.view_reasons(views.space(**values))
    assert word in reason
    assert not [*facts.view_reasons(views.space())]


def test_text_over_the_view_has_cost_and_times(live):
    known = facts.Facts({True: cost.Cost(7000, 4, 3, 2, 1)}, {True: 0.0108})
    assert overlay.lines(known, False, None) == ["Film scene"]
    first, second, third = overlay.lines(known, True, 0.0334)
    assert known.cost[True].text() in first
    assert second.startswith("10.8 ms per frame")
    assert third.startswith("33.4 ms between frames")


def test_playing_begins_again_after_the_last_frame():
    scene = SimpleNamespace(frame_start=1, frame_end=3, frame_current=2)
    assert redraws.next_frame(scene) == 3
    scene.frame_current = 3
    assert redraws.next_frame(scene) == 1


def test_nothing_is_left_in_the_views_and_handlers(live):
    assert overlay._handle is not None
    firetwin.unregister()
    assert overlay._handle is None
    assert facts._changed not in bpy.app.handlers.depsgraph_update_post
    firetwin.register()


def test_the_median_needs_ten_intervals(monkeypatch):
    times = iter([*range(10), 10.5])
    monkeypatch.setattr(frame_clock.time, "monotonic", lambda: next(times))
    clock = frame_clock.FrameClock()
    for _ in range(10):
        clock.note()
    assert clock.median() is None
    clock.note()
    assert clock.median() == 1.0
    clock.clear()
    assert clock.median() is None
