"""Production of a data set: missing samples, shared by several processes, each sample complete or absent.

The work is divided by visits: samples that share a built scene (see `places`). A process holds the lease of
the visit that it renders. A killed process loses the samples that it had not finished; its leases expire.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from .. import leases, output
from ..database import Database
from ..errors import UsageError, input_error, writing
from ..leases import Leases, new_owner
from ..progress import MessageCallback, Progress, duration, no_message, silent
from ..shot.schema import scene_text
from ..shot.schema.frame_list import FrameList
from . import about, files, imagery, places, record, truth
from .about import About
from .distributions import VALUES
from .draws import Drawer
from .estimate import Estimate, estimate
from .places import Visit
from .plan import Plan
from .run_scene import settings_of
from .splits import Splits

WORK = ".work"
"""Folder of leases and of hashes of runs in a data set; it is not a part of the data set."""
_KEPT = 4  # blocks of draws in memory
_POLL_INTERVAL = 1.0  # s between two polls of the leases of other processes
SAMPLES = "samples"
"""Name of the work that counts samples, for progress."""

Maker = Callable[[Plan, Visit, Sequence[int], Path, Progress, MessageCallback], None]
"""Renders, labels and writes some samples of a visit into a folder."""


class Production:
    """A data set to make; each block of samples is drawn at first use.

    Attributes
    ----------
    wanted
        Numbers of the requested samples.
    blocks
        Numbers of the samples of each block with requested samples.
    """

    def __init__(self, plan: Plan, out: Path, wanted: frozenset[int], progress: Progress = silent) -> None:
        self.plan, self.out, self.wanted = plan, out, wanted
        self.blocks = [block for block in places.blocks(plan) if not wanted.isdisjoint(block)]
        self._drawer, self._progress = Drawer(plan), progress
        self._finished: set[range] = set()
        self._visits: dict[range, list[Visit]] = {}

    def visits(self, block: range) -> list[Visit]:
        """Draw the samples of a block, and group them; the last `_KEPT` blocks are kept in memory."""
        if block not in self._visits:
            draws = []
            for done, index in enumerate(block):
                self._progress(done, len(block), "drawing samples")
                draws.append(self._drawer.draw(index))
            self._progress(len(block), len(block), "drawing samples")
            self._visits[block] = places.visits(draws)
            while len(self._visits) > _KEPT:
                del self._visits[next(iter(self._visits))]
        return self._visits[block]

    def missing(self, visit: Visit) -> list[int]:
        """List the requested samples of a visit that are not finished."""
        numbers = [each.index for each in visit.draws if each.index in self.wanted]
        return [index for index in numbers if not files.is_complete(self.out, index)]

    def unfinished(self) -> Iterator[range]:
        """Yield the blocks with missing samples."""
        for block in self.blocks:
            if block not in self._finished:
                wanted = (index for index in block if index in self.wanted)
                if all(files.is_complete(self.out, index) for index in wanted):
                    self._finished.add(block)
                else:
                    yield block

    def left(self) -> frozenset[int]:
        """Return the numbers of all missing samples."""
        return self.wanted.difference(truth.indices(self.out))

    def estimate(self) -> Estimate:
        """Estimate time and size of the missing samples, with as many scenes as in their first block."""
        left, scenes = self.left(), 0
        if (block := next(self.unfinished(), None)) is not None:
            missing = list(filter(None, map(self.missing, self.visits(block))))
            scenes = math.ceil(len(left) * len(missing) / sum(map(len, missing)))
        costs = sorted(cost_file(self.out, 0).parent.glob("*.json"))
        return estimate(left, scenes, self.plan.resolution, self.out, costs)


def prepare(plan: Plan, out: Path, only: str = "", progress: Progress = silent) -> Production:
    """Draw the first block of requested samples of a plan.

    Parameters
    ----------
    only
        List of samples, such as "0137" or "1-20,137"; empty for all.

    Raises
    ------
    UsageError
        The list is invalid.
    InputError
        A run cannot be read, its imagery is refused, or a sample cannot be drawn.
    """
    try:
        wanted = FrameList(only).frames(plan.count)
    except ValueError:
        raise UsageError(
            f"--only: samples are numbered 1 to {plan.count}; write it like 137 or 1-20,137"
        ) from None
    for number, run in enumerate(plan.runs):
        if reason := imagery.fault(run, settings_of(run)):
            raise scene_text.error_at(plan.path, ("runs", number, "run"), f"runs.run: {reason}")
    production = Production(plan, out, frozenset(wanted), progress)
    production.visits(production.blocks[0])
    return production


def run(
    production: Production,
    make: Maker,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    overwrite: bool = False,
) -> None:
    """Make the missing samples; several processes may do so at the same time.

    Raises
    ------
    InputError
        The folder has another data set or files of others, the disk is full, or a file cannot be written.
    """
    out = production.out
    _refuse_others(out)
    output.check(out / about.NAME, overwrite)
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    record.write(out, record.describe(production.plan, out / WORK))
    about.write(out, _about(production.plan), overwrite)
    with _open_leases(out) as held:
        _produce(production, held, make, progress, tell)


def _produce(
    production: Production, held: Leases, make: Maker, progress: Progress, tell: MessageCallback
) -> None:
    total, waiting = len(production.wanted), False
    if not production.left():
        progress(total, total, SAMPLES)
    while production.left():
        visit = _take_visit(production, held)
        if visit is None:
            if not waiting:
                limit = duration(leases.PATIENCE)
                tell(f"waiting for samples of another process; taken over {limit} after its last heartbeat")
            waiting = True
            time.sleep(_POLL_INTERVAL)
            continue
        waiting = False
        try:
            if missing := production.missing(visit):
                left = len(production.left())
                make(
                    production.plan,
                    visit,
                    missing,
                    production.out,
                    _counted(progress, total - left, total),
                    tell,
                )
                if still := production.missing(visit):
                    raise RuntimeError(f"sample {still[0]} was not written")
        finally:
            held.release(_name(visit))


def _take_visit(production: Production, held: Leases) -> Visit | None:
    """Take the lease of the first visit with missing samples that no other process holds."""
    others = held.of_others()
    visits = (visit for block in production.unfinished() for visit in production.visits(block))
    open_visits = (visit for visit in visits if production.missing(visit) and _name(visit) not in others)
    return next((visit for visit in open_visits if held.take(_name(visit))), None)


def _refuse_others(out: Path) -> None:
    """Refuse folders of samples that are links, or that others wrote.

    Raises
    ------
    InputError
        There is one.
    """
    output.refuse_run_folders(out / record.NAME)
    is_ours = (out / record.NAME).is_file()
    for path in (out / name for name in (*files.KINDS, truth.FOLDER, WORK)):
        if path.is_symlink():
            raise input_error(path, "is a link, which is not followed; choose another folder for --out")
        if path.exists() and not is_ours and path.name != WORK:
            raise input_error(path, "belongs to no data set of Firetwin; choose another folder for --out")


def _about(plan: Plan) -> About:
    """Collect the facts about a data set."""
    units = {name: value.unit for name, value in VALUES.items()}
    return About(plan.title, plan.count, plan.seed, Splits(plan).by, plan.license, units)


@contextlib.contextmanager
def _open_leases(out: Path) -> Iterator[Leases]:
    data = Database(out / WORK / "leases.sqlite", leases.TABLES, create=True)
    with contextlib.closing(data), Leases(data, new_owner()) as held:
        yield held


@contextlib.contextmanager
def alone(out: Path, name: str) -> Iterator[None]:
    """Hold a lease of a data set; wait while another process holds it."""
    with _open_leases(out) as held:
        while not held.take(name):
            held.of_others()
            time.sleep(_POLL_INTERVAL)
        try:
            yield
        finally:
            held.release(name)


def _counted(progress: Progress, before: int, total: int) -> Progress:
    """Count the samples of a visit as samples of the data set; other work is shown as a note."""

    def counted(done: int, of: int, what: str = "", note: str = "") -> None:
        if what == SAMPLES:
            progress(before + done, total, SAMPLES, note)
        else:
            progress(before, total, SAMPLES, f"{what} {100 * done // max(of, 1)} %" if what else note)

    return counted


def cost_file(out: Path, index: int) -> Path:
    """Return the file of the processor seconds of a sample; they differ each time, so metadata omit them."""
    return out / WORK / "cost" / f"{index:06d}.json"


def remove_parts(out: Path) -> int:
    """Remove unfinished files of killed processes, after all samples are finished; returns their number."""
    found = [path for folder in out.iterdir() if folder.is_dir() for path in folder.glob(".*.part*")]
    for path in found:
        if path.is_file():
            with contextlib.suppress(OSError):
                path.unlink()
    return len(found)


def _name(visit: Visit) -> str:
    return f"visit {visit.draws[0].index:06d}"
