"""Frames that several renders into one folder share: each is made by one of them. Needs no Blender."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..leases import Claims, new_owner
from ..progress import MessageCallback, count
from . import plan
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store

_LOOK = 1.0  # s between two looks at what others do
Frame = tuple[str, int]
"""Of a camera."""


@dataclass(frozen=True)
class RenderSession:
    """What a render makes, and where.

    Attributes
    ----------
    after
        Only what was entered after this number of the store counts as finished.
    """

    store: Store
    claims: Claims
    made_with: Fingerprints
    after: int = 0

    def missing(self, wanted: list[Picture]) -> list[Picture]:
        """Those of the pictures that are not finished."""
        return plan.missing(self.store, wanted, self.made_with, self.after)

    def free(self, wanted: list[Picture], tell: MessageCallback) -> list[Picture]:
        """Pictures that nobody makes, as soon as there are any; none when all are finished."""
        waiting = False
        while wanted := self.missing(wanted):
            others = self.claims.of_others()
            if free := [each for each in wanted if _name(each.camera, each.frame) not in others]:
                return free
            if not waiting:
                tell(f"waiting for {count(len(wanted), 'picture')} that another render makes")
            waiting = True
            time.sleep(_LOOK)
        return []

    @contextmanager
    def line(self, wanted: list[Picture]) -> Iterator[FrameQueue]:
        """These pictures' frames in their order."""
        line = FrameQueue(self, wanted)
        try:
            yield line
        finally:
            line.end()

    def alone(self, name: str) -> bool:
        """Claim something; where another has it, wait until it is done with it."""
        while not self.claims.take(name):
            self.claims.of_others()
            time.sleep(_LOOK)
        return True


@contextmanager
def open_session(
    out: Path, made_with: Fingerprints, owner: str | None = None, after: int = 0
) -> Iterator[RenderSession]:
    """Begin to make files in a folder; the store is made where it is missing."""
    with Store(out, create=True) as store, Claims(store.data, owner or new_owner()) as claims:
        yield RenderSession(store, claims, made_with, after)


class FrameQueue:
    """Frames that stand in line: at each step one is ours, and the one after it, so that it can be prepared.

    Attributes
    ----------
    camera, frame, names
        What is to be made now: the passes `names` of a camera's frame.
    """

    def __init__(self, making: RenderSession, wanted: list[Picture]) -> None:
        self.making, self.claims = making, making.claims
        groups = itertools.groupby(wanted, key=lambda each: (each.camera, each.frame))
        self.waiting = {frame: list(group) for frame, group in groups}
        self.following: tuple[Frame, list[str]] | None = None
        self.camera, self.frame, self.names = "", 0, []

    def step(self) -> bool:
        """Go on to the next frame that nobody has made or is making; False when there is none now."""
        self._give()
        now = self.following or self._next()
        if now is None:
            return False
        (self.camera, self.frame), self.names = now
        self.following = self._next()
        return True

    @property
    def ahead(self) -> list[int]:
        """The frame after this one, if it is ours and of the same camera."""
        return [self.following[0][1]] if self.following and self.following[0][0] == self.camera else []

    def held(self) -> bool:
        """Whether the frame still is ours: who slept for long may have lost it."""
        return self.claims.held(_name(self.camera, self.frame))

    def end(self) -> None:
        """Give back what was not made."""
        self._give()
        if self.following:
            (self.camera, self.frame), self.names = self.following
            self.following = None
            self._give()

    def _next(self) -> tuple[Frame, list[str]] | None:
        others = self.claims.of_others() if self.waiting else set()
        for frame in list(self.waiting):
            if _name(*frame) not in others and self.claims.take(_name(*frame)):
                if missing := self.making.missing(self.waiting.pop(frame)):
                    return frame, [each.name for each in missing]
                self.claims.give(_name(*frame))
        return None

    def _give(self) -> None:
        if self.camera:
            self.claims.give(_name(self.camera, self.frame))
        self.camera = ""


def _name(camera: str, frame: int) -> str:
    return f"{camera} {frame:06d}"
