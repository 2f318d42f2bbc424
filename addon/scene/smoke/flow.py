"""Smoke as a flow of the air, solved once per shot and kept at the moments of its frames. Needs no Blender.

It is solved from `smoke.spin_up` seconds before the first frame on a box round the fire, and from
`boxes.LEAD` before it also on a finer one where cameras look. What it is made of are the model's own heat and
the smoke that goes with it; wind, temperature and water around are those of `air`. Nothing that it depends on
but the finer box comes from the cameras.

Moments lie in ``<cache>/<key>/moment_000001.npz``, one folder for each box, and beside them `STATE`, from
which solving goes on where it was interrupted. Both are the same to the last byte however often it was.
"""

from __future__ import annotations

import functools
import math
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray

from ... import files
from ...errors import writing
from ...progress import Progress, silent
from ...run import content
from ...shot import burning, schema, sources
from ...shot.heat import Heat
from ...shot.shot import Shot
from . import air, boxes, cache, moments
from .boxes import Box

STATE = "state.npz"
_MADE_BY = [f"scene/smoke/{name}.py" for name in ("air", "boxes", "flow", "moments", "stability")]
WORK = "the smoke's flow"
CONVECTED = 0.7  # of the heat rises with the air; the rest is radiated (Freeborn et al. 2008)
SMOKE = 0.02 / burning.HEAT  # kg/J: a fiftieth of the burned fuel
_BURN = 30.0  # s between two looks at what burns
_RAMP = 300.0  # s in which the fire grows to its strength: a sudden one would bang
_GUSTS = 0.6  # standard deviation of the logarithm of what single flames give off
_FINE_GUSTS = 0.9, 180.0, 45.0  # the same in the nest, alike within m and s: single runs of flames
_DRIFT = 240.0  # s before the first frame from which detail is carried along; twice what it lasts
_SAVE = 60.0  # s of work that an interruption may cost
_LONGEST_STEP = 1.2  # times `boxes.STEP`, where frames are that far apart

Array = NDArray[np.float64]


class StoppedError(Exception):
    """Somebody asked for the end of solving."""


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

    def heights(self) -> Array:
        """Of cells' middles (nz, rows, columns), m."""
        levels = np.array(self.box.levels)
        middles = 0.5 * (levels[1:] + levels[:-1])[:, None, None]
        return self.mean + middles + (self.ground - self.mean) * np.maximum(1.0 - middles / self.top, 0.0)

    def moment(self, frame: int) -> Path:
        """The file of a frame's moment."""
        return self.folder / f"moment_{frame:06d}.npz"


class Flow:
    """The flow of a shot. Several threads may ask for its moments."""

    def __init__(self, shot: Shot, progress: Progress = silent) -> None:
        self.shot = shot
        self.progress = progress
        self.stop = threading.Event()
        self._lock = threading.Lock()
        self._live: _Live | None = None

    @functools.cached_property
    def heat(self) -> Heat:
        """What burns, from the flow's beginning to the last frame."""
        return Heat(self.shot.run, self.begin, self.shot.frames.last)

    @property
    def begin(self) -> float:
        """Model time (s) at which it begins."""
        return self.shot.frames.first - self.shot.settings.smoke.spin_up

    @functools.cached_property
    def parts(self) -> list[Part]:
        """The box, and the finer one in it if there is one; none where nothing burns."""
        box = boxes.whole(self.shot, self.heat)
        if box is None:
            return []
        fine = boxes.nest(self.shot, self.heat, box)
        ground = _ground(self.shot, box, 2)
        mean, top = float(ground.mean()), box.levels[-1]
        found = [Part(box, ground, mean, top, self._folder([box]))]
        if fine is not None:
            ground = _ground(self.shot, fine, 8)
            found.append(Part(fine, ground, mean, top, self._folder([box, fine])))
        return found

    def key(self) -> list[str]:
        """What its moments are known by."""
        return [part.folder.name for part in self.parts]

    def ready(self, frame: int, progress: Progress | None = None) -> None:
        """See to it that the moments of a frame are kept; solves up to there if they are not.

        Raises
        ------
        StoppedError
            `stop` was set meanwhile.
        InputError
            The cache cannot be written.
        """
        with self._lock:
            if all(part.moment(frame).exists() for part in self.parts):
                return
            if self._live is None or self._live.frame >= frame:
                self._live = _Live(self)
            self._live.solve(frame, progress or self.progress)

    def solve(self, frames: Iterable[int], progress: Progress = silent) -> None:
        """See to it that the moments of all these frames are kept."""
        for frame in sorted(frames):
            self.ready(frame, progress)
        with self._lock:
            self._live = None  # half a gigabyte

    def _folder(self, of: list[Box]) -> Path:
        """Where the moments of the last of these boxes are kept."""
        shot = self.shot
        found = {
            "sources": sources.of((), (), *_MADE_BY),
            "run": content.inputs(shot.run, shot.settings.cache, ("temperature", "smoke_3d")),
            "time": schema.chosen(shot.settings, {"time"}),
            "spin_up": shot.settings.smoke.spin_up,
            "seed": shot.settings.seed,
            "boxes": [box.plain() for box in of],
        }
        return shot.settings.cache.absolute() / content.fingerprint(found)


