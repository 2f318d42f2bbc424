"""Memory of the worker: few heaps, return of free memory, and the peak as the system counts it."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import child_work
import pytest
from firetwin import memory
from firetwin.jobs import worker
from firetwin.smoke import bake

GLIBC = pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the C library is not glibc")
HOLES = """
import numpy
from firetwin import memory

def rss():
    return int(open("/proc/self/statm").read().split()[1]) * 4096

held = [numpy.ones(12_000) for _ in range(2000)]  # 96 kB each, which glibc takes from its heap
held = held[1::2]
full = rss()
memory.release_freed()
print(full - rss())
"""
PEAK = """
import numpy
from firetwin import memory

before = memory.peak()
much = numpy.ones(20_000_000)  # 160 MB
there = memory.peak()
del much
print(there - before, memory.peak() - there)
"""


def _numbers(code):
    """Return the output of a separate process."""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return map(int, result.stdout.split())


@GLIBC
def test_what_is_free_between_what_is_used_goes_back():
    """96 MB lie in holes of a heap of 192 MB; left alone, glibc keeps all of it."""
    (gone,) = _numbers(HOLES)
    assert gone > 60e6


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the system does not say it")
def test_the_peak_stays_when_memory_is_free_again():
    grown, shrunk = _numbers(PEAK)
    assert 150e6 < grown < 250e6
    assert abs(shrunk) < 5e6, "which the system counts roughly"


def test_free_memory_is_a_part_of_all():
    size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") if os.name == "posix" else 1e13
    assert 1e7 < memory.free() < size


def test_a_bake_with_little_memory_does_one_frame_at_a_time(monkeypatch):
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    assert bake._parallel_frames(8) > 1
    monkeypatch.setattr(memory, "free", lambda: 0)
    assert bake._parallel_frames(8) == 1


def test_other_systems_have_nothing_to_bound_and_no_way_to_give_back(monkeypatch):
    def confstr(name):
        raise ValueError("unrecognized configuration name")

    monkeypatch.setattr(os, "confstr", confstr, raising=False)
    memory._trim.cache_clear()
    assert memory.few_arenas() == {}
    memory.release_freed()
    monkeypatch.delattr(os, "confstr")
    assert memory.few_arenas() == {}
    memory._trim.cache_clear()


@GLIBC
def test_the_worker_has_few_arenas_unless_somebody_says_otherwise(monkeypatch):
    child_work.importable(monkeypatch)
    monkeypatch.delenv("MALLOC_ARENA_MAX", raising=False)
    assert worker.run(child_work.arenas, blender=False) == "1"
    monkeypatch.setenv("MALLOC_ARENA_MAX", "5")
    assert worker._environment(eevee=False)["MALLOC_ARENA_MAX"] == "5"
