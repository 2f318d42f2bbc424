"""The artists' page agrees with the test in Blender's window, and its pictures exist and are small."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs/artists.md"


def followed():
    """Find the buttons and texts of the test in the window, in order."""
    calls = [
        node
        for node in ast.walk(ast.parse((ROOT / "tests/system/window/page.py").read_text("utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("words.next", "_go")
    ]
    calls.sort(key=lambda node: node.lineno)
    return [each.value for call in calls for each in call.args if isinstance(each, ast.Constant)]


def test_the_window_test_follows_the_page_word_by_word():
    text = PAGE.read_text("utf-8").partition("<!-- followed -->")[2].partition("<!-- end")[0]
    assert [bold or typed for bold, typed in re.findall(r"\*\*(.+?)\*\*|`(.+?)`", text)] == followed()


def test_the_pages_pictures_are_there_and_small():
    links = re.findall(r"!\[.+?\]\((.+?)\)", PAGE.read_text("utf-8"))
    sizes = {link: (PAGE.parent / link).stat().st_size for link in links}
    assert len(sizes) >= 5
    assert max(sizes.values()) <= 150_000
    assert sum(sizes.values()) < 1_000_000
    assert "docs/artists.md" in (ROOT / "README.md").read_text("utf-8")