class _Live:
    """A flow being solved: solvers, their drift, and how far they are."""

    def __init__(self, whole: Flow) -> None:
        self.whole = whole
        shot = whole.shot
        self.step, self.frame = 0, 0
        self.steps, self.frame_of = _schedule(whole)
        self.saved = time.monotonic()
        self.slot: int | None = None
        self.winds = _winds(shot, whole.begin)
        self.solvers = [self._outer(whole.parts[0])]
        self.drifts: list[flow.Drift] = []
        with writing(whole.parts[-1].folder):
            for part in whole.parts:
                part.folder.mkdir(parents=True, exist_ok=True)
        self._resume()
        self._widen()

    @property
    def now(self) -> float:
        """Model time, s."""
        return self.whole.begin + self.solvers[0].time

    def solve(self, frame: int, progress: Progress) -> None:
        """Go on to a frame and keep what is passed."""
        total = next(step for step, each in self.frame_of.items() if each == frame)
        with cache.in_use(self.whole.parts[-1].folder):
            self._keep()
            while self.step < total:
                progress(self.step, total, WORK)
                if self.whole.stop.is_set():
                    raise StoppedError
                self._advance(self.steps[self.step])
                self.step += 1
                self._widen()
                self._keep()
                if time.monotonic() - self.saved > _SAVE:
                    self._save()
            progress(total, total, WORK)
            if self.step == len(self.steps):
                (self.whole.parts[-1].folder / STATE).unlink(missing_ok=True)

    def _advance(self, dt: float) -> None:
        self._burn()
        for number, solver in enumerate(self.solvers):
            count = 1 if number == 0 else max(1, round(dt * boxes.FINER / boxes.STEP))
            solver.step(dt / count, count)
        for drift in self.drifts:
            drift.advance()

    def _widen(self) -> None:
        """Begin the nest, and the detail's drift, once it is time."""
        left = self.whole.shot.frames.first - self.now
        if len(self.whole.parts) > len(self.solvers) and left <= boxes.LEAD + 1e-6:
            self.solvers.append(self._inner(self.whole.parts[1]))
            self.slot = None
        if left <= _DRIFT + 1e-6:
            self.drifts += [flow.Drift(solver) for solver in self.solvers[len(self.drifts) :]]

    def _burn(self) -> None:
        """Have what burns now give off heat and smoke, and the wind blow."""
        slot = math.floor(self.solvers[0].time / _BURN + 1e-6)
        if slot == self.slot:
            return
        self.slot = slot
        time = self.whole.begin + slot * _BURN
        self.solvers[0].set_wind(air.wind(self.winds[min(slot, len(self.winds) - 1)]))
        found = self.whole.heat.sources(time)
        power = found.power * min(1.0, (slot + 1) * _BURN / _RAMP)
        for solver in self.solvers:
            solver.set_sources(found.position[:, :2], CONVECTED * power, SMOKE * power)

    def _keep(self) -> None:
        frame = self.frame_of.get(self.step)
        if frame is None:
            return
        self.frame = frame
        for part, solver, drift in zip(self.whole.parts, self.solvers, self.drifts, strict=True):
            if not part.moment(frame).exists():
                moments.keep(part.moment(frame), solver, drift)

    def _save(self) -> None:
        kept: dict[str, NDArray[Any]] = {"step": np.array([self.step])}
        for number, solver in enumerate(self.solvers):
            kept |= {f"{number}_{name}": values for name, values in solver.state().items()}
        for number, drift in enumerate(self.drifts):
            kept |= {f"{number}_drift": drift.values(), f"{number}_drift_time": np.array([drift.time])}
        path = self.whole.parts[-1].folder / STATE
        files.write(path, lambda part: moments.write(part, kept), path.with_suffix(".npz.tmp"))
        self.saved = time.monotonic()

    def _resume(self) -> None:
        """Go on from what was saved, if that is a moment before what is asked for."""
        path = self.whole.parts[-1].folder / STATE
        try:
            with np.load(path) as file:
                kept = {name: file[name] for name in file.files}
        except (OSError, ValueError, KeyError):
            return
        self.step = int(kept["step"][0])
        if "1_u" in kept:
            self.solvers.append(self._inner(self.whole.parts[1]))
        for number, solver in enumerate(self.solvers):
            mine = {name[2:]: values for name, values in kept.items() if name[:2] == f"{number}_"}
            solver.restore(mine)
            if "drift" in mine:
                self.drifts.append(flow.Drift(solver))
                self.drifts[-1].restore(float(mine["drift_time"][0]), mine["drift"])
        self.frame = max((f for step, f in self.frame_of.items() if step <= self.step), default=0)

    def _outer(self, part: Part) -> flow.Solver:
        shot, box = self.whole.shot, part.box
        around = air.air(shot.sun(shot.frames.middle)[1], part.mean)
        return flow.Solver(
            box.levels,
            box.shape,
            box.spacing,
            around.height,
            around.potential_temperature,
            air.wind(self.winds[0]),
            water=around.water,
            pressure=around.pressure,
            corner=box.corner,
            ground=part.ground,
            gust_strength=_GUSTS,
            seed=shot.settings.seed,
        )

    def _inner(self, part: Part) -> flow.Solver:
        box = part.box
        return self.solvers[0].nest(
            box.levels,
            box.shape,
            box.spacing,
            box.corner,
            ground=part.ground,
            gust_strength=_FINE_GUSTS[0],
            gust_size=_FINE_GUSTS[1],
            gust_time=_FINE_GUSTS[2],
            seed=self.whole.shot.settings.seed,
        )


def _schedule(whole: Flow) -> tuple[list[float], dict[int, int]]:
    """Every step's length, s, and which frame is reached after so many steps."""
    frames = whole.shot.frames
    lead = math.ceil(whole.shot.settings.smoke.spin_up / boxes.STEP)
    steps = [whole.shot.settings.smoke.spin_up / lead] * lead if lead else []
    frame_of = {lead: 1}
    between = max(1, math.ceil(frames.step / (_LONGEST_STEP * boxes.STEP) - 1e-9))
    for frame in range(2, frames.count + 1):
        steps += [frames.step / between] * between
        frame_of[len(steps)] = frame
    return steps, frame_of


def _winds(shot: Shot, begin: float) -> list[tuple[float, float]]:
    """The run's wind near the ground at every look at what burns."""
    count = max(1, math.ceil((shot.frames.last - begin) / _BURN) + 1)
    found = burning.wind_at(shot.run, begin + _BURN * np.arange(count))
    return [(float(east), float(north)) for east, north in np.nan_to_num(found)]


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
