"""Manual as HTML: the pages of docs/ (Markdown), for a browser on this computer.

Covers the part of Markdown that docs/ uses: headings, paragraphs, lists, tables, fenced code, pictures,
links, bold, italics and code. Anchors of headings are as in MkDocs.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable
from pathlib import Path

from .. import files

_STYLE = """body{max-width:50em;margin:2em auto;padding:0 1em;font:16px/1.5 sans-serif}
body{color:#222;background:#fff}
pre,code{background:#eee;font-size:90%}pre{padding:.6em;overflow:auto}img{max-width:100%}
table{border-collapse:collapse}td,th{border:1px solid #999;padding:.2em .6em}
td,th{text-align:left;vertical-align:top}
@media(prefers-color-scheme:dark){body{color:#ddd;background:#222}pre,code{background:#333}a{color:#8bf}}"""
_BULLET = re.compile(r"(\s*)(?:-|\d+\.) (.*)")
_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def source() -> Path | None:
    """Return the folder of the pages: of the installation, else of the checkout; None without pages."""
    package = Path(__file__).resolve().parents[1]
    folders = (package / "docs", package.parent / "docs")
    return next((folder for folder in folders if (folder / "index.md").is_file()), None)


def write(pages: Path, out: Path) -> None:
    """Write each page of the folder `pages` as an HTML file into the folder `out`, if it has changed."""
    for path in sorted(pages.rglob("*.md")):
        target = out / path.relative_to(pages).with_suffix(".html")
        home = "../" * (len(path.relative_to(pages).parts) - 1) + "index.html"
        text = to_html(path.read_text(encoding="utf-8"), path.parent, home)
        if not target.is_file() or target.read_text(encoding="utf-8") != text:
            target.parent.mkdir(parents=True, exist_ok=True)
            files.write_text(target, text)


def anchor(heading: str) -> str:
    """Return the anchor of a heading, as MkDocs makes it."""
    plain = re.sub(r"[^\w\s-]", "", re.sub(r"[`*]|\]\(.*?\)", "", heading)).strip().lower()
    return re.sub(r"[-\s]+", "-", plain)


def to_html(text: str, folder: Path, home: str = "index.html") -> str:
    """Convert a page; its pictures are read from `folder`, and its first line links `home`."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    lines, body = text.splitlines(), []
    title = next((line[2:] for line in lines if line.startswith("# ")), "Firetwin")
    while lines:
        body.append(_block(lines, folder))
    head = f'<meta charset="utf-8"><title>{html.escape(title)}</title><style>{_STYLE}</style>'
    top = f'<p><a href="{home}">Firetwin</a></p>'
    return f'<!doctype html><html lang="en"><head>{head}</head><body>{top}{"".join(body)}</body></html>\n'


def _block(lines: list[str], folder: Path) -> str:
    """Take a block from the front of the lines, and convert it."""
    line = lines.pop(0)
    if not line.strip():
        return ""
    if line.lstrip().startswith("```"):
        return _code(lines)
    if found := re.match(r"(#+) (.*)", line):
        level = len(found[1])
        return f'<h{level} id="{anchor(found[2])}">{_inline(found[2], folder)}</h{level}>\n'
    if line.startswith("|"):
        return _table([line, *_take(lines, lambda each: each.startswith("|"))], folder)
    if _BULLET.match(line):
        return _list(
            [line, *_take(lines, lambda each: bool(each.strip()) and not each.startswith("#"))], folder
        )
    rest = _take(lines, lambda each: bool(each.strip()) and not re.match(r"#+ |\||```|- ", each))
    return f"<p>{_inline(' '.join([line, *rest]), folder)}</p>\n"


def _take(lines: list[str], wanted: Callable[[str], bool]) -> list[str]:
    """Take lines from the front while they are wanted."""
    taken = []
    while lines and wanted(lines[0]):
        taken.append(lines.pop(0))
    return taken


def _code(lines: list[str]) -> str:
    code = _take(lines, lambda each: not each.lstrip().startswith("```"))
    del lines[:1]
    return f"<pre>{html.escape(chr(10).join(code))}</pre>\n"


def _table(lines: list[str], folder: Path) -> str:
    rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))] for line in lines]
    markup = []
    for number, row in enumerate(rows):
        if number == 1:  # dashes below the head
            continue
        tag = "th" if number == 0 else "td"
        markup.append(f"<tr>{''.join(f'<{tag}>{_inline(cell, folder)}</{tag}>' for cell in row)}</tr>")
    return f"<table>{''.join(markup)}</table>\n"


def _list(lines: list[str], folder: Path) -> str:
    items: list[str] = []
    for line in lines:
        if found := _BULLET.match(line):
            items.append(found[2])
        else:
            items[-1] += f" {line.strip()}"
    tag = "ol" if lines[0].lstrip()[0].isdigit() else "ul"
    return f"<{tag}>{''.join(f'<li>{_inline(item, folder)}</li>' for item in items)}</{tag}>\n"


def _inline(text: str, folder: Path) -> str:
    """Convert code, links, pictures, bold and italics of a text; code keeps its characters."""
    parts = re.split(r"(`[^`]+`)", text)
    codes = {f"\0{number}\0": part for number, part in enumerate(parts) if number % 2}
    plain = "".join(f"\0{number}\0" if number % 2 else part for number, part in enumerate(parts))
    html_text = html.escape(plain.replace("\\|", "|"), quote=False)
    html_text = _LINK.sub(lambda found: _link(found, folder), html_text)
    html_text = re.sub(r"\*\*(.+?)\*\*", r"<b>\1</b>", html_text)
    html_text = re.sub(r"\*([^*]+)\*", r"<i>\1</i>", html_text)
    for mark, code in codes.items():
        html_text = html_text.replace(mark, f"<code>{html.escape(code.strip('`'))}</code>")
    return html_text


def _link(found: re.Match[str], folder: Path) -> str:
    """Convert a link to a page or an address, or a picture."""
    picture, label, target = found.groups()
    if picture:
        path = folder / target
        return f'<img src="{path.resolve().as_uri()}" alt="{label}">' if path.is_file() else f"<i>{label}</i>"
    page = re.sub(r"\.md(?=#|$)", ".html", target)
    if "://" not in target and ".md" not in target and not target.startswith("#"):
        return label  # a file of the checkout
    return f'<a href="{page}">{label}</a>'
