"""Flow integrator: time stepping of a smoke flow, with checkpoints to resume from. Needs no Blender."""

from __future__ import annotations

import math
import time
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray

from .. import files
from ..errors import Error, InputError, input_error, writing
from ..progress import Progress
from ..run import burning, sun, times
from ..shot.fire.smoke_scale import FINER, Scale
from ..shot.shot import Shot
from . import atmosphere, cache, domains, snapshots
from .domains import Domain

STATE = "state.npz"
WORK = "the smoke's flow"
CONVECTED = 0.7  # convective fraction of the heat; the rest is radiated (Freeborn et al. 2008)
_SOURCE_STEP, _PARTS = 30.0, 5  # s between updates of the heat sources, which are means of so many times
_RAMP = 300.0  # s in which the fire ramps up; a sudden start would send out a pressure wave
# Gusts of the sources: standard deviation of the logarithm, correlation length (m) and time (s).
_GUSTS = 0.6, 400.0, 90.0
_FINE_GUSTS = 0.9, 180.0, 45.0  # as above, in the nest, for individual runs of flame
_SIDES = (8.0, 40.0), (10.0, 8.0)  # sponge layer of domain and nest: cells and relaxation time (s)
_TOP = 60.0  # s, relaxation time of the Rayleigh damping at the top
_DRAG = 300.0  # s, relaxation time of surface drag on wind in the lowest level, per its depth
_DEPTH = 90.0  # m, injection depth of heat and smoke
_DRIFT = 240.0  # s before the first frame from which detail is advected; twice its lifetime
_SAVE = 30.0  # s between checkpoints
_LONGEST_STEP = 1.2  # times the scale's step, upper limit of the step between frames


class IntegratorStoppedError(Exception):
    """Solving was stopped on request."""


