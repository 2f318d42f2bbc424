"""The export panel and its entries in File > Export."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import panel_scene
import pytest
from firetwin.export import formats
from firetwin.export import panel as exports


@pytest.fixture
def panel(panel_blend, tmp_path):
    yield from panel_scene.opened(panel_scene.copied(panel_blend, tmp_path))


def test_the_operator_writes_the_format_of_the_panel_or_of_the_menu(panel, tmp_path):
    panel.export_to, panel.export_frames = "czml", "1-3:2"
    assert bpy.ops.firetwin.export_to() == {"FINISHED"}
    made = tmp_path / "out" / "export_czml"
    assert {each.name for each in made.glob("[!.]*")} == {"scene.czml", "georeference.json"}
    assert bpy.ops.firetwin.export_to(to="kmz", directory=str(tmp_path / "mine")) == {"FINISHED"}
    assert (tmp_path / "mine" / "scene.kmz").is_file()
    panel.export_frames = "1-99"
    with pytest.raises(RuntimeError, match="99"):
        bpy.ops.firetwin.export_to()


def test_every_format_is_an_entry_of_the_menu_and_of_the_panel(panel):
    drawn = MagicMock()
    exports._draw_menu(SimpleNamespace(layout=drawn), bpy.context)
    assert [call.kwargs["text"] for call in drawn.operator.call_args_list] == [
        f"Firetwin: {each.title}" for each in formats.known().values()
    ]
    for name, each in formats.known().items():
        panel.export_to = name
        layout = MagicMock()
        exports.FIRETWIN_PT_export.draw(SimpleNamespace(layout=layout), bpy.context)
        shown = {call.args[1] for call in layout.column().prop.call_args_list}
        assert ("export_smoke" in shown) == each.has_smoke
