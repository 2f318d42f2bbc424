"""XML of other programs as a tree. A document type is refused, as its entities can grow without bound."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from ...errors import input_error


class _NoDoctype(ElementTree.TreeBuilder):
    def doctype(self, *_: object) -> None:
        raise ValueError("it has a document type (<!DOCTYPE), which may be an attack; remove it")


def parse(data: bytes, name: str | Path, fault: str = "not valid XML", remedy: str = "") -> Element:
    """Parse XML; `fault` and `remedy` stand around the reason in the message.

    Raises
    ------
    InputError
        It is not XML, or has a document type.
    """
    try:
        return ElementTree.fromstring(data, ElementTree.XMLParser(target=_NoDoctype()))
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        line, column = getattr(error, "position", (0, -1))
        reason = str(error).partition(":")[0]
        raise input_error(name, f"{fault}: {reason}{remedy}", line=line, column=column + 1) from None
