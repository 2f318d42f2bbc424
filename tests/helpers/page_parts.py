"""A page of HTML taken apart with Python's parser: elements, their attributes and texts."""

from __future__ import annotations

import json
from html.parser import HTMLParser

VOID = ("meta", "link", "img", "input", "br", "hr")


class PageParts(HTMLParser):
    """Elements (tag, attributes, text inside) in order, and all text outside of scripts and styles."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str], list[str]]] = []
        self.open: list[int] = []
        self.words: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, {name: value or "" for name, value in attrs}, []))
        if tag not in ("b", "i", "a", "span"):
            self.words.append(" ")
        if tag not in VOID:
            self.open.append(len(self.elements) - 1)

    def handle_endtag(self, tag):
        while self.open and self.elements[self.open.pop()][0] != tag:
            pass

    def handle_data(self, data):
        for index in self.open:
            self.elements[index][2].append(data)
        if not any(self.elements[index][0] in ("script", "style") for index in self.open):
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join("".join(self.words).split())

    def all(self, tag: str, **wanted: str) -> list[tuple[dict[str, str], str]]:
        """Attributes and text of the elements of a tag whose attributes have these values."""
        return [
            (attributes, "".join(inside))
            for name, attributes, inside in self.elements
            if name == tag and all(attributes.get(key) == value for key, value in wanted.items())
        ]

    @property
    def data(self):
        ((_, text),) = self.all("script", id="data")
        return json.loads(text)
