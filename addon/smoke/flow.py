"""Smoke as a flow of the air, solved once per shot and kept at the moments of its frames. Needs no Blender.

It is solved from `Shot.spin_up` seconds before the first frame on a box round the fire, and a while before
it also on a finer one where cameras look (see `domains`). What it is made of are the model's own heat and the
smoke that goes with it; wind, temperature and water around are those of `atmosphere`. Nothing that it depends
on but the finer box comes from the cameras.

Moments lie in ``<cache>/<key>/moment_000001.npz``, one folder for each box, and beside them `solving.STATE`,
from which solving goes on where it was interrupted. Both are the same to the last byte however often it was.
"""

from __future__ import annotations

import contextlib
import functools
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import leases
from ..errors import writing
from ..progress import Progress, silent
from ..run import content
from ..shot import code_fingerprint
from ..shot.settings import schema
from ..shot.shot import Shot
from ..shot.smoke_scale import Scale
from . import cache, domains, snapshots
from .domains import Box
from .integrator import Live, StoppedError

_MADE_BY = [
    f"smoke/{name}.py" for name in ("atmosphere", "domains", "flow", "integrator", "snapshots", "stability")
]

_LOOK = 0.1  # s between two looks at what another process has solved
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One box, the ground in it (rows, columns), m, and the folder of its moments.

    Levels follow the ground about its mean in the outermost box, less and less up to that box's top, m.
    """

    box: Box
    ground: Array
    mean: float
    top: float
    folder: Path
    scale: Scale

    def heights(self) -> Array:
        """Of cells' middles (nz, rows, columns), m."""
        levels = np.array(self.box.levels)
        middles = 0.5 * (levels[1:] + levels[:-1])[:, None, None]
        return self.mean + middles + (self.ground - self.mean) * np.maximum(1.0 - middles / self.top, 0.0)

    def moment(self, frame: int) -> Path:
        """The file of a frame's moment."""
        return self.folder / f"moment_{frame:06d}.npz"

    def has(self, frame: int) -> bool:
        """Whether a frame's moment is kept."""
        return snapshots.whole(self.moment(frame), (len(self.box.levels) - 1, *self.box.shape))


class Flow:
    """The flow of a shot. Several threads may ask for its moments."""

    def __init__(self, shot: Shot, progress: Progress = silent) -> None:
        self.shot = shot
        self.progress = progress
        self.stop = threading.Event()
        self.elsewhere: Callable[[], bool] = lambda: False
        """Whether a process that is ours solves it."""
        self._lock = threading.Lock()
        self._live: Live | None = None

    @property
    def begin(self) -> float:
        """Model time (s) at which it begins."""
        return self.shot.frames.first - self.shot.spin_up

    @functools.cached_property
    def parts(self) -> list[Part]:
        """The box, and the finer one in it if there is one; none where nothing burns."""
        box = domains.whole(self.shot)
        if box is None:
            return []
        fine = domains.nest(self.shot, box)
        ground = _ground(self.shot, box, 2)
        scale = self.shot.scale
        mean, top = float(ground.mean()), box.levels[-1]
        found = [Part(box, ground, mean, top, self._folder([box]), scale)]
        if fine is not None:
            ground = _ground(self.shot, fine, 8)
            found.append(Part(fine, ground, mean, top, self._folder([box, fine]), scale))
        return found

    def key(self) -> list[str]:
        """What its moments are known by."""
        return [part.folder.name for part in self.parts]

    def ready(self, frame: int, progress: Progress | None = None, last: int = 0) -> None:
        """See to it that the moments of a frame are kept; solves up to there if they are not.

        Parameters
        ----------
        last
            The frame at which work will end, for `progress`; left out, this one.

        Raises
        ------
        StoppedError
            `stop` was set meanwhile.
        InputError
            The cache cannot be written.
        """
        with self._lock:
            while not self.has(frame) and self.elsewhere():
                if self.stop.wait(_LOOK):
                    raise StoppedError
            if self.has(frame):
                return
            progress = progress or self.progress
            folder = self._folders()[-1]

            waiting = functools.cache(
                lambda: progress(0, 1, "waiting for another process to solve the smoke's flow")
            )

            def wait() -> None:
                waiting()
                if self.stop.is_set():
                    raise StoppedError

            with leases.alone(folder / "state.lock", lambda: self.has(frame), wait) as mine:
                if mine and not self.has(frame):
                    if self._live is None or self._live.frame >= frame:
                        self._live = Live(self, frame)
                    self._live.solve(frame, progress, max(frame, last))

    def has(self, frame: int) -> bool:
        """Whether a frame's moments are kept, of all parts."""
        return all(part.has(frame) for part in self.parts)

    def solve(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """See to it that the moments of all these frames are kept."""
        wanted = sorted(frames)
        for frame in wanted:
            self.ready(frame, progress, wanted[-1])
        with self._lock:
            self._live = None  # half a gigabyte

    def renew(self, frame: int) -> None:
        """Solve a frame's moments anew: what is kept of them turned out broken."""
        self.elsewhere = lambda: False  # which is beyond it
        with self._lock:
            for part in self.parts:
                with writing(part.folder):
                    part.moment(frame).unlink(missing_ok=True)
        self.ready(frame)

    @contextlib.contextmanager
    def in_use(self) -> Iterator[None]:
        """Keep others from clearing the moments away meanwhile."""
        folders = self._folders()
        for folder in folders:
            cache.sweep(folder)
        with cache.in_use(*folders):
            yield

    def _folders(self) -> list[Path]:
        """The folders of all boxes, which are there now."""
        folders = [part.folder for part in self.parts]
        for folder in folders:
            with writing(folder):
                folder.mkdir(parents=True, exist_ok=True)
        return folders

    def _folder(self, of: list[Box]) -> Path:
        """Where the moments of the last of these boxes are kept."""
        shot = self.shot
        found = {
            "sources": code_fingerprint.of((), (), *_MADE_BY),
            "run": shot.inputs(("temperature", "smoke_3d")),
            "time": schema.chosen(shot.settings, {"time"}),
            "spin_up": shot.spin_up,
            "fuel_since": shot.fire.before,
            "seed": shot.settings.seed,
            "boxes": [box.plain() for box in of],
        }
        return shot.settings.cache.absolute() / content.fingerprint(found)


def _ground(shot: Shot, box: Box, smoothings: int) -> Array:
    """Height of the ground in a box's cells (rows, columns), m, without what is finer than cells."""
    x, y = box.middles()
    height = shot.bare_ground.up(np.tile(x, len(y)), np.repeat(y, len(x))).reshape(len(y), len(x))
    for _ in range(smoothings):
        for axis in (0, 1):
            edged = np.pad(height, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], "edge")
            count = height.shape[axis]
            low, here, high = (edged.take(range(k, k + count), axis) for k in range(3))
            height = 0.25 * (low + high) + 0.5 * here
    return height


__all__ = ["Flow", "Part", "StoppedError"]
