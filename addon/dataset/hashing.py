"""Random numbers by hash: each depends on the seed, the sample, the try and the name of its value alone."""

from __future__ import annotations

import hashlib


def integer(seed: int, index: int, attempt: int, name: str) -> int:
    """Return 64 random bits (BLAKE2b of the arguments)."""
    text = f"{seed}/{index}/{attempt}/{name}".encode()
    return int.from_bytes(hashlib.blake2b(text, digest_size=8).digest(), "little")


def share(seed: int, index: int, attempt: int, name: str) -> float:
    """Return a random number from 0 to 1 (excluded), a multiple of 2^-53."""
    return (integer(seed, index, attempt, name) >> 11) * 2.0**-53
