"""The manual: each panel and operator has a page and a heading that exist."""

import re
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import firetwin
import pytest
from firetwin.ui import manual, manual_pages, sections, sidebar

pytestmark = pytest.mark.posix("manual in its wheel; the zip has one")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The manual as HTML; the folder."""
    out = tmp_path_factory.mktemp("manual")
    manual_pages.write(manual_pages.source(), out)
    return out


@pytest.fixture
def local(written, monkeypatch):
    monkeypatch.setattr(manual, "_local_folder", lambda: written)
    monkeypatch.setattr(manual, "website", lambda: "")


def exists(folder, page):
    """Return whether the manual has a page with this heading."""
    name, _, heading = page.partition("#")
    text = (folder / name).read_text()
    return not heading or f'id="{heading}"' in text


def test_every_link_leads_to_a_heading(local, written):
    prefix, patterns = manual.manual_map()
    assert prefix == written.as_uri() + "/"
    assert [page for _, page in patterns if not exists(written, page)] == []


def test_every_panel_has_a_help_button_that_leads_to_a_heading(registered, local, written):
    panels = [cls for cls in firetwin.ui.classes if issubclass(cls, bpy.types.Panel)]
    assert len(panels) > 20
    for cls in panels:
        assert issubclass(cls, sidebar.SidebarPanel)
        layout = MagicMock()
        cls.draw_header_preset(SimpleNamespace(layout=layout, bl_idname=cls.bl_idname), bpy.context)
        assert "firetwin.help" in str(layout.mock_calls), cls
        page = manual.topic(cls.bl_idname)
        assert exists(written, manual._suffix(page)), (cls, page)


def test_online_manual_finds_settings_and_operators(registered, local, written):
    lookup = bpy.types.WM_OT_doc_view_manual._lookup_rna_url
    assert lookup("bpy.ops.firetwin.farm_status", verbose=False) == f"{written.as_uri()}/farm.html"
    for section in sections.sections():
        kind = f"bpy.types.FIRETWIN_PG_{section.table.__name__.lower()}.anything"
        assert lookup(kind, verbose=False).endswith(f"settings.html#{section.name}"), section.name
    assert lookup("bpy.types.FIRETWIN_PG_scene.output", verbose=False).endswith("settings.html")


def test_a_website_in_the_manifest_replaces_local_files(monkeypatch):
    monkeypatch.setattr(manual, "website", lambda: "https://example.org/firetwin")
    assert manual.address("farm#slurm") == "https://example.org/firetwin/farm/#slurm"


def test_help_opens_the_page(registered, local, written, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert bpy.ops.firetwin.help(page="stations#in-blender") == {"FINISHED"}
    assert opened == [f"{written.as_uri()}/stations.html#in-blender"]


def test_pages_are_valid_html_with_their_content(written):
    farm = (written / "farm.html").read_text()
    assert "<th>scheduler</th>" in farm
    assert '<a href="how/farm.html">' in farm
    assert "```" not in farm
    assert "](" not in re.sub(r"<pre>.*?</pre>|<code>.*?</code>", "", farm, flags=re.DOTALL)
    assert '<a href="../index.html">' in (written / "how/farm.html").read_text()
    for page in written.rglob("*.html"):
        text = page.read_text()
        for tag in ("p", "ul", "li", "table", "pre", "code", "b", "a"):
            assert len(re.findall(rf"<{tag}[ >]", text)) == text.count(f"</{tag}>"), (page.name, tag)


def test_markup_in_code_stays():
    text = manual_pages.to_html("A `**x** < [y](z)` and **bold** *it*\n", manual_pages.source())
    assert "<code>**x** &lt; [y](z)</code> and <b>bold</b> <i>it</i>" in text
