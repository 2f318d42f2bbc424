"""The pages agree with the code, the start page is short, and links and pictures exist."""

import re
from pathlib import Path

import pytest
from firetwin.shot import passes
from firetwin.shot.cameras import rigs
from firetwin.shot.schema import walk
from firetwin.shot.settings import Settings
from module_file import load_module

ROOT = Path(__file__).parents[3]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]


MADE = load_module(DOCS / "generate.py").pages()


@pytest.mark.parametrize("name", MADE)
def test_a_page_from_the_code_is_what_the_code_says(name):
    assert (DOCS / name).read_text("utf-8") == MADE[name], "run: .venv/bin/python docs/generate.py"


def test_every_key_pass_and_kind_of_camera_is_there():
    for name in (*passes.known(), *rigs.kinds()):
        assert f"### {name}\n" in MADE["passes_and_cameras.md"]
    text = "".join(MADE.values())
    keys = {part.name for _, part in walk(Settings) if not part.table and not part.key.variants}
    assert not [key for key in keys if f"| `{key}` |" not in text]


def test_the_start_page_is_short():
    text = (ROOT / "README.md").read_text("utf-8")
    assert len(text.splitlines()) <= 150
    assert len(text.split()) <= 1000


def test_the_start_pages_name_the_page_of_each_kind_of_reader():
    readers = {"brief", "datasets", "delivery", "export", "forecasts", "walk"}
    for page, place in ((ROOT / "README.md", "docs/"), (DOCS / "index.md", "")):
        text = page.read_text("utf-8")
        assert not [name for name in readers if f"({place}{name}.md)" not in text], page


def test_the_start_pages_pictures_are_small():
    links = re.findall(r"!\[.+?\]\((.+?)\)", (ROOT / "README.md").read_text("utf-8"))
    sizes = {link: (ROOT / link).stat().st_size for link in links}
    assert len(sizes) >= 8
    assert sizes["docs/pictures/film.webp"] < 3_000_000
    assert sum(sizes.values()) < 4_000_000


@pytest.mark.parametrize("page", sorted((DOCS / "how").glob("*.md")), ids=lambda page: page.stem)
def test_a_page_of_how_it_works_has_a_diagram(page):
    """One that is drawn without a script or a font from elsewhere."""
    links = re.findall(r"!\[.+?\]\((.+?\.svg)\)", page.read_text("utf-8"))
    assert links
    for link in links:
        drawing = (page.parent / link).read_text("utf-8")
        assert "<title>" in drawing
        assert not re.search(r"<script|@import|href=", drawing)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_to_files(page):
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)", page.read_text("utf-8"))
    missing = [link for link in links if not (page.parent / link).exists()]
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_paths_of_the_repository_exist(page):
    """Paths in code, such as `addon/passes/`; `examples/out` is an output."""
    named = re.findall(r"`((?:addon|cpp|tests|docs|examples)/[\w./]+)`", page.read_text("utf-8"))
    missing = [name for name in named if not name.startswith("examples/out") and not (ROOT / name).exists()]
    assert not missing


def test_every_page_is_in_the_menu():
    menu = re.findall(r": ([\w/]+\.md)$", (ROOT / "mkdocs.yml").read_text("utf-8"), re.MULTILINE)
    assert sorted(menu) == sorted(page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md"))
