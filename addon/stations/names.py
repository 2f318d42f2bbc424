"""Names of stations: conversion of upper case, and comparison of names."""

from __future__ import annotations

import re

_SMALL = {"of", "the", "and", "at", "on", "in", "de", "del", "la", "for"}
_CAPITALS = {
    *("BLM", "USFS", "NPS", "BIA", "FWS", "CDF", "CFD", "FD", "FPD", "VFD", "VFC", "EMS", "RFD", "FPA"),
    *("US", "USA", "NE", "NW", "SE", "SW", "II", "III", "IV", "VI", "VII", "HQ", "AFB", "NAS"),
    *("CA", "OR", "NV", "AZ", "ID", "UT", "WA", "MT", "WY", "CO", "NM", "TX"),
}
_WORD = re.compile(r"[A-Za-z]+(?:'[A-Za-z]+)?|\d+|[^A-Za-z\d]+")
_COMMON = {
    *("fire", "station", "sta", "stn", "department", "dept", "fd", "volunteer", "vol", "vfd", "district"),
    *("protection", "dist", "fpd", "number", "no", "of", "the", "company", "co", "rescue", "house"),
}


def make_readable(text: str) -> str:
    """Normalise blanks; convert a text in capitals to capitalised words."""
    text = " ".join(text.split())
    if not text.isupper():
        return text
    return "".join(_capitalise(word, at) for at, word in enumerate(_WORD.findall(text)))


def _capitalise(word: str, at: int) -> str:
    if word in _CAPITALS or not word[0].isalpha():
        return word
    if word.lower() in _SMALL and at > 0:
        return word.lower()
    if word.startswith("MC") and len(word) > 4:
        return f"Mc{word[2:].capitalize()}"
    return word.capitalize()


def may_be_equal(one: str, other: str) -> bool:
    """Return True if two names can belong to one station: equal numbers, and the words of one in the other.

    Common words, such as fire and station, do not count.
    """
    (words, numbers), (others, other_numbers) = _parts(one), _parts(other)
    if numbers and other_numbers and numbers != other_numbers:
        return False
    if not words or not others:
        return bool(numbers & other_numbers) or not (words | others | numbers | other_numbers)
    return words <= others or others <= words


def _parts(name: str) -> tuple[set[str], set[str]]:
    """Split a name into distinctive words and numbers."""
    tokens = re.findall(r"[a-z]+|\d+", name.lower().replace("'", ""))
    words = {token for token in tokens if token.isalpha() and token not in _COMMON}
    return words, {token.lstrip("0") for token in tokens if token.isdigit()}
