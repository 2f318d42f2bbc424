"""Render queue of frames that several renders into one folder share by leases. Needs no Blender."""

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

_POLL_INTERVAL = 1.0  # s between two polls of other renders' leases
Frame = tuple[str, int]
"""Camera and frame number."""


@dataclass(frozen=True)
class RenderSession:
    """A render into an output folder: its store, its leases and the fingerprints of its pictures.

    Attributes
    ----------
    after
        Entries of the store up to this number do not count as finished.
    """

    store: Store
    leases: Claims
    made_with: Fingerprints
    after: int = 0

    def missing(self, wanted: list[Picture]) -> list[Picture]:
        """Pictures that are not finished."""
        return plan.missing(self.store, wanted, self.made_with, self.after)

    def free(self, wanted: list[Picture], tell: MessageCallback) -> list[Picture]:
        """Unfinished pictures without a lease; waits until there are some; none when all are finished."""
        waiting = False
        while wanted := self.missing(wanted):
            others = self.leases.of_others()
            if free := [picture for picture in wanted if _name(picture.camera, picture.frame) not in others]:
                return free
            if not waiting:
                tell(f"waiting for {count(len(wanted), 'picture')} that another render makes")
            waiting = True
            time.sleep(_POLL_INTERVAL)
        return []

    @contextmanager
    def queue(self, wanted: list[Picture]) -> Iterator[FrameQueue]:
        """Frame queue of these pictures, in their order; releases its leases at the end."""
        queue = FrameQueue(self, wanted)
        try:
            yield queue
        finally:
            queue.end()

    def wait_for_lease(self, name: str) -> None:
        """Take a lease; wait while another render holds it."""
        while not self.leases.take(name):
            self.leases.of_others()
            time.sleep(_POLL_INTERVAL)


@contextmanager
def open_session(
    out: Path, made_with: Fingerprints, owner: str | None = None, after: int = 0
) -> Iterator[RenderSession]:
    """Open a render session in an output folder; creates the store where it is missing."""
    with Store(out, create=True) as store, Claims(store.data, owner or new_owner()) as held:
        yield RenderSession(store, held, made_with, after)


class FrameQueue:
    """Queue of frames: each step leases the current frame and the next one, which can be prepared meanwhile.

    Attributes
    ----------
    camera, frame, names
        The current job: the passes `names` of a camera's frame.
    """

    def __init__(self, session: RenderSession, wanted: list[Picture]) -> None:
        self.session, self.leases = session, session.leases
        groups = itertools.groupby(wanted, key=lambda picture: (picture.camera, picture.frame))
        self.waiting = {frame: list(group) for frame, group in groups}
        self.following: tuple[Frame, list[str]] | None = None
        self.camera, self.frame = "", 0
        self.names: list[str] = []

    def step(self) -> bool:
        """Lease the next frame that is neither finished nor leased; False when there is none now."""
        self._release()
        now = self.following or self._lease_next()
        if now is None:
            return False
        (self.camera, self.frame), self.names = now
        self.following = self._lease_next()
        return True

    @property
    def ahead(self) -> list[int]:
        """The next frame, if this render holds its lease and it is of the same camera; else empty."""
        return [self.following[0][1]] if self.following and self.following[0][0] == self.camera else []

    def held(self) -> bool:
        """Whether the lease of the current frame is still ours; it expires without heartbeats."""
        return self.leases.held(_name(self.camera, self.frame))

    def end(self) -> None:
        """Release the leases of frames that were not finished."""
        self._release()
        if self.following:
            (self.camera, self.frame), self.names = self.following
            self.following = None
            self._release()

    def _lease_next(self) -> tuple[Frame, list[str]] | None:
        others = self.leases.of_others() if self.waiting else set()
        for frame in list(self.waiting):
            if _name(*frame) not in others and self.leases.take(_name(*frame)):
                if missing := self.session.missing(self.waiting.pop(frame)):
                    return frame, [picture.name for picture in missing]
                self.leases.give(_name(*frame))
        return None

    def _release(self) -> None:
        if self.camera:
            self.leases.give(_name(self.camera, self.frame))
        self.camera = ""


def _name(camera: str, frame: int) -> str:
    return f"{camera} {frame:06d}"
