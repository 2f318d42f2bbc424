"""Memory of this process: how much it had at most, and how what is free goes back to the system."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
from collections.abc import Callable

_ARENAS = "MALLOC_ARENA_MAX"
_MOST = "1"
"""Arenas of a process. Left alone, glibc makes up to eight for each processor, and each keeps what is free.

Two take 0.17 GB more than one for the example's film.
"""


def few_arenas() -> dict[str, str]:
    """Variables for the environment of a process that works with many threads, which people's own go before.

    None where the C library is another than glibc, which has no such thing to bound.
    """
    return {_ARENAS: _MOST} if _glibc() and _ARENAS not in os.environ else {}


def _glibc() -> bool:
    try:
        return (os.confstr("CS_GNU_LIBC_VERSION") or "").startswith("glibc")
    except (AttributeError, ValueError, OSError):  # systems without the function, or without the name
        return False


def give_back() -> None:
    """Give what is free to the system, between one large work and another; does nothing without glibc."""
    trim = _trim()
    if trim is not None:
        trim(0)


@functools.cache
def _trim() -> Callable[[int], int] | None:
    return getattr(ctypes.CDLL(None), "malloc_trim", None) if _glibc() else None


def peak() -> int:
    """Bytes that this process had at most, 0 where the system does not say it."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as file:
        return next((1024 * int(line.split()[1]) for line in file if line.startswith("VmHWM")), 0)
    return 0
