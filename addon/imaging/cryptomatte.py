"""Cryptomatte 1.2: mattes of many named objects in a few float channels.

Source: Friedman and Jones, "Fully automatic ID mattes with support for motion blur and transparency",
SIGGRAPH 2015 posters, and Psyop's specification at github.com/Psyop/Cryptomatte. Names are hashed by Austin
Appleby's MurmurHash3_32 (public domain) with seed 0.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

RANKS = 6
"""Objects that a pixel can have; each layer of four channels has two."""

_FIRST, _SECOND, _ADDED = np.uint32(0xCC9E2D51), np.uint32(0x1B873593), np.uint32(0xE6546B64)
_LAST = (np.uint32(0x85EBCA6B), np.uint32(0xC2B2AE35))
_EXPONENT = np.uint32(23)  # lowest bit of a float's exponent

Words = NDArray[np.uint32]


def channels(name: str) -> list[str]:
    """Return the channel names of a matte, in the order of `ranked`."""
    return [f"{name}{layer:02d}.{part}" for layer in range(RANKS // 2) for part in "rgba"]


def attributes(name: str, manifest: str, is_file: bool = False) -> dict[str, str]:
    """Collect the header attributes of a matte.

    Parameters
    ----------
    name
        Name of the matte, without dots.
    manifest
        Result of `manifest`, or the name of a file in the folder of the EXR with this text.
    is_file
        The manifest is a file name.
    """
    start = f"cryptomatte/{int(hash_names([name])[0]):08x}"[:-1]  # keys have seven digits
    return {
        f"{start}/name": name,
        f"{start}/hash": "MurmurHash3_32",
        f"{start}/conversion": "uint32_to_float32",
        f"{start}/{'manif_file' if is_file else 'manifest'}": manifest,
    }


def manifest(numbers: Mapping[str, np.float32]) -> str:
    """Return the JSON of numbers by name."""
    words = np.fromiter(numbers.values(), np.float32, len(numbers)).view(np.uint32)
    found = {name: f"{word:08x}" for name, word in zip(numbers, words.tolist(), strict=True)}
    return json.dumps(found, separators=(",", ":"))


def identify(names: Sequence[str]) -> NDArray[np.float32]:
    """Compute the identifiers (n,) of names: hashes with the exponent of a finite, normal float."""
    words = hash_names(names)
    exponent = np.clip(words >> _EXPONENT & np.uint32(255), np.uint32(1), np.uint32(254))
    return (words & np.uint32(0x807FFFFF) | exponent << _EXPONENT).view(np.float32)


def ranked(numbers: NDArray[np.float32], cover: NDArray[np.float32]) -> NDArray[np.float32]:
    """Add up the coverages of equal identifiers, and return the `RANKS` greatest (..., 2 RANKS) in order.

    Parameters
    ----------
    numbers
        (k, ...) identifiers, or (k,) different ones.
    cover
        (k, ...) coverages, 0 to 1; identifiers without coverage are ignored.
    """
    planes = list(cover.copy())
    count = len(planes)
    if numbers.ndim > 1:
        for late in range(1, count):
            for early in range(late):
                same = np.where(numbers[early] == numbers[late], planes[late], np.float32(0.0))
                planes[early] += same
                planes[late] -= same
    held = [np.broadcast_to(each, cover.shape[1:]) for each in numbers]
    layers = np.zeros((*cover.shape[1:], 2 * RANKS), np.float32)
    for rank in range(min(RANKS, count)):
        for k in range(count - 1, rank, -1):  # equal coverages keep their order
            greater = planes[k] > planes[k - 1]
            for values in (held, planes):
                before, after = values[k - 1], values[k]
                values[k - 1] = np.where(greater, after, before)
                values[k] = np.where(greater, before, after)
        layers[..., 2 * rank] = np.where(planes[rank] > 0.0, held[rank], np.float32(0.0))
        layers[..., 2 * rank + 1] = planes[rank]
    return layers


def hash_names(names: Sequence[str]) -> Words:
    """Compute MurmurHash3_32 (n,) of names, in groups of equal length."""
    texts = [name.encode() for name in names]
    lengths = np.array([len(text) for text in texts], np.int64)
    found = np.zeros(len(texts), np.uint32)
    for length in np.unique(lengths):
        chosen = np.flatnonzero(lengths == length)
        joined = b"".join(texts[k] for k in chosen)
        found[chosen] = _hash_equal(np.frombuffer(joined, np.uint8).reshape(len(chosen), length))
    return found


def _hash_equal(texts: NDArray[np.uint8]) -> Words:
    """Compute MurmurHash3_32 (n,) of texts (n, bytes)."""
    count, length = texts.shape
    padded = np.zeros((count, -(-length // 4) * 4), np.uint8)
    padded[:, :length] = texts
    hashed = np.zeros(count, np.uint32)
    for block, word in enumerate(padded.view("<u4").astype(np.uint32).T):
        hashed ^= _rotated(word * _FIRST, 15) * _SECOND
        if 4 * block + 4 <= length:
            hashed = _rotated(hashed, 13) * np.uint32(5) + _ADDED
    hashed ^= np.uint32(length)
    for shift, factor in zip((16, 13), _LAST, strict=True):
        hashed = (hashed ^ hashed >> np.uint32(shift)) * factor
    return hashed ^ hashed >> np.uint32(16)


def _rotated(words: Words, bits: int) -> Words:
    return words << np.uint32(bits) | words >> np.uint32(32 - bits)
