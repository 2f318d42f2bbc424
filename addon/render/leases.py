"""Who is making what: renders that share an output folder share the work.

What a render works on it claims in the store, and gives signs of life meanwhile. They are counted, not dated,
as clocks differ: an owner is dead when it gave none for `PATIENCE` seconds by the clock of whoever waits.
"""

from __future__ import annotations

import contextlib
import shutil
import threading
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

from ..errors import Error, writing
from .store import Store

BEAT = 3.0  # s between two signs of life
PATIENCE = 16.0  # s
_PART = ".part-"


class Claims:
    """What one render, the `owner`, holds; it gives signs of life from a thread until it is closed."""

    def __init__(self, store: Store, owner: str) -> None:
        self.store, self.owner = store, owner
        self._seen: dict[str, tuple[int, float]] = {}
        self._over = threading.Event()
        _beat(store, owner)
        sweep(store)
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()

    def __enter__(self) -> Claims:
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()
        leave(self.store, self.owner)

    def take(self, name: str) -> bool:
        """Claim something; False where another has it."""
        data = self.store.data
        with data.change():
            data.do("INSERT OR IGNORE INTO owners VALUES (?, 0)", self.owner)
            data.do("INSERT OR IGNORE INTO claims VALUES (?, ?)", name, self.owner)
        return self.held(name)

    def held(self, name: str) -> bool:
        """Whether it is ours; who slept for long may have lost it."""
        return self.store.data.one("SELECT owner FROM claims WHERE name = ?", name) == (self.owner,)

    def give(self, name: str) -> None:
        """Give it back."""
        self.store.data.do("DELETE FROM claims WHERE name = ? AND owner = ?", name, self.owner)

    def of_others(self) -> set[str]:
        """What others hold; the dead are buried before."""
        self._bury()
        rows = self.store.data.all("SELECT name FROM claims WHERE owner != ?", self.owner)
        return {name for (name,) in rows}

    @contextlib.contextmanager
    def part_folder(self) -> Iterator[Path]:
        """A folder for files in the making, inside the output folder so that they can be renamed."""
        part = self.store.out / f"{_PART}{self.owner}"
        with writing(part):
            part.mkdir(exist_ok=True)
        try:
            yield part
        finally:
            shutil.rmtree(part, ignore_errors=True)

    def _bury(self) -> None:
        now, beats = time.monotonic(), _beats(self.store)
        for owner, beat in beats.items():
            known, since = self._seen.get(owner, (None, now))
            if known != beat:
                self._seen[owner] = (beat, now)
            elif owner != self.owner and now - since > PATIENCE:
                leave(self.store, owner, beat)

    def _live(self) -> None:
        while not self._over.wait(BEAT):
            with contextlib.suppress(Error), Store(self.store.out) as store:
                _beat(store, self.owner)


def new_owner() -> str:
    """A name that no other render has."""
    return uuid.uuid4().hex[:12]


def leave(store: Store, owner: str, beat: int | None = None) -> None:
    """End an owner, unless it lived on after `beat`: what it held is free, what it left unfinished goes."""
    with store.data.change():
        if beat is not None and _beats(store).get(owner) != beat:
            return
        store.data.do("DELETE FROM claims WHERE owner = ?", owner)
        store.data.do("DELETE FROM owners WHERE owner = ?", owner)
    sweep(store)


def sweep(store: Store) -> None:
    """Remove what those have left unfinished that are no more."""
    left = list(store.out.glob(f"{_PART}*"))
    alive = _beats(store)
    for part in left:
        if part.name.removeprefix(_PART) not in alive:
            shutil.rmtree(part, ignore_errors=True)


def _beat(store: Store, owner: str) -> None:
    with store.data.change():
        store.data.do("INSERT OR IGNORE INTO owners VALUES (?, 0)", owner)
        store.data.do("UPDATE owners SET beat = beat + 1 WHERE owner = ?", owner)


def _beats(store: Store) -> dict[str, int]:
    return dict(store.data.all("SELECT owner, beat FROM owners"))
