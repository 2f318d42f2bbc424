"""Decoding of tiles in the process of a test, which takes a tenth of the time."""

from types import SimpleNamespace

import pytest
from firetwin.jobs import worker
from firetwin.jobs.tiles import decode

__all__ = ["decode_here", "decoded_here"]


def decode_here(patch):
    """Decode in this process, for as long as the patch lasts."""

    def run(work, progress, tell, **_):
        work(progress=progress, tell=tell)

    patch.setattr(decode, "worker", SimpleNamespace(run=run, EndedError=worker.EndedError))


@pytest.fixture
def decoded_here(monkeypatch):
    """Decode in this process."""
    decode_here(monkeypatch)
