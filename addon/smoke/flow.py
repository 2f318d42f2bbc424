"""Smoke flow: plume dynamics solved once per shot and stored as snapshots at its frames. Needs no Blender.

Solving begins `Shot.spin_up` seconds before the first frame, in a domain around the fire. Shortly before the
first frame a finer, nested domain is added where cameras look (see `domains`). The model's heat and its smoke
drive the flow. `atmosphere` gives ambient wind, temperature and humidity. Only the nested domain depends on
the cameras.

Snapshots are ``<cache>/<key>/moment_000001.npz``, one folder for each domain. The same folder holds the
checkpoint `integrator.STATE`, from which an interrupted solution resumes. Results after a resume are
identical to the byte.
"""

from __future__ import annotations

import contextlib
import functools
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

from .. import leases
from ..errors import writing
from ..progress import Progress, silent
from ..run import content
from ..shot import schema
from ..shot.settings import code_fingerprint
from ..shot.shot import Shot
from . import cache, domains
from .domains import Box, Domain
from .integrator import Integrator, IntegratorStoppedError

_MADE_BY = [
    f"smoke/{name}.py" for name in ("atmosphere", "coarse", "domains", "flow", "integrator", "snapshots")
]

_LOOK = 0.1  # s between checks of another process's progress


class Flow:
    """Smoke flow of a shot. Several threads may request its snapshots."""

    lead: ClassVar[float] = domains.LEAD
    """Spin-up of the nest before the first frame, s, on cells of `smoke_scale.REFERENCE`."""

    def __init__(self, shot: Shot, progress: Progress = silent) -> None:
        self.shot = shot
        self.progress = progress
        self.stop = threading.Event()
        self.elsewhere: Callable[[], bool] = lambda: False
        """True while another Firetwin process is solving the flow."""
        self._lock = threading.Lock()
        self._integrator: Integrator | None = None

    @property
    def begin(self) -> float:
        """Model time at which the solution begins, s."""
        return self.shot.frames.first - self.shot.spin_up

    @functools.cached_property
    def boxes(self) -> list[Box]:
        """Boxes of the domain around the fire, and of the nest if there is one; none without fire."""
        box = domains.outer_box(self.shot)
        if box is None:
            return []
        fine = domains.nest_box(self.shot, box)
        return [box] if fine is None else [box, fine]

    @functools.cached_property
    def domains(self) -> list[Domain]:
        """The domain around the fire, and the nested domain if there is one; empty without fire."""
        return [
            replace(each, folder=self._folder(self.boxes[: number + 1]))
            for number, each in enumerate(domains.on_ground(self.shot, self.boxes))
        ]

    def key(self) -> list[str]:
        """Folder names of its snapshots."""
        return [domain.folder.name for domain in self.domains]

    def ready(self, frame: int, progress: Progress | None = None, last: int = 0) -> None:
        """Solve up to a frame unless its snapshots exist.

        Parameters
        ----------
        last
            Final frame of the work, for `progress`; by default this one.

        Raises
        ------
        StoppedError
            `stop` was set.
        InputError
            The cache cannot be written.
        """
        with self._lock:
            while not self.has(frame) and self.elsewhere():
                if self.stop.wait(_LOOK):
                    raise IntegratorStoppedError
            if self.has(frame):
                return
            progress = progress or self.progress
            folder = self._make_folders()[-1]

            waiting = functools.cache(
                lambda: progress(0, 1, "waiting for another process to solve the smoke's flow")
            )

            def wait() -> None:
                waiting()
                if self.stop.is_set():
                    raise IntegratorStoppedError

            with leases.lock(folder / "state.lock", lambda: self.has(frame), wait) as mine:
                if mine and not self.has(frame):
                    if self._integrator is None or self._integrator.frame >= frame:
                        self._integrator = Integrator(self.shot, self.domains, self.stop, frame, self.lead)
                    self._integrator.solve(frame, progress, max(frame, last))

    def has(self, frame: int) -> bool:
        """Return whether a frame's snapshots exist in all domains."""
        return all(domain.has(frame) for domain in self.domains)

    def solve(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """Solve up to the last of these frames unless their snapshots exist."""
        wanted = sorted(frames)
        for frame in wanted:
            self.ready(frame, progress, wanted[-1])
        with self._lock:
            self._integrator = None  # frees half a gigabyte

    def renew(self, frame: int) -> None:
        """Solve a frame's snapshots again because a file is broken."""
        self.elsewhere = lambda: False  # the other process has passed this frame
        with self._lock:
            for domain in self.domains:
                with writing(domain.folder):
                    domain.snapshot_path(frame).unlink(missing_ok=True)
        self.ready(frame)

    @contextlib.contextmanager
    def in_use(self) -> Iterator[None]:
        """Protect the snapshots from eviction while in use."""
        folders = self._make_folders()
        for folder in folders:
            cache.remove_unfinished(folder)
        with cache.in_use(*folders):
            yield

    def _make_folders(self) -> list[Path]:
        """Create the folders of all domains."""
        folders = [domain.folder for domain in self.domains]
        for folder in folders:
            with writing(folder):
                folder.mkdir(parents=True, exist_ok=True)
        return folders

    def _folder(self, boxes: list[Box]) -> Path:
        """Return the snapshot folder of the innermost of these boxes, named by a hash of all inputs."""
        shot = self.shot
        inputs = {
            "sources": code_fingerprint.hashes((), (), *_MADE_BY),
            "run": shot.input_hashes(("temperature", "smoke_3d")),
            "time": schema.select(shot.settings, {"time"}),
            "spin_up": shot.spin_up,
            "fuel_since": shot.fire.before,
            "seed": shot.settings.seed,
            "boxes": [box.plain() for box in boxes],
        }
        return shot.settings.cache.absolute() / content.fingerprint(inputs)
