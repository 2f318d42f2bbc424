"""Viewer page: one HTML file with the glTF scene, three.js and the page's scripts, which loads no other file.

Its content security policy allows the scripts by their hashes and blocks all requests; browsers read pictures
inside of the scene as `blob:`.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template

import firetwin_core

from ..html_text import quote

_FOLDER = Path(__file__).parent / "viewer"
_POLICY = (
    "default-src 'none'; img-src data: blob:; connect-src blob:; style-src '{style}'; script-src {scripts}; "
    "base-uri 'none'; form-action 'none'"
)
_THREE = "https://threejs.org"


@dataclass(frozen=True)
class PageText:
    """Texts of the page.

    Attributes
    ----------
    name
        Name of the run.
    marks
        Words that lie across the view, such as "SYNTHETIC", and the sentence that explains each.
    facts
        Names and values about the scene.
    credit
        Credits that the view must show; empty: none.
    """

    name: str
    marks: Sequence[tuple[str, str]]
    facts: Sequence[tuple[str, str]]
    credit: str


def html(scene: bytes, text: PageText) -> str:
    """Build the page of a .glb, whose scene has the extras of `gltf.describe`."""
    style, library = _read("page.css"), _read("three/three.js")
    script = _read("scene.js") + _read("page.js")
    scripts = " ".join(f"'{_hash(each)}'" for each in (library, script))
    stamp = "".join(f"<span>{quote(word)}</span>" for word, _ in text.marks)
    parts = {
        "policy": _POLICY.format(style=_hash(style), scripts=scripts),
        "generator": f"Firetwin {firetwin_core.__version__}",
        "name": quote(text.name),
        "style": style,
        "marks": "".join(f'<p class="mark">{quote(sentence)}</p>' for _, sentence in text.marks),
        "stamp": f'<div class="stamp" aria-hidden="true">{stamp}</div>' if stamp else "",
        "credit": f'<p class="credit">{quote(text.credit)}</p>' if text.credit else "",
        "about": _definitions(text.facts),
        "sources": _sources(text.credit),
        "scene": base64.b64encode(gzip.compress(scene, 9, mtime=0)).decode(),
        "library": library,
        "script": script,
    }
    return Template(_read("page.html")).substitute(parts)


def _read(name: str) -> str:
    return (_FOLDER / name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    """Return the source of a script or style in a content security policy."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _definitions(facts: Sequence[tuple[str, str]]) -> str:
    rows = "".join(f"<dt>{quote(name)}</dt><dd>{quote(value)}</dd>" for name, value in facts)
    return f"<dl>{rows}</dl>"


def _sources(credit: str) -> str:
    data = f"<p><b>Data</b>: {quote(credit)}</p>" if credit else ""
    licence = "\n".join(map(quote, _read("three/LICENSE").splitlines()))
    return (
        f"{data}<p><b>Page</b>: Firetwin {quote(firetwin_core.__version__)}, GPL-3.0-or-later.</p>"
        f'<p><b>3-D script</b>: <a href="{_THREE}" rel="noopener noreferrer">three.js</a> 0.187.0, MIT:</p>'
        f"<pre>{licence}</pre>"
    )
