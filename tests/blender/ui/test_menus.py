"""Every operator has a name, a menu entry that F3 finds, and a page of the manual."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import firetwin
import operator_table
import pytest
from firetwin.ui import menus

pytestmark = pytest.mark.usefixtures("registered")


def test_f3_finds_every_operator_by_a_full_name():
    for name in operator_table.operators():
        names = operator_table.full_names(name)
        assert names or name in menus.WITHOUT_ENTRY, name
        for each in names:
            assert each.startswith("Firetwin > ")
            assert len(each.split()) > 5, f"{each} says nothing alone"


def test_every_operator_has_a_help_link():
    assert [name for name in operator_table.operators() if not operator_table.link(name)] == []


def test_names_of_operators_differ():
    labels = [cls.bl_label for cls in operator_table.operators().values()]
    assert len(set(labels)) == len(labels)
    alone = {"Status", "List", "Go to", "Resume", "Submit", "Queue", "Quality", "Map", "Preview", "Stop"}
    panels = {cls.bl_label for cls in firetwin.ui.classes if issubclass(cls, bpy.types.Panel)}
    assert not alone & ({*labels} | panels)


def test_entries_of_menus_exist_and_can_be_drawn():
    for lines in (*menus.MENUS.values(), menus.PIE):
        for line in lines:
            if isinstance(line, menus.Submenu):
                assert hasattr(bpy.types, line.name), line
                continue
            properties = getattr(bpy.ops.firetwin, line.operator).get_rna_type().properties
            assert {*line.options, *filter(None, [line.choice])} <= {*properties.keys()}, line
    for cls in menus.classes:
        layout = MagicMock()
        cls.draw(SimpleNamespace(layout=layout), bpy.context)
        assert layout.mock_calls


def test_the_pie_has_a_line_for_each_of_its_eight_sectors():
    assert len(menus.PIE) == 8


def test_sectors_of_the_pie_are_operators():
    """A submenu of a pie does not open by its number."""
    layout = MagicMock()
    menus.FIRETWIN_MT_pie.draw(SimpleNamespace(layout=layout), bpy.context)
    pie = layout.menu_pie.return_value
    assert [call.args[0] for call in pie.operator.call_args_list].count("wm.call_menu") == 3
    assert len(pie.operator.call_args_list) == len(menus.PIE)
    assert not pie.menu.called
    assert not pie.operator_menu_enum.called
    assert all(hasattr(bpy.types, name) for name in map(menus.pie_menu_name, menus.PIE) if name)


def test_a_section_is_reset_from_the_menu():
    forest = bpy.context.scene.firetwin.forest
    usual = forest.draw_distance
    forest.draw_distance = usual + 100.0
    bpy.ops.firetwin.reset(section="forest")
    assert forest.draw_distance == pytest.approx(usual)
