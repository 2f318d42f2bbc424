"""Render queue of frames, shared through leases by several renders into one folder. Needs no Blender.

Renders with equal fingerprints divide the frames. With different fingerprints they would replace each other's
pictures endlessly, so a render that meets such pictures stops.
"""

from __future__ import annotations

import functools
import itertools
import time
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .. import leases
from ..errors import input_error
from ..leases import Leases, new_owner
from ..progress import MessageCallback, count, duration, no_message
from ..run.content import fingerprint
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
    since
        Number of the store's latest entry when the render began.
    asked
        All requested pictures, including finished ones.
    finished
        Pictures that this session finished. They remain finished, whatever another render writes.
    others_leases
        Names of all leases that other renders held at any poll, including expired ones.
    """

    store: Store
    leases: Leases
    made_with: Fingerprints
    after: int = 0
    since: int = 0
    asked: Collection[Picture] = ()
    finished: set[Picture] = field(default_factory=set)
    others_leases: set[str] = field(default_factory=set)

    def missing(self, wanted: list[Picture]) -> list[Picture]:
        """Find pictures that are not finished."""
        rest = [picture for picture in wanted if picture not in self.finished]
        return plan.missing(self.store, rest, self.made_with, self.after)

    def enter(self, picture: Picture, entries: dict[str, dict[str, Any]]) -> None:
        """Enter the files of a finished picture in the store (see `Store.add`)."""
        self.store.add(self.made_with[picture.camera, picture.name], entries)
        self.finished.add(picture)

    def check_others(self) -> None:
        """Check that no other render replaces the pictures of this one by different ones.

        Raises
        ------
        InputError
            Since this render began, a requested picture was made with another fingerprint.
        """
        for camera, frame, name in (
            self.store.made_with_other_settings(self._keys, self.since) if self.asked else ()
        ):
            if (picture := Picture(camera, frame, name)) in self.asked:
                raise input_error(
                    self.store.out / picture.files()[0],
                    "another render makes this picture with other settings, or another Firetwin or Blender; "
                    "give each render its own --out, or the same scene file and versions",
                )

    def free(self, wanted: list[Picture], tell: MessageCallback) -> list[Picture]:
        """Wait for unfinished pictures without a lease, and return them; empty if all are finished."""
        waiting = False
        while True:
            self.check_others()
            wanted = self.missing(wanted)
            others = self.leased_by_others() if wanted else set()
            free = [picture for picture in wanted if _name(picture.camera, picture.frame) not in others]
            if free or not wanted:
                return free
            if not waiting:
                frames = len({(picture.camera, picture.frame) for picture in wanted})
                tell(
                    f"waiting for {count(frames, 'frame')} of another render; "
                    f"taken over {duration(leases.PATIENCE)} after its last heartbeat"
                )
            waiting = True
            time.sleep(_POLL_INTERVAL)

    def leased_by_others(self) -> set[str]:
        """Return the names of other renders' leases."""
        others = self.leases.of_others()
        self.others_leases.update(others)
        return others

    @contextmanager
    def queue(self, wanted: list[Picture], tell: MessageCallback = no_message) -> Iterator[FrameQueue]:
        """Open a frame queue of these pictures, in order; it releases its leases at the end."""
        queue = FrameQueue(self, wanted, tell)
        try:
            yield queue
        finally:
            queue.end()

    def wait_for_lease(self, name: str) -> None:
        """Take a lease; wait while another render holds it."""
        while not self.leases.take(name):
            self.leases.of_others()
            time.sleep(_POLL_INTERVAL)

    @functools.cached_property
    def _keys(self) -> list[str]:
        return [fingerprint(values) for values in self.made_with.values()]


@contextmanager
def open_session(
    out: Path,
    made_with: Fingerprints,
    owner: str | None = None,
    after: int = 0,
    since: int = 0,
    asked: Collection[Picture] = (),
) -> Iterator[RenderSession]:
    """Open a render session in an output folder; create the store if necessary."""
    with Store(out, create=True) as store, Leases(store.data, owner or new_owner()) as held:
        yield RenderSession(store, held, made_with, after, since, frozenset(asked))


class FrameQueue:
    """Queue of frames: each step leases the current frame, and the next one for its preparation.

    Attributes
    ----------
    camera, frame, names
        The current job: the passes `names` of a camera's frame.
    total
        Number of frames.
    """

    def __init__(self, session: RenderSession, wanted: list[Picture], tell: MessageCallback) -> None:
        self.session, self.leases, self.tell = session, session.leases, tell
        groups = itertools.groupby(wanted, key=lambda picture: (picture.camera, picture.frame))
        self.waiting = {frame: list(group) for frame, group in groups}
        self.total = len(self.waiting)
        self.following: tuple[Frame, list[str]] | None = None
        self.camera, self.frame = "", 0
        self.names: list[str] = []

    def step(self) -> bool:
        """Lease the next frame that is neither finished nor leased; False if there is none at present.

        Raises
        ------
        InputError
            Another render writes these pictures with other settings (see `RenderSession.check_others`).
        """
        self._release()
        self.session.check_others()
        now = self.following or self._lease_next()
        if now is None:
            return False
        (self.camera, self.frame), self.names = now
        self.following = self._lease_next()
        return True

    @property
    def done(self) -> int:
        """Number of finished frames, including frames finished by other renders."""
        return self.total - len(self.waiting) - bool(self.camera) - bool(self.following)

    @property
    def ahead(self) -> list[int]:
        """The next frame, if it has the same camera and this render holds its lease; else empty."""
        return [self.following[0][1]] if self.following and self.following[0][0] == self.camera else []

    def holds_lease(self) -> bool:
        """Return whether this render still holds the current frame's lease; it expires without heartbeats."""
        return self.leases.is_held(_name(self.camera, self.frame))

    def end(self) -> None:
        """Release the leases of frames that were not finished."""
        self._release()
        if self.following:
            (self.camera, self.frame), self.names = self.following
            self.following = None
            self._release()

    def _lease_next(self) -> tuple[Frame, list[str]] | None:
        others = self.session.leased_by_others() if self.waiting else set()
        for frame in list(self.waiting):
            if _name(*frame) not in others and self.leases.take(_name(*frame)):
                if missing := self.session.missing(self.waiting.pop(frame)):
                    if _name(*frame) in self.session.others_leases:
                        self.tell(
                            f"taking over {frame[0]} frame {frame[1]}, left unfinished by another render"
                        )
                    return frame, [picture.name for picture in missing]
                self.leases.release(_name(*frame))
        return None

    def _release(self) -> None:
        if self.camera:
            self.leases.release(_name(self.camera, self.frame))
        self.camera = ""


def _name(camera: str, frame: int) -> str:
    return f"{camera} {frame:06d}"