class Integrator:
    """Solves the flow of a shot step by step.

    Parameters
    ----------
    nested
        The domain around the fire, and the nested domain if there is one.
    stop
        Event that stops solving.
    frame
        Checkpoints later than this frame are ignored.
    lead
        Spin-up of the nested domain before the first frame, s, on cells of `smoke_scale.REFERENCE`.
    """

    def __init__(
        self, shot: Shot, nested: list[Domain], stop: Event, frame: int, lead: float = domains.LEAD
    ) -> None:
        self.shot, self.domains, self.stop = shot, nested, stop
        self.begin = shot.frames.first - shot.spin_up
        self.scale = shot.scale
        self.lead, self.slots = shot.scale.time(lead), shot.scale.time(_SOURCE_STEP)
        self.step, self.frame = 0, 0
        self.steps, self.frame_of = _schedule(shot)
        self.ends = np.concatenate([[0.0], np.cumsum(self.steps)])  # s since the beginning
        self.slot_of = np.floor(self.ends[:-1] / self.slots + 1e-6).astype(int)
        self.work = self._work()
        self.saved, self.saved_step = time.monotonic(), 0
        self.slot: int | None = None
        self.winds = _winds(shot, self.begin)
        self.solvers = [self._outer(nested[0])]
        self.drifts: list[flow.Drift] = []
        self._resume(self._step_of(frame))
        self._start_nest()

    @property
    def now(self) -> float:
        """Model time, s."""
        return self.begin + self.solvers[0].time

    def solve(self, frame: int, progress: Progress, last: int) -> None:
        """Solve up to a frame and save its snapshots. `progress` counts the work up to the frame `last`."""
        end, total = self._step_of(frame), int(self.work[self._step_of(last)])
        with cache.in_use(self.domains[-1].folder):
            self._save_snapshots()
            while self.step < end:
                progress(int(self.work[self.step]), total, WORK)
                if self.stop.is_set():
                    raise IntegratorStoppedError
                self.advance(self.steps[self.step])
                self.step += 1
                self._start_nest()
                self._save_snapshots()
                if time.monotonic() - self.saved > _SAVE:
                    self._save()
            progress(int(self.work[end]), total, WORK)
            if self.step == len(self.steps):
                with writing(self.domains[-1].folder / STATE):
                    (self.domains[-1].folder / STATE).unlink(missing_ok=True)

    def _step_of(self, frame: int) -> int:
        return next(step for step, reached in self.frame_of.items() if reached == frame)

    def _work(self) -> NDArray[np.int64]:
        """Return the cumulative work of the steps, in steps of the outer domain."""
        left = self.shot.spin_up - np.concatenate([[0.0], np.cumsum(self.steps)[:-1]])
        cost = np.ones(len(self.steps))
        if len(self.domains) > 1:
            cells = [math.prod(domain.box.shape) * len(domain.box.levels) for domain in self.domains]
            each = [_count(dt, self.scale) * cells[1] / cells[0] for dt in self.steps]
            cost += np.where(left <= self.lead + 1e-6, each, 0.0)
        return np.round(np.concatenate([[0.0], np.cumsum(cost)])).astype(np.int64)

    def find_step(self) -> None:
        """Set the scheduled step, whose sources are used, by the present time: for steps of other lengths."""
        reached = np.searchsorted(self.ends, self.solvers[0].time + 1e-6, "right")
        self.step = min(int(reached), len(self.steps)) - 1

    def advance(self, dt: float) -> None:
        """Advance all domains by `dt` s.

        Raises
        ------
        InputError
            The air is too fast for the cells, or no longer finite.
        """
        self._update_sources()
        for number, solver in enumerate(self.solvers):
            count = 1 if number == 0 else _count(dt, self.scale)
            try:
                solver.step(dt / count, count)
            except Error as error:
                raise self._fault(self.domains[number], "infinity" in str(error)) from None
        for drift in self.drifts:
            drift.advance()

    def _fault(self, domain: Domain, diverged: bool) -> InputError:
        """Explain that the air of a domain is too fast for its cells, which heat does in calm air, too.

        Parameters
        ----------
        diverged
            Its values are no longer finite.
        """
        run = self.shot.run
        power = float(self.shot.fire.sources(self.now).power.sum())
        wind = float(np.hypot(*self.winds[min(self.slot or 0, len(self.winds) - 1)]))
        moment, cell = times.iso(times.utc(run, self.now)), domain.box.spacing
        reason = (
            f"the smoke's flow has no solution at {moment}: with {power / 1e9:,.3g} GW of fire in a wind of "
            f"{wind:.3g} m/s, the air {'becomes infinitely' if diverged else 'is too'} fast for cells of "
            f"{cell:,.0f} m; check heat_flux at this time, "
            'or set smoke.method = "preview" (wider cells) or smoke.enabled = false'
        )
        return input_error(Path(run.path), reason)

    def _start_nest(self) -> None:
        """Start the nest and the detail's drift when they are due."""
        left = self.shot.frames.first - self.now
        if len(self.domains) > len(self.solvers) and left <= self.lead + 1e-6:
            self.start_nest(self.domains[1])
        if left <= self.scale.time(_DRIFT) + 1e-6:
            self.drifts += [self._drift(solver) for solver in self.solvers[len(self.drifts) :]]

    def start_nest(self, part: Domain) -> None:
        """Start a nested domain from the present state of the outer one."""
        self.solvers.append(self._inner(part))
        self.slot = None

    def _update_sources(self) -> None:
        """Update heat and smoke sources and the ambient wind.

        The sources of a slot are their mean over its steps. Heat ramps up, smoke does not: all emission since
        the beginning is in the air or has left, and sums to `Fire.smoke_made`. Each domain gets only the
        sources inside, because gusts conserve the sum of a domain's sources.
        """
        slot = self.slot_of[self.step]
        if slot == self.slot:
            return
        self.solvers[0].set_wind(atmosphere.wind(self.winds[min(slot, len(self.winds) - 1)]))
        steps = np.flatnonzero(self.slot_of == slot)
        begin, end = self.ends[steps[0]], self.ends[steps[-1] + 1]
        parts = [
            self.shot.fire.sources(float(self.begin + begin + (end - begin) * share))
            for share in (np.arange(_PARTS) + 0.5) / _PARTS
        ]
        position = np.concatenate([part.position[:, :2] for part in parts])
        heat, smoke = (
            np.concatenate([getattr(part, name) for part in parts]) / _PARTS for name in ("power", "smoke")
        )
        emitted = self.shot.fire.smoke_made(float(self.begin + begin), float(self.begin + end))
        if (mean := float(smoke.sum())) > 0.0:
            smoke *= emitted / ((end - begin) * mean)
        ramp = min(1.0, (slot + 1) * _SOURCE_STEP / _RAMP)
        for domain, solver in zip(self.domains, self.solvers, strict=False):
            inside = domain.box.contains(position)
            solver.set_sources(position[inside], CONVECTED * ramp * heat[inside], smoke[inside])
        self.slot = slot

    def _save_snapshots(self) -> None:
        frame = self.frame_of.get(self.step)
        if frame is None:
            return
        self.frame = frame
        for domain, solver, drift in zip(self.domains, self.solvers, self.drifts, strict=True):
            if not domain.has(frame):
                snapshots.save(domain.snapshot_path(frame), solver, drift)

    def _save(self) -> None:
        self.saved = time.monotonic()
        if self.step <= self.saved_step:  # the saved checkpoint is later
            return
        arrays: dict[str, NDArray[Any]] = {"step": np.array([self.step])}
        for number, solver in enumerate(self.solvers):
            arrays |= {f"{number}_{name}": values for name, values in solver.state().items()}
        for number, drift in enumerate(self.drifts):
            arrays |= {f"{number}_drift": drift.values(), f"{number}_drift_time": np.array([drift.time])}
        path = self.domains[-1].folder / STATE
        files.write(path, lambda part: snapshots.write(part, arrays))
        self.saved, self.saved_step = time.monotonic(), self.step

    def _resume(self, end: int) -> None:
        """Resume from a checkpoint if it is complete and not later than requested."""
        path = self.domains[-1].folder / STATE
        try:
            arrays = snapshots.read(path)
            step = int(arrays["step"][0])
            if not 0 <= step <= len(self.steps):
                raise ValueError
            if step > end:
                self.saved_step = step
                return
            self._restore(arrays)
        except FileNotFoundError:
            return
        except (snapshots.BrokenError, LookupError, TypeError, ValueError):
            with writing(path):
                path.unlink(missing_ok=True)
            self.solvers, self.drifts = [self._outer(self.domains[0])], []
            return
        self.step = self.saved_step = step
        self.frame = max((f for step, f in self.frame_of.items() if step <= self.step), default=0)

    def _restore(self, arrays: dict[str, NDArray[Any]]) -> None:
        if "1_u" in arrays:
            self.solvers.append(self._inner(self.domains[1]))
        for number, solver in enumerate(self.solvers):
            mine = {name[2:]: values for name, values in arrays.items() if name[:2] == f"{number}_"}
            solver.restore(mine)
            if "drift" in mine:
                self.drifts.append(self._drift(solver))
                self.drifts[-1].restore(float(mine["drift_time"][0]), mine["drift"])

    def _drift(self, solver: flow.Solver) -> flow.Drift:
        return flow.Drift(solver, self.scale.time(0.5 * _DRIFT))

    def _outer(self, part: Domain) -> flow.Solver:
        shot, box = self.shot, part.box
        around = atmosphere.air(sun.position(shot.run, shot.frames.middle)[1], part.mean)
        wind = atmosphere.wind(self.winds[0])
        profile = flow.Profile(
            around.height, around.potential_temperature, wind, around.water, around.pressure
        )
        domain = flow.Domain(box.levels, box.shape, box.spacing, box.corner, part.ground)
        return flow.Solver(domain, profile, self._settings(*_SIDES[0], _GUSTS))

    def _inner(self, part: Domain) -> flow.Solver:
        box = part.box
        domain = flow.Domain(box.levels, box.shape, box.spacing, box.corner, part.ground)
        return self.solvers[0].nest(domain, self._settings(*_SIDES[1], _FINE_GUSTS))

    def _settings(
        self, sponge_width: float, sponge_time: float, gusts: tuple[float, float, float]
    ) -> flow.SolverSettings:
        """Make solver settings at the shot's scale; `gusts` are strength, size (m) and time (s)."""
        strength, size, time = gusts
        return flow.SolverSettings(
            sponge_width=sponge_width,
            sponge_time=self.scale.time(sponge_time),
            damping_time=self.scale.time(_TOP),
            drag_time=self.scale.length(_DRAG),
            source_depth=self.scale.length(_DEPTH),
            gust_strength=strength,
            gust_size=self.scale.length(size),
            gust_time=self.scale.time(time),
            seed=self.shot.settings.seed,
        )


def _count(dt: float, scale: Scale) -> int:
    """Return the number of nest steps in a step of the outer domain."""
    return max(1, round(dt * FINER / scale.step))


def _schedule(shot: Shot) -> tuple[list[float], dict[int, int]]:
    """Compute the lengths of all steps, s, and the frames reached after a number of steps."""
    frames, step = shot.frames, shot.scale.step
    lead = math.ceil(shot.spin_up / step)
    steps = [shot.spin_up / lead] * lead if lead else []
    frame_of = {lead: 1}
    between = max(1, math.ceil(frames.step / (_LONGEST_STEP * step) - 1e-9))
    for frame in range(2, frames.count + 1):
        steps += [frames.step / between] * between
        frame_of[len(steps)] = frame
    return steps, frame_of


def _winds(shot: Shot, begin: float) -> list[tuple[float, float]]:
    """Return the run's near-surface wind at every source update."""
    slot = shot.scale.time(_SOURCE_STEP)
    count = max(1, math.ceil((shot.frames.last - begin) / slot) + 1)
    winds = burning.wind_at(shot.run, begin + slot * np.arange(count), shot.fire.surroundings)
    return [(float(east), float(north)) for east, north in np.nan_to_num(winds)]
