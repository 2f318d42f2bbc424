"""Process memory: peak use, limits, and release of freed memory to the system."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import sys
from collections.abc import Callable, Iterator

_ARENAS = "MALLOC_ARENA_MAX"
_DATA = 5  # column of statm
_MOST = "1"
"""Number of malloc arenas of a process. glibc creates up to eight per processor; each retains freed memory.

Two arenas need 0.17 GB more than one for the example's film.
"""


def few_arenas() -> dict[str, str]:
    """Return environment variables that limit arenas, unless the user has set the variable.

    Empty unless the C library is glibc, the only one with this setting.
    """
    return {_ARENAS: _MOST} if _glibc() and _ARENAS not in os.environ else {}


def _glibc() -> bool:
    try:
        return (os.confstr("CS_GNU_LIBC_VERSION") or "").startswith("glibc")
    except (AttributeError, ValueError, OSError):  # systems without the function or the name
        return False


def release_freed() -> None:
    """Return freed memory to the system between large tasks; does nothing without glibc."""
    trim = _trim()
    if trim is not None:
        trim(0)


@functools.cache
def _trim() -> Callable[[int], int] | None:
    return getattr(ctypes.CDLL(None), "malloc_trim", None) if _glibc() else None


def limit(size: int) -> None:
    """Limit this process to `size` bytes of data more than it has; only Linux can."""
    _set_soft_limit(size)


@contextlib.contextmanager
def limited(size: int) -> Iterator[None]:
    """Limit this process to `size` bytes of data more than it has, within this block (see `limit`)."""
    before = _set_soft_limit(size)
    try:
        yield
    finally:
        if before is not None:
            import resource

            resource.setrlimit(resource.RLIMIT_DATA, before)


def _set_soft_limit(size: int) -> tuple[int, int] | None:
    """Lower the limit on data (mapped files do not count); return the former limits, None if unchanged."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        with open("/proc/self/statm", encoding="ascii") as file:
            size += int(file.read().split()[_DATA]) * resource.getpagesize()
        soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
        if soft == resource.RLIM_INFINITY or size < soft:
            resource.setrlimit(resource.RLIMIT_DATA, (size, hard))
            return soft, hard
    return None


def free() -> int:
    """Return the memory that the system could give to processes, bytes; 0 if it does not report it."""
    if sys.platform == "win32":
        status = _MemoryStatus(length=ctypes.sizeof(_MemoryStatus))
        ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status))
        return int(status.available)
    try:
        return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return 0


class _MemoryStatus(ctypes.Structure):
    """Windows' MEMORYSTATUSEX."""

    _fields_ = (
        ("length", ctypes.c_uint32),
        ("load", ctypes.c_uint32),
        ("total", ctypes.c_uint64),
        ("available", ctypes.c_uint64),
        ("rest", ctypes.c_uint64 * 5),
    )


class _MemoryCounters(ctypes.Structure):
    """Windows' PROCESS_MEMORY_COUNTERS."""

    _fields_ = (
        ("length", ctypes.c_uint32),
        ("faults", ctypes.c_uint32),
        ("peak", ctypes.c_size_t),
        ("rest", ctypes.c_size_t * 7),
    )


def peak() -> int:
    """Return the peak memory of this process, bytes; 0 if the system does not report it."""
    if sys.platform == "win32":
        system, counters = ctypes.windll.kernel32, _MemoryCounters()
        size, process = ctypes.sizeof(counters), ctypes.c_void_p(-1)  # this process
        return (
            int(counters.peak) if system.K32GetProcessMemoryInfo(process, ctypes.byref(counters), size) else 0
        )
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as file:
        return next((1024 * int(line.split()[1]) for line in file if line.startswith("VmHWM")), 0)
    return 0
